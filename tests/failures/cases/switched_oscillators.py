"""Two stable oscillators whose sequence grows

A reduced model is switched between two vectors, and its one coordinate is carried over: k/m is 1/4 while x and x' have one sign and 4 while they have not. Each oscillator is stable. But what one stores as potential energy the other reads as sixteen times as much: the amplitude grows fourfold every half turn, and 3.32 times with a damping of c/m = 0.1 ([McDaniel2000], 5.2.15-17; switches are found by event).

Ritz run on each oscillator alone, every run starting where the one before ended, gives the same growth, as nothing in two files says that they are one structure. Within one run it switches vectors, not coordinates: the state is that of the structure, what a set leaves out stays as it was, and the energy is one Lyapunov function for all sets, which is checked once for the library. The structure with these two stiffnesses, its modes switched as often as can be, never has more energy than at the start.
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


def chain_of_runs(it, c, turns=2):
    """Growth of half a turn by ritz-simulate: one run from event to event."""
    decay, rates = c / 2, {}
    for name, k in ("soft", 0.25), ("stiff", 4.0):
        row = models.chain([1.0], [k], D=np.array([[c]]))
        path = it.component(name, row, "--output-at", "x=1:1", "--output-at",
                            "v=1:1/vel")
        it.reduce(path, "full", out=f"{name}-whole")
        rates[name] = np.sqrt(k - decay**2)
    # x' vanishes where tan(r t) = 2 r / c, x after that where it is -2 r / c
    seconds = {"soft": np.arctan2(rates["soft"], decay) / rates["soft"],
               "stiff": np.arctan2(rates["stiff"], -decay) / rates["stiff"]}
    x, v = 0.0, 1.0
    for turn in range(turns):
        for name in "soft", "stiff":
            it.write("state.txt", f"{x:.17g} {v:.17g}\n")
            it.tool("simulate", f"{name}-whole.h5", "--seconds",
                    f"{seconds[name]:.17g}", "--step", f"{seconds[name]:.17g}",
                    "--initial", "state.txt", "-o", "stretch.h5",
                    shown=turn == 0 and c > 0)
            found = it.columns("stretch.h5")
            x, v = found["x"][-1], found["v"][-1]
            gone = abs(v if name == "soft" else x)
            it.holds(gone < 1e-13 * np.hypot(x, v), f"Ritz: {name}, c/m = "
                     f"{c:g}: the run ends at the event")
    return abs(v) ** (1 / turns)


def run(it):
    found = []
    for c, growth in ((0.0, 4.0), (0.1, 3.315416)):
        it.holds(abs(half_turn(c) / growth - 1) < 1e-6,
                 f"naive: grows {growth:g} times in half a turn, c/m = {c:g}")
        found.append(chain_of_runs(it, c))
        it.right(f"growth of a chain of runs, c/m = {c:g},", found[-1], growth,
                 1e-6 if c else 1e-12)
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
    table = it.columns("run.h5")
    energy = table["kinetic"] + table["potential"]
    switches = table["switches"][-1]
    it.holds(switches > 20, "Ritz: the set changes more than 20 times")
    it.holds(np.all(energy[1:] <= energy[:-1] * (1 + 1e-12)),
             "Ritz: the energy never grows")
    it.row("amplitude times 4 every half turn, 3.32 with damping",
           "none grows", "runs of Ritz, each continued by the next, also grow "
           f"{found[0]:.5f} and {found[1]:.5f} times; sets of one structure have one Lyapunov "
           "function: `a common Lyapunov function of all sets`, checked once")
