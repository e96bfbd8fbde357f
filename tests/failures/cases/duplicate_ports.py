"""Two ports on one dof, and on dofs joined by a very stiff link

Two joints at one grid give two equal residual vectors, and the reduced mass is singular. Two grids joined by a link 1e10 times as stiff as all else give nearly equal ones, which is worse: the mass has the condition 1e15 and may still be factored, and what comes of it is noise.

Ritz counts a dof of two ports once, and `ritz-check` says that joints at both would hold it twice. Nearly equal columns it leaves out by name if `--tolerance` says what is near; at the default of 1e-10 both stay here, and `ritz-export` tells that a motion of the result has no mass. The stiff link does not make all other modes look rigid, and does not blur them.
"""
import numpy as np
import scipy.linalg as la

import models
import naive

GROUP = "Interfaces and bases"


def run(it):
    spring = 1234.56789012345
    row = models.chain([1.0] * 10, [spring] * 9 + [9.87654321012345e12])
    # the link as good as rigid: right to 1e-10
    merged = models.chain([1.0] * 8 + [2.0], [spring] * 9)
    right = naive.hertz(la.eigvalsh(merged.K, merged.M))[:3]
    for rows in ([9, 9], [8, 9]):
        T = naive.residual_basis(row.K, row.M, 3, rows)
        it.holds(np.linalg.cond(T.T @ row.M @ T) > 1e13,
                 f"naive: mass of residuals at dofs {rows} is singular")

    component = it.component("row", row, "--port", "a=9:1", "--port", "b=10:1",
                             "--port", "c=10:1")
    it.says("joints at both would hold them twice", 0, "check", component)
    _, basis, reduced = it.reduce(component, "macneal-rubin", "--modes", 3,
                                  "--attach", "b,c", out="same")
    it.holds(basis["columns"] == {"normal": 3, "residual": 1},
             "Ritz: one coordinate of two ports at one dof")
    it.right("modes kept", np.array(reduced["frequencies_hz"][:3]), right,
             1e-6)
    near, _, reduced = it.reduce(component, "macneal-rubin", "--modes", 3,
                                 "--attach", "a,b", out="near")
    it.right("modes kept", np.array(reduced["frequencies_hz"][:3]), right,
             1e-6)
    it.says("have no mass", 0, "export", "--to", "output4", near, "-o",
            "near.op4")
    _, basis, reduced = it.reduce(component, "macneal-rubin", "--modes", 3,
                                  "--attach", "a,b", "--tolerance", "1e-8",
                                  out="one")
    it.holds("1 residual mode(s) left out, the first of grid 10 T1"
             in basis["note"], f"Ritz: {basis['note']}")
    it.right("modes kept", np.array(reduced["frequencies_hz"][:3]), right,
             1e-6)
    it.row("reduced mass of condition above 1e13, without a word",
           "one coordinate for both",
           "one, of a shared dof; of near ones with `--tolerance 1e-8`, else "
           "export tells of a motion without mass")
