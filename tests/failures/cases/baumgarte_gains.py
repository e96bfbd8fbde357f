"""Baumgarte gains too high for the step

Two bodies are joined by a constraint, which Baumgarte's method enforces. At a step of 1 ms, tests showed that higher gains are better. At 10 ms, which still resolves every motion of the bodies, c'' = -2 alpha c' - beta^2 c is no longer stable for the integrator: the violation, of the twelfth digit at first, grows at each step.

Ritz chooses gains from the step, and refuses those that are too high for an explicit integrator, with the limit.
"""
import numpy as np

import bodies_in_time as bodies

GROUP = "Runs over time"
GAIN = 300.0
OFF = 1e-12  # of the start's value, far above rounding, so that growth of it
             # is the same on every processor


def accelerate(K, M, C, x, v):
    """x'' by multipliers, C x'' = -2 alpha C x' - beta^2 C x."""
    n, m = len(K), len(C)
    A = np.block([[M, C.T], [C, np.zeros((m, m))]])
    b = np.concatenate([-K @ x, -2 * GAIN * C @ v - GAIN**2 * C @ x])
    return np.linalg.solve(A, b)[:n]


def runge_kutta(step):
    """The tip, and |C x|, over time."""
    K, M, C, x, _ = bodies.system()
    x[3] *= 1 + OFF
    v, tip, off = 0 * x, [x[-1]], [abs(C @ x)[0]]
    for _ in range(round(bodies.END / step)):
        ks = []
        for part in 0.0, 0.5, 0.5, 1.0:
            dx, dv = ks[-1] if ks else (0 * x, 0 * x)
            y, w = x + part * step * dx, v + part * step * dv
            ks.append((w, accelerate(K, M, C, y, w)))
        x, v = (z + step / 6 * sum(f * k[i] for f, k in zip((1, 2, 2, 1), ks))
                for i, z in ((0, x), (1, v)))
        tip.append(x[-1])
        off.append(abs(C @ x)[0])
    return np.array(tip), np.array(off)


def run(it):
    _, _, _, x, omega = bodies.system()
    right = x[-1] * np.cos(omega * bodies.END)
    good, _ = runge_kutta(0.001)
    it.right("the tip at 1 ms, by the same gains,", good[-1], right, 1e-9)
    tip, off = runge_kutta(bodies.STEP)
    it.wrong("the tip at 10 ms", tip[-1], right, 1.0)

    bodies.scene(it)
    it.says("raises the highest frequency from", 1, "simulate", "scene.yaml",
            "--seconds", bodies.END, "--step", bodies.STEP, "--initial",
            f"mode:1*{bodies.START}", "--method", "central-difference",
            "--constraints", f"baumgarte:alpha={GAIN:g},beta={GAIN:g}",
            "-o", "run.h5")
    found = bodies.run(it, "--method", "central-difference",
                       "--constraints", "baumgarte")
    it.right("the tip", found["tip"][-1], right, 1e-4)
    held = found["violation"]
    it.holds(np.max(held) < OFF * bodies.START,
             "Ritz: its violation stays below the start of the naive one")
    grown = np.log10(np.max(np.abs(tip)))
    it.row(f"a tip at 1e{grown:.0f} after 2 s" if grown > 1 else "wrong",
           f"{right:.4f}",
           f"`raises the highest frequency from ...`, with the limit of the "
           f"step; by its own gains {found['tip'][-1]:.4f}")
    it.picture("""set xlabel "s"
set ylabel "|C x|"
set logscale y
set format y "10^{%L}"
set yrange [1e-20:1e15]
set key top left
plot $data using 1:2 with lines lw 2 lc rgb "#b2182b" title "gains of 300/s at steps of 10 ms", \\
    "" using 1:3 with lines lw 2 lc rgb "#2166ac" title "Ritz, gains of its own"
""", "The violation at steps of 10 ms grows by a factor of 1.4 a step; that of Ritz, "
               "which starts without one, stays at rounding.",
               data=(found["seconds"], np.maximum(off, 1e-20),
                     np.maximum(held, 1e-20)))
