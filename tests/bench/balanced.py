#!/usr/bin/python3 -s
"""balanced.py FOLDER-OF-THE-TOOLS OUT.svg - where balanced truncation wins and
where Craig-Bampton does: the tables of docs/methods/balanced.md on standard
output, and their chart.

The free truss of 72 dofs, its left end a port of four dofs. Every model gets as
many states as every other, two for each vector of a second-order one, and is
told the same: a force and a displacement far out, forces and displacements at
the port. Left: error of the response of the free body, against states. Right:
the same models of 36 states, with springs hung on the port afterwards: error of
the first five elastic frequencies, against stiffness.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import h5py
import numpy
import scipy.linalg

HERE = pathlib.Path(__file__).resolve().parent
TRUSS = HERE.parent.parent / "data" / "truss72"
ZETA = 0.002
PORT = ["1:1", "1:2", "2:1", "2:2"]
ORDERS = range(14, 61, 4)
CHOSEN = 36

# How a method is asked for a number of states.
METHODS = {
    "balanced": lambda r: ["balanced", "--modes", r - 6, "--damping",
                           f"modal {ZETA}"],
    "modal-balanced": lambda r: ["modal-balanced", "--modes", r // 2 - 3,
                                 "--damping", f"modal {ZETA}"],
    "craig-bampton": lambda r: ["craig-bampton", "--modes", r // 2 - 4],
    "macneal-rubin": lambda r: ["macneal-rubin", "--modes", r // 2 - 7],
}


def run(bin_, *words):
    """One tool with --json, its object."""
    done = subprocess.run([bin_ / words[0], *map(str, words[1:]), "--json"],
                          capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)
    return json.loads(done.stdout)


def modal_damping(K, M):
    """D of which every flexible mode has the ratio ZETA."""
    w2, V = scipy.linalg.eigh(K, M)
    w = numpy.sqrt(numpy.maximum(w2, 0.0))
    w[:3] = 0.0
    MV = M @ V
    return MV @ numpy.diag(2.0 * ZETA * w) @ MV.T


def first_order(K, M, B, C):
    """A, B, C with modal damping."""
    n = K.shape[0]
    Mi = numpy.linalg.inv(M)
    A = numpy.block([[numpy.zeros((n, n)), numpy.eye(n)],
                     [-Mi @ K, -Mi @ modal_damping(K, M)]])
    return (A, numpy.vstack([numpy.zeros_like(B), Mi @ B]),
            numpy.hstack([C, numpy.zeros_like(C)]))


def dense(group):
    """A matrix of a container, sparse there or dense."""
    if isinstance(group, h5py.Dataset):
        return group[()]
    n = group.attrs["shape"]
    return scipy.sparse.csc_matrix((group["data"][()], group["indices"][()],
                                    group["indptr"][()]), n).toarray()


def read(path):
    """A, B, C of a component, of a reduced one or of a state space."""
    with h5py.File(path) as f:
        if "A" in f:
            return f["A"][()], f["B"][()], f["C"][()]
        return first_order(dense(f["K"]), dense(f["M"]), f["inputs/B"][()],
                           f["outputs/C"][()])


def reduced(bin_, folder, method, states):
    """A, B, C of a method at a number of states."""
    full, basis, out = (folder / f"{x}.h5" for x in ("full", "basis", "out"))
    words = METHODS[method](states)
    run(bin_, "ritz-basis", words[0], *words[1:], full, "-o", basis)
    run(bin_, "ritz-reduce", full, basis, "-o", out)
    model = read(out)
    if model[0].shape[0] != states:
        print(f"# {method}: {model[0].shape[0]} states for {states}",
              file=sys.stderr)
    return model


def elastic(A):
    """Frequencies of oscillating poles, rad/s, ascending."""
    s = numpy.linalg.eigvals(A)
    w = numpy.sort(abs(s[s.imag > 1e-3 * abs(s).max() ** 0.5]))
    return w


def response(model, w):
    """|H| from the first input to the first output."""
    A, B, C = model
    eye = numpy.eye(A.shape[0])
    return numpy.array([(C[:1] @ numpy.linalg.solve(1j * x * eye - A,
                                                    B[:, :1]))[0, 0]
                        for x in w])


def main():
    """Parse and run."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    asked = parser.parse_args()
    bin_ = asked.bin.resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        words = []
        for k, place in enumerate(["36:2"] + PORT):
            words += ["--input", f"u{k}={place}"]
        for k, place in enumerate(["35:2"] + PORT):
            words += ["--output-at", f"y{k}={place}"]
        run(bin_, "ritz-import", "--stiffness", TRUSS / "truss72.k.mtx",
            "--mass", TRUSS / "truss72.m.mtx", "--bulk", TRUSS / "truss72.bdf",
            "--dofs", TRUSS / "truss72.dofs", "--port", "end=1,2:12", *words,
            "-o", folder / "full.h5")
        full = read(folder / "full.h5")
        free = free_table(bin_, folder, full)
        held = held_table(bin_, folder, full)
    draw(free, held, asked.out)


