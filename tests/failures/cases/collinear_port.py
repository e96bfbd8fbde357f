"""Two grids on an axis as interface

A body held at two grids, with translations only, still turns about the line between them: K_ii of constraint modes is singular. Rounding hides it: the condition is 1e16 and not infinite, the solver returns, and the first fixed-interface mode is a rotation at 0 Hz that no joint will ever hold.

Ritz finds the rotation before it factors, and names the dofs that move most; `ritz-check` names the port.
"""
import numpy as np
import scipy.linalg as la

import models
import naive

GROUP = "Interfaces and bases"


def run(it):
    block = models.lattice(3, 1, 1)
    held = block.rows(1) + block.rows(13)  # both ends of an edge along x
    inner = [i for i in range(len(block.K)) if i not in held]
    K_ii = block.K[np.ix_(inner, inner)]
    condition = np.linalg.cond(K_ii)
    it.holds(condition > 1e13, "naive: K_ii is singular to rounding, and is "
             "factored all the same")
    first = la.eigvalsh(K_ii)[:2]
    it.holds(abs(first[0]) < 1e-10 * first[1],
             "naive: a fixed-interface mode at 0 Hz")

    component = it.component("block", block, "--port", "axis=1,13:123")
    it.says("port-collinear", 0, "check", component)
    it.says("1 motion(s) cost no energy", 1, "basis", "craig-bampton",
            "--modes", 4, component, "-o", "basis.h5")
    it.row(f"a basis, with a mode at 0 Hz beside {naive.hertz(first)[1]:.2g} "
           "Hz", "one motion is free: no such basis",
           "refused: `singular ...`, grids and directions named")
