"""Unsymmetric D: a spinning wheel

Gyroscopic terms are the skew part of D. Programs that symmetrise what they read, or take the diagonal of Phi'D Phi, lose them without a trace, as skew matrices have neither. A wheel on isotropic supports then has two double frequencies, where it whirls at four.

Ritz keeps D as it is, says how much of it is gyroscopic, finds the poles with it, and ranks modes that it couples as one, by exact Hankel values with all of D. A motion without damping has no Hankel value.
"""
import numpy as np
import scipy.linalg as la

import models
import naive

GROUP = "Damping and responses"


def wheel():
    """x, y, and turns about them: springs that couple them, spin about z."""
    K = np.diag([100.0, 100.0, 400.0, 400.0])
    K[0, 3] = K[3, 0] = 30.0
    K[1, 2] = K[2, 1] = -30.0
    G = np.zeros((4, 4))
    G[2, 3], G[3, 2] = 6.0, -6.0
    return models.Model(K, np.diag([1.0, 1.0, 0.5, 0.5]),
                        [(1, 1), (1, 2), (1, 4), (1, 5)], {1: (0., 0., 0.)}, G)


def hankel_values(model, zeta):
    """With modal damping: exact Hankel values, and those without G."""
    G = model.D
    model.D, _, _ = naive.modal_damping(model.K, model.M, zeta)
    modal = exact_values(model)
    model.D = model.D + G
    spun = exact_values(model)
    model.D = G
    return spun, modal


def exact_values(model):
    W_c, W_o = naive.gramians(*naive.first_order(model, naive.unit(4, 0),
                                                 naive.unit(4, 1)))
    return np.sqrt(np.abs(np.sort(la.eigvals(W_c @ W_o).real)[::-1]))


def run(it):
    model = wheel()
    poles = la.eigvals(naive.companion(model.K, model.M, model.D))
    right = np.sort(poles.imag[poles.imag > 0])
    symmetric = np.sort(np.abs(la.eigvals(naive.companion(
        model.K, model.M, (model.D + model.D.T) / 2)).imag))[::2]
    it.wrong("whirl frequencies", symmetric, right, 0.15)

    path = it.component("wheel", model, "--input", "push=1:1", "--output-at",
                        "side=1:2")
    it.says("gyroscopic", 0, "check", path)
    answer = it.tool("poles", path)
    found = np.array([p["hertz"] for p in answer["poles"]])
    it.right("whirl frequencies", np.sort(found), right / (2 * np.pi), 1e-9)
    it.reduce(path, "full", out="wheel-full")
    it.says("is not damped, or grows", 1, "rank", "wheel-full.h5",
            "--by", "modal-cost")
    spun, modal = hankel_values(model, 0.05)
    answer = it.tool("rank", "--damping", "modal 0.05", "wheel-full.h5")
    it.wrong("largest Hankel value by the diagonal", modal[0], spun[0], 0.05)
    it.right("Hankel values", np.array(answer["system_values"])[:4], spun[:4],
             1e-9)
    it.row(" ".join(f"{w:.4g}" for w in symmetric) + " rad/s",
           " ".join(f"{w:.4g}" for w in right) + " rad/s",
           " ".join(f"{2 * np.pi * f:.4g}" for f in np.sort(found))
           + " rad/s; rankings with all of D")
