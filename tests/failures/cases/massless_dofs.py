"""Rotations without mass

Lumped masses have no rotational inertia, so that half of a beam's dofs are empty in M. To strike out rows and columns without mass looks like tidying up; it clamps every rotation. A free beam then has one rigid mode in the place of two and bends at ten times its frequency.

Ritz keeps such dofs, as what follows statically, counts them (`massless-dofs` of `ritz-check`), and condenses where it may.
"""
import numpy as np
import scipy.linalg as la

import models
import naive

GROUP = "Modes"


def run(it):
    beam = models.beam(20, lumped=True)
    heavy = np.diag(beam.M) > 0
    clamped = la.eigvalsh(beam.K[np.ix_(heavy, heavy)],
                          beam.M[np.ix_(heavy, heavy)])
    # K_hh - K_hm K_mm^-1 K_mh: exact, as the rest has no mass
    K_mh = beam.K[np.ix_(~heavy, heavy)]
    condensed = beam.K[np.ix_(heavy, heavy)] - K_mh.T @ la.solve(
        beam.K[np.ix_(~heavy, ~heavy)], K_mh)
    right = la.eigvalsh(condensed, beam.M[np.ix_(heavy, heavy)])
    # 4.730041 and 7.853205, free-free beam; lumping is good to 1/n^2
    it.right("condensed beam, as a check,", np.sqrt(right[2:4]),
             np.array([4.730041, 7.853205])**2, 0.02)
    rigid = int(np.sum(clamped < 1e-6 * clamped[-1]))
    it.wrong("rigid modes", rigid, 2, 0.5)
    it.wrong("first flexible frequency", np.sqrt(clamped[1]),
             np.sqrt(right[2]), 8)

    component = it.component("beam", beam, "--input", "push=21:3")
    answer = it.tool("basis", "normal-modes", "--modes", 5, component, "-o",
                     "modes.h5")
    found = np.array([f for f in answer["frequencies_hz"] if f > 0])
    it.right("frequencies", found, naive.hertz(right)[2:7], 1e-7)
    it.says("massless-dofs", 0, "check", component)
    it.row(f"one rigid mode, then {naive.hertz(clamped)[1]:.3g} Hz",
           f"two, then {naive.hertz(right)[2]:.3g} Hz",
           f"two, then {found[0]:.3g} Hz, to 1e-7; the empty rows are counted")
