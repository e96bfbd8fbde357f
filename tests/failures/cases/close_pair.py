"""Two modes closer than their width, at zeta = 1e-4

Gregory's values are Hankel values for light damping and modes that stand apart; light damping alone is not enough. Two oscillators joined by a spring as weak as their damping have modes 2 zeta w apart: the formula gives both the same value, where the exact ones differ by four, since what one mode does the other undoes.

Ritz computes the exact Gramian beside the formula, warns where modes couple in it, and prints the exact values next to each.
"""
import numpy as np
import scipy.linalg as la

import models
import naive

GROUP = "Rankings"


def oscillators(joined):
    """Two of 1 kg on 1000 N/m, joined by that much of it."""
    k = 1000.0
    K = k * np.eye(2) + joined * k * np.array([[1, -1], [-1, 1]])
    return models.Model(K, np.eye(2), [(1, 1), (2, 1)],
                        {1: (0.0, 0.0, 0.0), 2: (1.0, 0.0, 0.0)})


def both(it, model, zeta):
    """Gregory's values, exact ones, and what ritz-rank says."""
    model.D, omega, Phi = naive.modal_damping(model.K, model.M, zeta)
    gregory = np.abs(Phi[0] * Phi[1]) / (4 * zeta * omega**2)
    W_c, W_o = naive.gramians(*naive.first_order(model, naive.unit(2, 0),
                                                 naive.unit(2, 1)))
    exact = np.sqrt(np.sort(la.eigvals(W_c @ W_o).real)[::-1])
    pairs = np.sqrt(exact[0::2] * exact[1::2])
    model.D = None
    path = it.component("two", model, "--input", "force=1:1", "--output-at",
                        "seen=2:1")
    it.reduce(path, "full", out="two-full")
    answer = it.tool("rank", "--by", "gregory", "--damping", f"modal {zeta:g}",
                     "two-full.h5")
    return np.sort(gregory)[::-1], exact, pairs, answer


def run(it):
    gregory, exact, pairs, answer = both(it, oscillators(2e-4), 1e-4)
    it.wrong("second value by Gregory", gregory[1], pairs[1], 1.5)
    it.notes(answer, "trust the exact ones")
    it.right("exact values", np.sort(answer["system_values"])[::-1], exact,
             1e-4)
    it.row(f"second value {gregory[1]:.3g}, as the first",
           f"{pairs[1]:.2g}",
           f"`modes 1 and 2 couple`; exact values beside, "
           f"{answer['system_values'][2]:.2g}")
