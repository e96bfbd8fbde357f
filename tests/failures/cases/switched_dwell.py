"""A switched model under a bad dwell time

Two directions 10 degrees apart carry the motion of a mass on springs of 1/4 and 400 in turn, and the state is projected on each as it comes. Every reduced model is stable, the full one decays, and a projection takes mass and velocity from the state; but it may add strain, since the directions are no modes. Switched after a quarter turn of each, the motion grows sixfold a cycle.

Ritz checks the library before it runs: where projectors do not commute with K, it says how long a set must dwell, and refuses less. With that dwell the motion decays: small pushes across and along make Ritz change the set every 84 s, one change multiplies the energy 40 times, and each stretch still ends with less than a tenth of the energy with which the one before ended. The offset of [McDaniel2000] (5.2.6-9), which projects nothing, is stable with the same library at any time, as the damping is proportional to the mass.
"""
import re

import numpy as np

import models

GROUP = "Runs over time"

STRETCH, STRETCHES, PUSH = 84, 4, 0.01  # s; force of a second between them
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


def pushes(first):
    """A force of a second at every second stretch, as a file of --input."""
    rows = [(0, 0)]
    for t in range(first * STRETCH, STRETCHES * STRETCH, 2 * STRETCH):
        rows += [(t - 0.1, 0), (t, PUSH), (t + 1, PUSH), (t + 1.1, 0)]
    return "".join(f"{t:g} {force:g}\n" for t, force in rows)


def files(it):
    """Of the component, the library, the start and the inputs; the command."""
    plane = models.Model(K, np.eye(2), [(1, 1), (1, 2)],
                         D=DAMPING * np.eye(2))
    component = it.component("plane", plane, "--output-at", "x=1:1", "--input",
                             "along=1:1", "--input", "across=1:2")
    it.write("library.mtx", "%%MatrixMarket matrix array real general\n2 2\n" +
             "".join(f"{v:.17g}\n" for v in VECTORS.T.ravel()))
    it.write("start.txt", "1 0.5\n0 0\n")
    it.write("across.txt", pushes(1))
    it.write("along.txt", pushes(2))
    return ["simulate", component, "--switched", "library.mtx",
            "--redundant", "--switch-interval", "0.5", "--indicator", "0.02",
            "--seconds", STRETCHES * STRETCH, "--step", "0.1", "--initial",
            "start.txt", "--input", "across=across.txt", "--input",
            "along=along.txt"]


def check_decay(it):
    """Of the run that keeps each set as long as is needed."""
    found = it.columns("run.h5")
    energy = found["kinetic"] + found["potential"]
    ends = energy[np.searchsorted(found["seconds"], STRETCH * np.arange(
        1, STRETCHES + 1) - 0.5)]
    it.holds(found["switches"][-1] >= STRETCHES - 1 and
             np.max(found["vectors"]) == 1,
             "Ritz: one vector at a time, changed after each stretch")
    gained = found["energy gained at switches"][-1]
    it.holds(gained > 40 * ends[0],
             f"Ritz: changes add {gained / ends[0]:.2g} times the energy")
    it.holds(np.all(np.diff(np.log10([energy[0], *ends])) < -1),
             "Ritz: each stretch ends with a tenth of the energy of the one "
             f"before at most, the last with {ends[-1] / energy[0]:.1g} of it")


def run(it):
    stiff = [v @ K @ v for v in VECTORS.T]
    quarter = [np.pi / 2 / np.sqrt(k) for k in stiff]
    growth = cycle(quarter)
    it.wrong("growth of a cycle", growth, 1.0, 4.0)

    command = files(it)
    line = it.says("projection at a switch may raise the energy", 1, *command,
                   "--jump", "project", "-o", "run.h5")
    dwell = float(re.search(r"dwell ([0-9.e+]+) s are stable", line).group(1))
    it.holds(cycle([dwell, dwell]) < 1 and cycle([dwell, 1.1 * dwell]) < 1,
             "naive: sets that dwell as long as Ritz asks decay")
    it.says("are needed", 0, *command, "--jump", "project", "--dwell",
            f"{1.001 * dwell:.4g}", "-o", "run.h5")
    check_decay(it)
    it.says("a common Lyapunov function", 0, *command, "-o", "run.h5")
    it.row(f"grows {growth:.1f} times a cycle", "decays",
           f"refused: `projection at a switch may raise the energy`; sets that "
           f"dwell {dwell:.3g} s, or an offset in place of the projection, "
           "are stable")
