"""Two stable oscillators whose sequence grows

A reduced model is switched between two vectors, and its one coordinate is carried over: k/m is 1/4 while x and x' have one sign and 4 while they have not. Each oscillator is stable. But what one stores as potential energy the other reads as sixteen times as much: the amplitude grows fourfold every half turn, and 3.32 times with a damping of c/m = 0.1 ([McDaniel2000], 5.2.15-17; switches are found by event).

Ritz switches vectors, not coordinates: the state is that of the structure, what a set leaves out stays as it was, and the energy is one Lyapunov function for all sets, which is checked once for the library. The structure with these two stiffnesses, its modes switched as often as can be, never has more energy than at the start.
"""
import numpy as np

import models

GROUP = "Runs over time"


def to_event(k, c, state, which):
    """Onward to where x (0) or x' (1) vanishes, exactly but for bisection."""
    r = np.sqrt(k - c * c / 4)

    def at(t):
        e, s, o = np.exp(-c * t / 2), np.sin(r * t) / r, np.cos(r * t)
        x, v = state
        return np.array([e * ((o + c / 2 * s) * x + s * v),
                         e * (-k * s * x + (o - c / 2 * s) * v)])
    low, high = 0.0, np.pi / r
    sign = at(1e-9)[which]
    for _ in range(100):
        middle = (low + high) / 2
        low, high = ((middle, high) if at(middle)[which] * sign > 0
                     else (low, middle))
    return at(low)


def half_turn(c):
    """Growth of the amplitude, carried over by the coordinate."""
    state = to_event(0.25, c, np.array([0.0, 1.0]), 1)
    return abs(to_event(4.0, c, state, 0)[1])


def run(it):
    for c, growth in ((0.0, 4.0), (0.1, 3.315416)):
        it.holds(abs(half_turn(c) / growth - 1) < 1e-6,
                 f"naive: grows {growth:g} times in half a turn, c/m = {c:g}")
    it.wrong("growth of what cannot grow", half_turn(0.1), 1.0, 2.0)

    plane = models.Model(np.diag([0.25, 4.0]), np.eye(2), [(1, 1), (1, 2)],
                         D=0.1 * np.eye(2))
    component = it.component("plane", plane, "--output-at", "x=1:1")
    it.write("start.txt", "1 0.5\n-0.6 2\n")
    command = ("simulate", component, "--switched", "modes",
               "--switch-interval", "0.05", "--indicator", "0.5",
               "--seconds", "40", "--step", "0.05", "--initial", "start.txt",
               "-o", "run.h5")
    it.says("a common Lyapunov function of all sets", 0, *command)
    it.run("export", "-q", "--to", "tsv", "run.h5", "-o", "run.tsv",
           shown=False)
    with open(it.folder / "run.tsv", encoding="utf-8") as file:
        names = file.readline()[2:].rstrip("\n").split("\t")
    table = np.loadtxt(it.folder / "run.tsv")
    energy = (table[:, names.index("kinetic")] +
              table[:, names.index("potential")])
    switches = table[-1, names.index("switches")]
    it.holds(switches > 20, "Ritz: the set changes more than 20 times")
    it.holds(np.all(energy[1:] <= energy[:-1] * (1 + 1e-12)),
             "Ritz: the energy never grows")
    it.row("amplitude times 4 every half turn, 3.32 with damping",
           "none grows", "sets of one structure have one Lyapunov function: "
           "`a common Lyapunov function of all sets`, checked once")
