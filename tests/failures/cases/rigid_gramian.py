"""Rigid modes in Gramians

The Gramian of a free body is infinite: a force moves it away for good. Lyapunov solvers perturb the two zero poles and return numbers all the same: a "Gramian" with negative eigenvalues, and Hankel values of 1e10 and more, of rounding.

Ritz takes rigid motion out first, balances the flexible part, and appends the rigid states as they are.
"""
import warnings

import numpy as np
import scipy.linalg as la

import models
import naive

GROUP = "Rankings"


def flexible(model, b, c):
    """Hankel values without rigid motion: modes of unit mass, each with D."""
    eigenvalues, Phi = la.eigh(model.K, model.M)
    Phi = Phi[:, 1:]
    modal = models.Model(np.diag(eigenvalues[1:]), np.eye(3), None, None,
                         Phi.T @ model.D @ Phi)
    W_c, W_o = naive.gramians(*naive.first_order(modal, Phi.T @ b, Phi.T @ c))
    return np.sqrt(np.sort(la.eigvals(W_c @ W_o).real)[::-1])


def run(it):
    row = models.chain([1.0, 2.0, 1.0, 3.0], [0.0, 100.0, 200.0, 150.0])
    row.D = 0.002 * row.K
    b, c = naive.unit(4, 0), naive.unit(4, 3)
    right = flexible(row, b, c)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            W_c, W_o = naive.gramians(*naive.first_order(row, b, c))
            values = np.sqrt(np.abs(la.eigvals(W_c @ W_o)))
            largest = float(values.max())
        except (ValueError, la.LinAlgError):
            largest = np.inf
    it.wrong("largest Hankel value", largest, right[0], 1e6)

    path = it.component("row", row, "--input", "push=1:1", "--output-at",
                        "end=4:1")
    it.says("stand apart", 0, "rank", path)
    answer = it.tool("basis", "balanced", "--modes", 4, path, "-o", "basis.h5")
    it.right("Hankel values", np.array(answer["hankel_values"]), right, 1e-6)
    it.holds(answer["columns"] == {"rigid": 2, "state": 4},
             "Ritz: two rigid states beside")
    it.row("largest Hankel value above 1e5, some imaginary",
           f"{right[0]:.3g}", f"{answer['hankel_values'][0]:.3g}; `states "
           "that are not damped ... stand apart`")
