"""Balancing over a band

Gramians of a band of frequencies order states by what they do there, and their equations have a right side that is not definite: truncation keeps no promise of stability. Three masses at 5 % damping, balanced for 6.07 to 6.99 Hz between two modes, are unstable with one, two and four states. Within the band the response of four states is as good as it was meant to be, and a plot of it shows nothing wrong.

Ritz probes what comes out, warns, and refuses the export.
"""
import numpy as np
import scipy.linalg as la

import models
import naive
from failure import growth_of

BAND = 2 * np.pi * np.array([6.07, 6.99])

GROUP = "Reduced models that are unstable"


def root(W):
    values, Q = la.eigh(W)
    return Q * np.sqrt(np.maximum(values, 0))


def balanced(A, B, C, k):
    """k states, by Gramians between two frequencies [GawronskiJuang1990]."""
    W_c, W_o = naive.gramians(A, B, C)
    unit = np.eye(len(A))
    low, high = (1j / (2 * np.pi) * (la.logm(A + 1j * w * unit) -
                                     la.logm(A - 1j * w * unit)) for w in BAND)
    S = (high - low).real
    L, R = root(S @ W_c + W_c @ S.T), root(S.T @ W_o + W_o @ S)
    U, s, Vt = la.svd(R.T @ L)
    T, W = L @ Vt[:k].T / np.sqrt(s[:k]), R @ U[:, :k] / np.sqrt(s[:k])
    return W.T @ A @ T, W.T @ B, C @ T


def run(it):
    row = models.chain([1.2, 2.6, 1.8], [1070.0, 1530.0, 380.0])
    row.D, _, _ = naive.modal_damping(row.K, row.M, 0.05)
    full = naive.first_order(row, naive.unit(3, 1), naive.unit(3, 2))
    row.D = None
    path = it.component("row", row, "--input", "push=2:1", "--output-at",
                        "seen=3:1")
    for k in (2, 4):
        pole = naive.growth(balanced(*full, k)[0])
        it.holds(pole.real > 0.1, f"naive: {k} states grow by {pole.real:.3g}")
        _, _, reduced = it.reduce(path, "balanced-band", "--modes", k,
                                  "--band-hz", "6.07,6.99", "--damping",
                                  "modal 0.05")
        it.notes(reduced, "is unstable")
        line = it.says("is unstable", 1, "export", "--to", "output4",
                       "reduced.h5", "-o", "reduced.op4")
        it.right("growth", growth_of(line), pole.real, 1e-4)
    it.row(f"a pole at {pole.real:+.2g} rad/s with four states",
           "all left of the axis", "`is unstable: pole at ...`; export refused")
    hertz = np.linspace(1, 10, 200)
    it.picture("""set logscale y
set format y "10^{%L}"
set xlabel "Hz"
set ylabel "|H|"
set key top right
set object rectangle from 6.07, graph 0 to 6.99, graph 1 fc rgb "#e8e8e8" fs solid noborder behind
plot $data using 1:2 with lines lw 3 lc rgb "#9ecae1" title "full, 6 states", \\
    "" using 1:3 with lines lw 1.4 lc rgb "#b2182b" title "4 states, balanced over the grey band: unstable"
""", "Within its band the unstable model is as good as it was meant to be.",
               data=(hertz, *(bode(*model, hertz) for model in
                              (full, balanced(*full, 4)))))


def bode(A, B, C, hertz):
    unit = np.eye(len(A))
    return [abs((C @ la.solve(2j * np.pi * f * unit - A, B))[0, 0])
            for f in hertz]
