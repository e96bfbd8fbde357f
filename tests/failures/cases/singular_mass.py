"""A mass matrix of low rank

Equipment tied to the mean motion of a few grids (RBE3) gives M = sum m a a', which has rank one for each box and no empty row. `eigh(K, M)` stops, since M has no Cholesky factor. The cure that everybody finds, M + 1e-6 max(M) I, makes modes out of nothing: here nine in the place of three, and the highest of them sets the step of an explicit integrator.

Ritz takes M as it is. Motions without mass have no mode; they answer statically, and are kept where a port or a load needs them.
"""
import numpy as np
import scipy.linalg as la

import models
import naive

GROUP = "Modes"


def boxes():
    """Nine dofs in a row, held; three boxes on the mean of three each."""
    model = models.chain([1.0] * 9, [900.0, 500.0, 800.0, 400.0, 700.0, 300.0,
                                     600.0, 1000.0, 200.0])
    A = np.kron(np.eye(3), np.full((1, 3), 1 / 3))
    model.M = A.T @ np.diag([1.0, 2.0, 4.0]) @ A
    return model, A


def run(it):
    model, A = boxes()
    # K x = lambda A'm A x: of y = A x alone, by the flexibility of the means
    S = A @ la.solve(model.K, A.T)
    root = np.diag(np.sqrt([1.0, 2.0, 4.0]))
    right = np.sort(1 / la.eigvalsh(root @ S @ root))
    try:
        la.eigh(model.K, model.M)
        stopped = False
    except la.LinAlgError:
        stopped = True
    it.holds(stopped, "naive: eigh(K, M) stops")
    cured = la.eigvalsh(model.K, model.M +
                        1e-6 * model.M.max() * np.eye(9))
    it.wrong("modes with a little mass added", len(cured), 3, 1.9)
    it.wrong("highest frequency", np.sqrt(cured[-1]), np.sqrt(right[-1]), 100)

    component = it.component("boxes", model, "--input", "push=9:1")
    answer = it.tool("basis", "normal-modes", "--up-to-hz", 1e6, component,
                     "-o", "modes.h5")
    found = [f for f in answer["frequencies_hz"] if f > 0]
    it.right("frequencies", np.array(found), naive.hertz(right), 1e-10)
    it.right("modes", len(found), 3, 0)
    it.row(f"nine modes, up to {naive.hertz(cured)[-1]:.4g} Hz",
           f"three, up to {naive.hertz(right)[-1]:.4g} Hz",
           f"three, up to {found[-1]:.4g} Hz, to 1e-10")
