"""Nearly all modes kept

Residual flexibility is what the kept modes leave of K^-1 F. Keep them all, and it is rounding, of size one once the columns are normalised: the condition of the reduced mass is beyond 1e20, and its modes are complex or negative or none.

Ritz leaves out residual columns that hold nothing beside the kept modes, and says how many.
"""
import numpy as np
import scipy.linalg as la

import models
import naive

GROUP = "Interfaces and bases"


def run(it):
    row = models.chain([1.0] * 10, [1e3] * 10)
    right = la.eigvalsh(row.K, row.M)
    T = naive.residual_basis(row.K, row.M, 10, [9, 4])
    M_r = T.T @ row.M @ T
    it.holds(np.linalg.cond(M_r) > 1e20, "naive: a mass of condition 1e20")
    it.wrong("coordinates of ten dofs", T.shape[1], 10, 0.1)

    component = it.component("row", row, "--port", "a=10:1", "--port", "b=5:1")
    for modes, left_out in ((9, 1), (10, 2)):
        _, basis, reduced = it.reduce(component, "macneal-rubin", "--modes",
                                      modes)
        it.holds(f"{left_out} residual mode(s) left out" in basis["note"],
                 f"Ritz: {basis['note']}")
        it.right("frequencies", np.array(reduced["frequencies_hz"]),
                 naive.hertz(right), 1e-10)
    it.row("twelve coordinates for ten dofs, mass of condition above 1e20",
           "ten", "ten: `2 residual mode(s) left out`")
