"""Shift-invert at zero on a free body

A free body's K is singular, and modes are found as those of (K - sigma M)^-1 M. With sigma = 0 the factor is one of rounding: rigid modes come back with 1/lambda near 1e12, and what they leave in every vector drowns the rest. Lanczos from one vector, fully
reorthogonalised, in a beam of square section returns seven zeros or more and flexible modes that are none, or meets an exact zero. SciPy's `eigsh(sigma=0)` on the same beam along an axis meets an exact zero and stops: `Factor is exactly singular`.

Ritz factors K - sigma M with sigma below zero, polishes, and proves by an inertia count that no mode is missing ([eigen.md](../methods/eigen.md)).
"""
import warnings

import numpy as np
import scipy.linalg as la
import scipy.sparse as sparse
import scipy.sparse.linalg  # sparse.linalg

import models
import naive
from failure import relative

GROUP = "Modes"


def is_right(found, right):
    """Six modes near zero, then the flexible ones to 1 %."""
    zeros = int(np.sum(np.abs(found) < 1e-6 * right[0]))
    return zeros == 6 and relative(found[6:6 + len(right)], right) < 0.01


def run(it):
    along = models.space_beam(10)
    right = la.eigvalsh(along.K, along.M)[6:11]  # two pairs and a torsion
    vectors = [(0.3, -0.5, 0.7), (0.1, 0.2, -0.4), (-0.8, 0.3, 0.2),
               (0.5, 0.6, 0.1)]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for vector in vectors:
            beam = models.turned(along, vector)
            it.holds(not is_right(tried(beam), right),
                     f"naive: no six rigid modes and right flexible ones of "
                     f"the beam turned by {vector}")
    try:
        sparse.linalg.eigsh(sparse.csc_matrix(along.K), k=10, sigma=0,
                            M=sparse.csc_matrix(along.M))
        stopped = False
    except RuntimeError:
        stopped = True
    it.holds(stopped, "naive: eigsh of the beam along an axis stops")

    component = it.component("beam", models.turned(along, vectors[0]))
    answer = it.tool("basis", "macneal-rubin", "--modes", 5, component, "-o",
                     "modes.h5")
    found = np.array(answer["frequencies_hz"])
    it.holds(np.sum(found == 0) == 6, "Ritz: six rigid modes")
    it.right("flexible frequencies", found[6:], naive.hertz(right), 1e-8)
    it.row("seven or more rigid modes, no flexible one within 1 %; or it stops",
           f"six, and {naive.hertz(right)[0]:.4g} Hz twice",
           f"six, and {found[6]:.4g} Hz twice, to 1e-8")


def tried(beam):
    """Eigenvalues, or none."""
    try:
        return naive.lanczos(beam.K, beam.M, 0.0, 30)
    except (ValueError, la.LinAlgError):
        return np.zeros(0)
