"""Bases that are exchanged as a joint turns

A pendulum of two equal springs hangs on a body that a hinge turns by a quarter in 9 s. A program has the modes of each angle and exchanges one set for the next, each mode with its amplitude. In the axes of the body they are the same at all angles, so that the pendulum swings on along the body's x axis, and its plane turns with the body. In truth it keeps its plane in space, as Foucault's does.

Ritz has the rates of the basis, and of the axes of the bodies, in the damping and the stiffness of the reduced model; `--sweep-basis without-terms` leaves them out.
"""
import numpy as np

import models

GROUP = "Joints that turn"

SECONDS, OMEGA, MASS = 9.0, 2.0, 2.0


def pendulum():
    """Grid 1 of 0.1 each way, and a mass at a distance of 1 on springs."""
    K, M = np.zeros((9, 9)), np.diag([0.1] * 6 + [MASS] * 3)
    arm = np.array([[0, 0, 0], [0, 0, 1], [0, -1, 0]])  # theta x (1, 0, 0)
    stretch = np.hstack([-np.eye(3), -arm, np.eye(3)])
    for row, k in zip(stretch, MASS * OMEGA**2 * np.array([1, 1, 100])):
        K += k * np.outer(row, row)
    return models.Model(K, M, [(1, c) for c in range(1, 7)] +
                        [(2, c) for c in range(1, 4)],
                        {1: (0.0, 0.0, 0.0), 2: (1.0, 0.0, 0.0)})


def base():
    """What hardly moves: 1e10 each way."""
    return models.Model(1e10 * np.eye(6), 1e4 * np.eye(6),
                        [(1, c) for c in range(1, 7)], {1: (0.0, 0.0, 0.0)})


def simulate(it, basis):
    it.tool("simulate", "scene.yaml", "--sweep", f"turn=0:90:{SECONDS:g}s",
            "--sweep-basis", basis, "--sweep-modes", 8, "--step", 0.005,
            "--every", 20, "--input", "kick=impulse", "-o", "run.h5",
            shown=basis == "switched")
    found = it.columns("run.h5")
    return found["seconds"], np.column_stack([found["x"], found["y"]])


def run(it):
    it.component("base", base(), "--port", "hub=1")
    it.component("bob", pendulum(), "--port", "hub=1", "--port", "tip=2")
    it.write("scene.yaml", """\
scene: a pendulum on a hinge
components:
  base: {model: base.h5, basis: full}
  bob: {model: bob.h5, basis: full}
joints: [{name: turn, between: [base/hub, bob/hub], type: hinge, axis: [0, 0, 1], angles_deg: [0], state: locked}]
inputs: [{name: kick, at: bob/tip, component: 1}]
outputs: [{name: x, at: bob/tip, component: 1}, {name: y, at: bob/tip, component: 2}]
""")
    t, ritz = simulate(it, "switched")
    angle = np.pi / 2 * t / SECONDS
    swing = np.sin(OMEGA * t) / (MASS * OMEGA)
    right = np.column_stack([np.cos(angle) * swing, -np.sin(angle) * swing])
    naive = np.column_stack([swing, 0 * swing])
    it.wrong("the plane of the swing, in the axes of the body,",
             naive.ravel(), right.ravel(), 0.9)
    # (w h)^2 / 12 of a phase of 18: 1.5e-4
    it.right("the same", ritz.ravel(), right.ravel(), 3e-4)
    _, without = simulate(it, "without-terms")
    it.right("without the terms the naive one", without.ravel(), naive.ravel(),
             3e-4)
    it.row("the plane turns with the body: off by its whole swing",
           "the plane stays in space", "right to 3e-4, the step's own error")