def free_table(bin_, folder, full):
    """Rows: states, error of each method."""
    w = elastic(full[0])
    grid = numpy.sort(numpy.concatenate(
        [numpy.linspace(0.5 * w[0], 1.2 * w[9], 400)] +
        [x * (1 + ZETA * numpy.linspace(-3, 3, 13)) for x in w[:10]]))
    H = response(full, grid)
    rows = []
    print("states\t" + "\t".join(METHODS))
    for r in ORDERS:
        rows.append([r] + [abs(response(reduced(bin_, folder, m, r), grid) -
                               H).max() / abs(H).max() for m in METHODS])
        print("\t".join(f"{x:.3g}" for x in rows[-1]), flush=True)
    return rows


def held_table(bin_, folder, full):
    """Rows: stiffness over the typical one, error of each method."""
    models = {m: reduced(bin_, folder, m, CHOSEN) for m in METHODS}
    rows = []
    print("\nstiffness\t" + "\t".join(METHODS))
    for k in numpy.logspace(-4, 4, 25):

        def five(model):
            """With springs of 7e6 k N/m on the port."""
            A, B, C = model
            return elastic(A - 7e6 * k * B[:, 1:] @ C[1:])

        w = five(full)[:8]
        rows.append([k])
        for m in METHODS:
            v = five(models[m])[:8]
            n = min(len(v), 5)
            rows[-1].append(max(abs(v[:n] / w[:n] - 1)))
        print("\t".join(f"{x:.3g}" for x in rows[-1]), flush=True)
    return rows


SCRIPT = """
set terminal svg size 980,440 font 'sans,13' background 'white'
set output '{out}'
set multiplot layout 1,2
set logscale y
set format y '10^{{%L}}'
set grid x y
set key top right
set xlabel 'states'
set ylabel 'error of the response over its largest value'
set title 'free, as it was reduced'
plot for [k=2:5] $free using 1:k with linespoints ls k title word(names,k-1)
set logscale x
set format x '10^{{%L}}'
set key at graph 0.98,0.87 right
set xlabel 'springs on the port / stiffness of a bar'
set ylabel 'worst of five elastic frequencies, relative'
set title '{states} states, held afterwards'
plot for [k=2:5] $held using 1:k with linespoints ls k title word(names,k-1)
"""


def draw(free, held, out):
    """gnuplot."""
    def block(name, rows):
        lines = [" ".join(f"{x:.6e}" for x in row) for row in rows]
        return f"${name} << E\n" + "\n".join(lines) + "\nE\n"

    style = "".join(f"set style line {k} lw 2 pt {p} lc rgb '{c}'\n" for k, p, c in
                    [(2, 7, "#cc0000"), (3, 5, "#f57900"), (4, 9, "#3465a4"),
                     (5, 11, "#4e9a06")])
    text = (f"names = '{' '.join(METHODS)}'\n" + style + block("free", free) +
            block("held", held) + SCRIPT.format(out=out, states=CHOSEN))
    subprocess.run(["gnuplot", "-d"], input=text, text=True, check=True)


if __name__ == "__main__":
    main()
