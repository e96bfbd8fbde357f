"""A switched model under a bad dwell time

Two directions 10 degrees apart carry the motion of a mass on springs of 1/4 and 400 in turn, and the state is projected on each as it comes. Every reduced model is stable, the full one decays, and a projection takes mass and velocity from the state; but it may add strain, since the directions are no modes. Switched after a quarter turn of each, the motion grows sixfold a cycle.

Ritz checks the library before it runs: where projectors do not commute with K, it says how long a set must dwell, and refuses less. With that dwell the motion decays. The offset of [McDaniel2000] (5.2.6-9), which projects nothing, is stable with the same library at any time, as the damping is proportional to the mass.
"""
import re

import numpy as np

import models

GROUP = "Runs over time"

K, DAMPING = np.diag([0.25, 400.0]), 0.1
ANGLE = np.radians(10)
VECTORS = np.array([[1.0, np.cos(ANGLE)], [0.0, np.sin(ANGLE)]])


def over(k, t):
    """[x, x'] of one oscillator after t."""
    r = np.sqrt(k - DAMPING**2 / 4)
    e, s, o = np.exp(-DAMPING * t / 2), np.sin(r * t) / r, np.cos(r * t)
    return e * np.array([[o + DAMPING / 2 * s, s],
                         [-k * s, o - DAMPING / 2 * s]])


def cycle(times):
    """Growth of a cycle of both sets, each projected on the other."""
    turn = np.eye(2)
    for j, t in enumerate(times):
        psi = VECTORS[:, j]
        turn = (VECTORS[:, 0] @ VECTORS[:, 1]) * over(psi @ K @ psi, t) @ turn
    return np.max(np.abs(np.linalg.eigvals(turn)))


def run(it):
    stiff = [v @ K @ v for v in VECTORS.T]
    quarter = [np.pi / 2 / np.sqrt(k) for k in stiff]
    growth = cycle(quarter)
    it.wrong("growth of a cycle", growth, 1.0, 4.0)

    plane = models.Model(K, np.eye(2), [(1, 1), (1, 2)],
                         D=DAMPING * np.eye(2))
    component = it.component("plane", plane, "--output-at", "x=1:1")
    it.write("library.mtx", "%%MatrixMarket matrix array real general\n2 2\n" +
             "".join(f"{v:.17g}\n" for v in VECTORS.T.ravel()))
    it.write("start.txt", "1 0.5\n-0.1 2\n")
    command = ["simulate", component, "--switched", "library.mtx",
               "--redundant", "--switch-interval", "0.5", "--indicator", "0.5",
               "--seconds", "400", "--step", "0.1", "--initial", "start.txt"]
    line = it.says("projection at a switch may raise the energy", 1, *command,
                   "--jump", "project", "-o", "run.h5")
    dwell = float(re.search(r"dwell ([0-9.e+]+) s are stable", line).group(1))
    it.holds(cycle([dwell, dwell]) < 1 and cycle([dwell, 1.1 * dwell]) < 1,
             "naive: sets that dwell as long as Ritz asks decay")
    it.says("are needed", 0, *command, "--jump", "project", "--dwell",
            f"{1.001 * dwell:.4g}", "-o", "run.h5")
    it.says("a common Lyapunov function", 0, *command, "-o", "run.h5")
    it.row(f"grows {growth:.1f} times a cycle", "decays",
           f"refused: `projection at a switch may raise the energy`; sets that "
           f"dwell {dwell:.3g} s, or an offset in place of the projection, "
           "are stable")
