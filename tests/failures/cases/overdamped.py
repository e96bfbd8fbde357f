"""A damper strong enough to stop its mass

A strong damper splits a mode into two real poles. Programs that give each mode a ratio project D on the undamped modes and take its diagonal: the first mode gets zeta = 2.8, and sqrt(1 - zeta^2) is not a number; with it held at one, the mode is gone. Lists that know complex pairs alone lose the slow real pole, which is the slowest motion that the structure has.

Ritz finds poles of the quadratic problem, lists real ones as such, refuses ratios of one and more, and ranks modes that D couples as one, by exact Hankel values with all of D.
"""
import numpy as np
import scipy.linalg as la

import models
import naive

GROUP = "Damping and responses"


def run(it):
    row = models.chain([1.0, 2.0, 1.5], [100.0, 80.0, 120.0],
                       D=np.diag([0.0, 0.0, 60.0]))
    eigenvalues, Phi = la.eigh(row.K, row.M)
    omega = np.sqrt(eigenvalues)
    ratio = np.diag(Phi.T @ row.D @ Phi) / (2 * omega)
    poles = la.eigvals(naive.companion(row.K, row.M, row.D))
    real = np.sort(poles.real[np.abs(poles.imag) < 1e-9])
    it.holds(ratio[0] > 1, f"naive: the ratio {ratio[0]:.2g} of the first mode")
    it.wrong("frequency of the first mode", omega[0],
             np.abs(poles[poles.imag > 1e-9]).min(), 0.5)

    path = it.component("row", row, "--input", "push=3:1", "--output-at",
                        "seen=1:1")
    answer = it.tool("poles", path, shown=False)
    it.says("real, does not oscillate", 0, "poles", path)
    found = np.array(sorted(p["real"] for p in answer["poles"]
                            if p["imaginary"] == 0))
    it.right("real poles", found, real, 1e-9)
    it.says("overdamped, it must stay below 1", 1, "poles", "--damping",
            "modal 2", path)
    it.reduce(path, "full", out="row-full")
    W_c, W_o = naive.gramians(*naive.first_order(row, naive.unit(3, 2),
                                                 naive.unit(3, 0)))
    exact = np.sqrt(np.abs(np.sort(la.eigvals(W_c @ W_o).real)[::-1]))
    answer = it.tool("rank", "row-full.h5")
    it.right("value of all three modes", np.array(answer["values"]),
             np.full(3, exact[0]), 1e-9)
    it.right("Hankel values", np.array(answer["system_values"])[:4], exact[:4],
             1e-9)
    it.row(f"ratio {ratio[0]:.2g} at {omega[0]:.3g} rad/s",
           f"no such mode: poles at {real[1]:.3g} and {real[0]:.3g} rad/s",
           f"{found[1]:.3g} and {found[0]:.3g}, `real, does not oscillate`; "
           "ratios of 1 and more refused")
