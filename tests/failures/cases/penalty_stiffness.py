"""A penalty too stiff for the integrator

A constraint is a very stiff spring, the stiffer the more exact. An explicit integrator is unstable, because its step has to resolve the spring. An implicit one goes on, since it is stable for any stiffness, and the force in the joint alternates between nothing and twice the right one at every step, for ever. Positions look right, unless the spring is so stiff that the sum of both stiffnesses has no digits left for the bodies' own: then the motion is wrong too, although the constraint is satisfied to all digits.

Ritz chooses the stiffness from the step, refuses what an explicit integrator cannot hold, with the limit, and warns where an implicit one lets forces ring. It integrates the violation of the constraints as coordinates of their own, so that no stiffness takes digits from the motion. Its method of index 2 has no spring.
"""
import numpy as np

import bodies_in_time as bodies

GROUP = "Runs over time"
SPRING, STIFFEST = 1e9, 1e18


def newmark(beta, spring=SPRING):
    """Tip and force of the spring over time: beta 1/4 implicit, 0 explicit."""
    K, M, C, x, _ = bodies.system()
    K = K + spring * C.T @ C
    h = bodies.STEP
    v, tip, force = 0 * x, [x[-1]], [0.0]
    a = np.linalg.solve(M, -K @ x)
    with np.errstate(all="ignore"):
        for _ in range(round(bodies.END / h)):
            y = x + h * v + h * h * (0.5 - beta) * a
            new = np.linalg.solve(M + beta * h * h * K, -K @ y)
            x, v, a = y + beta * h * h * new, v + h / 2 * (a + new), new
            tip.append(x[-1])
            force.append(abs(spring * (C @ x)[0]))
    return np.array(tip), np.array(force)


def multiplier(seconds):
    """|lambda|: what the first row needs beside its own springs."""
    K, M, C, x, omega = bodies.system()
    rest = (K @ x - omega**2 * M @ x)[2]
    return abs(rest * np.cos(omega * seconds))


def run(it):
    _, _, _, x, omega = bodies.system()
    right = x[-1] * np.cos(omega * bodies.END)
    tip, _ = newmark(0.0)
    it.wrong("the tip, explicit,", tip[-1], right, 1e6)
    tip, force = newmark(0.25)
    t = bodies.STEP * np.arange(len(force))
    true = multiplier(t)
    it.right("the tip, implicit,", tip[-1], right, 1e-3)
    it.wrong("largest force, implicit,", np.max(force), np.max(true), 0.5)
    lost, _ = newmark(0.25, STIFFEST)
    exact = x[-1] * np.cos(omega * t)
    worst = np.argmax(np.abs(lost - exact))
    it.wrong("the tip, implicit, the stiffest spring,", lost[worst],
             exact[worst], 0.3)

    bodies.scene(it)
    stiff = "penalty:hz=5000,ratio=0"
    words = ("simulate", "scene.yaml", "--seconds", bodies.END, "--step",
             bodies.STEP, "--initial", f"mode:1*{bodies.START}")
    it.says("raises the highest frequency from", 1, *words, "--method",
            "central-difference", "--constraints", stiff, "-o", "run.h5")
    it.says("stiffer ones ring, and forces with them", 0, *words,
            "--constraints", stiff, "-o", "run.h5")
    # the spring moves a mass of 1 / (1 / 1.5 + 1 / 1) by w^2 m = k
    hz = np.sqrt(STIFFEST / 0.6) / (2 * np.pi)
    kept = bodies.run(it, "--constraints",
                      f"penalty:hz={hz:.4g},ratio=0")["tip"]
    it.right("the tip, that spring,", kept[-1], right, 1e-3)
    found = bodies.run(it, "--constraints", "index-2")
    held = found["multiplier"]
    it.right("the tip, index 2,", found["tip"][-1], right, 1e-3)
    it.right("largest force, index 2,", np.max(held), np.max(true), 1e-3)
    it.row(f"explicit: no motion; implicit: a force of {np.max(force):.2g} at "
           "most; a spring of 1e18: the tip moves by rounding",
           f"{np.max(true):.2g}; {right:.2g}",
           f"`raises the highest frequency`, with the limit; `stiffer ones "
           f"ring`; by index 2 {np.max(held):.2g}; the tip at {kept[-1]:.2g} "
           "with that spring")
    it.picture("""set xlabel "s"
set ylabel "force in the joint"
set xrange [0:2]
set yrange [0:*]
set key top right
plot $data using 1:3 with lines lw 1 lc rgb "#b2182b" title "stiff spring, trapezoidal rule", \\
    "" using 1:4 with lines lw 3 lc rgb "#2166ac" title "Ritz, index 2", \\
    "" using 1:2 with lines lw 1 dt 2 lc rgb "#000000" title "right"
""", "The force in the joint over time: that of a stiff spring alternates at each "
               "step.", data=(t, true, force, held))
