"""A mode that leaves the band while the joint turns

The joint of two beams turns from 90 degrees to 0 in a minute, and the second bending mode vibrates. A program has at each angle the modes below 1.8 Hz. There are two at first, and from 24 degrees on one: the mode that vibrates is dropped with all its energy, and the motion stops. In truth the joint turns slowly enough for the energy to follow the frequency, E / omega constant.

Ritz refuses a basis that is not continuous, and names mode and angle, also where a number of modes ends between two that cross. With 9 modes at all angles the energy is right.
"""
import numpy as np

import hinge
import naive

GROUP = "Joints that turn"

BAND = 1.8
ANGLES = np.sort(np.append(np.arange(0, 91, 2), (24.05, 24.2)))[::-1]


def exchange_modes(eigenvalues):
    """Energy at each angle: amplitudes of the modes in the band, of constant E /
    omega as long as they are there; the second one begins with 1."""
    action = eigenvalues[0]**-0.5
    energy = []
    for value in eigenvalues:
        action = action if naive.hertz(value) < BAND else 0.0
        energy.append(action * value**0.5)
    return np.array(energy)


def run(it):
    hinge.scene(it, (0, 30, 60, 90), BAND)
    eigenvalues = np.array([hinge.modes(d)[0][8] for d in ANGLES])
    right = np.sqrt(eigenvalues / eigenvalues[0])
    wrong = exchange_modes(eigenvalues)
    it.wrong("energy at the end", wrong[-1], right[-1], 1.0)
    path = ("--sweep", "twist=90:0:60s:smooth", "--step", "0.02", "--initial",
            "mode:9")
    it.says("mode 9 (flexible mode 2) leaves the band of 1.8 Hz at twist=24.1",
            1, "simulate", "scene.yaml", *path, "-o", "run.h5")
    it.says("mode 12, 5.057 Hz, changes places with the next one", 1,
            "simulate", "scene.yaml", *path, "--sweep-modes", "12", "-o",
            "run.h5")
    it.tool("simulate", "scene.yaml", *path, "--sweep-modes", "9", "--every",
            "20", "-o", "run.h5")
    found = it.columns("run.h5")
    energy = found["kinetic"] + found["potential"]
    energy /= energy[0]
    # the adiabatic law itself is off by the rate over the frequency
    it.right("energy at the end", energy[-1], right[-1], 1e-2)
    at = np.interp(-found["angle_deg"], -ANGLES, right)
    it.right("energy at each angle", energy, at, 1e-2)
    it.row(f"the motion ends at 24 degrees, energy {wrong[-1]:.2g}",
           f"energy {right[-1]:.4g} times that of the start",
           "refused by mode and angle; with 9 modes right to 1e-2, "
           f"{energy[-1]:.4g}")
    it.picture("""set xlabel "angle of the hinge, degrees"
set ylabel "energy, 1 at the start"
set xrange [90:0]
set yrange [0:1.7]
set key left bottom
plot $ritz using 1:2 with lines lw 3 lc rgb "#2166ac" title "Ritz, 9 modes", \\
    $law using 1:2 with lines lw 1 dt 2 lc rgb "#000000" title "E / {/Symbol w} constant", \\
    $law using 1:3 with lines lw 2 dt 2 lc rgb "#b2182b" title "modes in the band at each angle"
""", "Energy of the second mode: it leaves the band at 24 degrees, and with it "
               "a program that exchanges modes loses the motion.",
               law=(ANGLES, right, wrong),
               ritz=(found["angle_deg"], energy))
