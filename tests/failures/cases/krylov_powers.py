"""Krylov vectors as plain powers

K^-1 M times a vector, again and again, turns every vector towards the first mode. Normalised and used as they come, five of them have a condition beyond 1e6, and the reduced mass its square: at the sixth it is not positive definite any more, and more vectors make the answer worse, not better.

Ritz makes each vector orthogonal to all before it, twice, and leaves out what is not new.
"""
import h5py
import numpy as np
import scipy.linalg as la

import models
import naive

GROUP = "Interfaces and bases"


def powers(model, b, most):
    """Columns of unit mass."""
    columns, x = [], la.solve(model.K, b, assume_a="pos")
    for _ in range(most):
        columns.append(x / np.sqrt(x @ model.M @ x))
        x = la.solve(model.K, model.M @ columns[-1], assume_a="pos")
    return np.array(columns).T


def error(model, T, right):
    """Of the first modes, relative; inf where there is no answer."""
    try:
        found = la.eigvalsh(T.T @ model.K @ T, T.T @ model.M @ T)
    except la.LinAlgError:
        return np.inf
    return float(np.max(np.abs(found[:4] / right[:4] - 1)))


def run(it):
    truss = models.shipped("truss72", "truss72")
    free = [i for i, (grid, _) in enumerate(truss.dofs) if grid > 2]
    held = models.Model(truss.K[np.ix_(free, free)],
                        truss.M[np.ix_(free, free)],
                        [truss.dofs[i] for i in free])
    b = naive.unit(len(free), len(free) - 1)
    right = la.eigvalsh(held.K, held.M)
    T = powers(held, b, 12)
    conditions = [np.linalg.cond(T[:, :k]) for k in range(1, 13)]
    it.holds(conditions[4] > 1e6, "naive: condition above 1e6 after five")
    it.holds(not error(held, T, right) < 1e-2,
             "naive: twelve vectors do not give four modes to 1 %")

    path = it.component("truss", held, "--input", "push=36:2")
    made, errors = [], []
    for k in range(1, 13):
        _, basis, reduced = it.reduce(path, "krylov", "--modes", k, "--loads",
                                      "inputs", out=f"k{k}")
        with h5py.File(it.folder / f"k{k}-basis.h5") as file:
            V = file["T"][:]
        made.append(np.linalg.cond(V / np.linalg.norm(V, axis=0)))
    it.commands = it.commands[-1:]
    found = np.array(reduced["frequencies_hz"][:4])
    it.right("first four frequencies from twelve vectors", found,
             naive.hertz(right)[:4], 1e-2)
    it.holds(made[-1] < 100, f"Ritz: condition {made[-1]:.2g} of twelve")
    it.row(f"condition {conditions[4]:.0e} after five vectors; no modes from "
           "twelve", "four modes to 1 % from twelve",
           "the same, condition of twelve below 100")
    it.picture("""set logscale y
set format y "10^{%L}"
set xlabel "vectors"
set ylabel "condition of the basis"
set xrange [0.5:12.5]
set yrange [0.5:1e20]
set ytics 1e5
set key top left Left reverse
plot $data using 1:2 with linespoints lw 2 pt 5 ps 0.6 lc rgb "#b2182b" title "powers", \\
    "" using 1:3 with linespoints lw 2 pt 7 ps 0.6 lc rgb "#2166ac" title "ritz-basis krylov"
""", "Condition of Krylov vectors of a truss, columns of unit length.",
               data=(range(1, 13), conditions, made))
