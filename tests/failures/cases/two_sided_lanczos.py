"""Two-sided Lanczos, output away from the input

Left and right Lanczos vectors match twice as many moments as one side does, and nothing holds the poles of W'A V left of the axis. Ten damped masses, pushed at the tip and seen at the root: of seven states the reduced model is stable, of eight it is not, of nine it is, of ten it is not. The response matches in the frequency domain, to many digits, at low frequencies; in time it grows.

Ritz keeps the method to show it, computes the poles of whatever it reduces, warns, and exports neither this model nor any of this method without `--force`.
"""
import numpy as np
import scipy.linalg as la

import models
import naive
from failure import growth_of

GROUP = "Reduced models that are unstable"


def two_sided(A, b, c, k):
    """A of k states, by vectors of A^-1, biorthogonal to rounding."""
    inverse = la.inv(A)
    v, w = inverse @ b, c.copy()
    V, W = np.zeros((len(A), k)), np.zeros((len(A), k))
    for j in range(k):
        for _ in range(2):
            v, w = v - V[:, :j] @ (W[:, :j].T @ v), \
                w - W[:, :j] @ (V[:, :j].T @ w)
        s = w @ v
        V[:, j] = v / np.sqrt(abs(s))
        W[:, j] = w / np.sqrt(abs(s)) * np.sign(s)
        v, w = inverse @ V[:, j], inverse.T @ W[:, j]
    return la.inv(W.T @ inverse @ V), W.T @ b, c @ V


def impulse(A, b, c, seconds):
    """c exp(A t) b."""
    step = la.expm(A * (seconds[1] - seconds[0]))
    x, y = b.copy(), []
    for _ in seconds:
        y.append(abs(c @ x))
        x = step @ x
    return y


def run(it):
    chain = models.shipped("chain", "chain", True)
    A, B, C = naive.first_order(chain, naive.unit(10, 9), naive.unit(10, 0))
    b, c = B[:, 0], C[0]
    A_r, b_r, c_r = two_sided(A, b, c, 8)
    pole, right = naive.growth(A_r), naive.growth(A)
    it.holds(right.real < 0, "the chain is stable")
    it.holds(pole.real > 0.05, f"naive: a pole grows by {pole.real:.3g} rad/s")

    path = it.component("chain", chain, "--input", "tip=10:1", "--output-at",
                        "root=1:1")
    _, _, reduced = it.reduce(path, "lanczos-two-sided", "--modes", 8,
                              "--operator", "inverse")
    it.notes(reduced, "is unstable")
    line = it.says("is unstable", 1, "export", "--to", "output4", "reduced.h5",
                   "-o", "reduced.op4")
    it.right("growth", growth_of(line), pole.real, 1e-4)
    _, _, reduced = it.reduce(path, "lanczos-one-sided", "--modes", 8,
                              out="stable")
    it.holds(reduced["stability"] == "stable", "Ritz: one-sided is stable")
    it.row(f"a pole at {pole.real:+.3g} rad/s", f"all left of the axis, "
           f"{right.real:.2g} rad/s at most",
           "`is unstable: pole at ...`; export refused")
    seconds = np.linspace(0, 200, 300)
    it.picture("""set logscale y
set format y "10^{%L}"
set xlabel "s"
set ylabel "|displacement of the root|"
set yrange [1e-3:1e8]
set ytics 100
set key top left Left reverse
plot $data using 1:3 with lines lw 1.6 lc rgb "#b2182b" title "8 states, two-sided Lanczos", \\
    "" using 1:2 with lines lw 1.2 lc rgb "#2166ac" title "full, 20 states"
""", "Answer to an impulse at the tip: the reduced model grows.",
               data=(seconds, impulse(A, b, c, seconds),
                     impulse(A_r, b_r, c_r, seconds)))
