"""Second-order balanced truncation

Balancing displacements keeps M, D and K, which is why one wants it, and loses the proof of stability. A row of three masses with unequal dashpots, pushed at one end and seen at the other, has a pole that grows by 0.018 of the largest when one of three vectors is dropped.

Ritz writes what it is, a state space, says that it is unstable, and refuses the export. With `--sides one` the result is symmetric and stable, whatever the inputs and outputs.
"""
import numpy as np
import scipy.linalg as la

import models
import naive
from failure import growth_of

GROUP = "Reduced models that are unstable"


def balanced(model, b, c, k):
    """K, M, D of k vectors, by positions [ReisStykel2008]. M, D and K being
    symmetric, the dual model has b and c exchanged."""
    n = len(model.K)
    halves = []
    for load in (b, c):
        W_c, _ = naive.gramians(*naive.first_order(model, load, load))
        halves.append(la.cholesky(W_c[:n, :n], lower=True))
    U, s, Vt = la.svd(halves[1].T @ model.M @ halves[0])
    T = halves[0] @ Vt[:k].T / np.sqrt(s[:k])
    W = halves[1] @ U[:, :k] / np.sqrt(s[:k])
    return W.T @ model.K @ T, W.T @ model.M @ T, W.T @ model.D @ T


def run(it):
    row = models.chain([0.7, 1.9, 1.1], [1960.0, 350.0, 710.0])
    row.D = models.chain([1.0] * 3, [0.5, 1.0, 24.0]).K
    pole = naive.growth(naive.companion(*balanced(
        row, naive.unit(3, 2), naive.unit(3, 0), 2)))
    right = naive.growth(naive.companion(row.K, row.M, row.D))
    it.holds(right.real < 0, "the row is stable")
    it.holds(pole.real > 0.5, f"naive: a pole grows by {pole.real:.3g} rad/s")

    path = it.component("row", row, "--input", "push=3:1", "--output-at",
                        "seen=1:1")
    _, _, reduced = it.reduce(path, "balanced-position", "--modes", 2)
    it.notes(reduced, "is unstable")
    line = it.says("is unstable", 1, "export", "--to", "output4", "reduced.h5",
                   "-o", "reduced.op4")
    it.right("growth", growth_of(line), pole.real, 1e-4)
    it.reduce(path, "balanced-position", "--modes", 2, "--sides", "one",
              out="one")
    it.says("stable", 0, "export", "--to", "output4", "one.h5", "-o",
            "one.op4")
    it.row(f"a pole at {pole.real:+.2g} rad/s",
           f"all left of the axis, {right.real:.2g} rad/s at most",
           "`is unstable: pole at ...`; export refused; one-sided is stable")
