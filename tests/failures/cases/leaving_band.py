"""Modes that leave and enter the band as a joint turns

Modes are chosen at one angle, since that is where the analysis was done: all below 1.8 Hz, which is one at 0 degrees. From 25 degrees on there are two. Chosen at 90 degrees, one of them leaves the band on the way to 0; chosen at 0, the second was never there, and the reduced model puts it where the rest of its few coordinates let it.

Ritz chooses at every configuration of the scene, keeps the union on each body, and measures the error at listed angles and between them.
"""
import numpy as np

import hinge
import naive

GROUP = "Joints that turn"


def run(it):
    band = 1.8
    start, X = hinge.modes(0)
    kept = int(np.sum(naive.hertz(start) < band))
    n = len(X) // 2
    bases = X[:n, :kept], X[n:, :kept]
    angles = np.arange(0, 91, 5)
    right = [naive.hertz(hinge.modes(d)[0])[7:11] for d in angles]
    wrong = [naive.hertz(hinge.reduced(d, bases))[7:11] for d in angles]
    it.right("frequency at 0 degrees, reduced,", wrong[0][0], right[0][0],
             1e-6)
    it.wrong("frequencies at 90 degrees", wrong[-1][:2], right[-1][:2], 0.1)
    it.holds(right[-1][1] < band < right[0][1],
             "the second mode is in the band at 90 degrees alone")

    hinge.scene(it, (0, 30, 60, 90), band)
    it.says("no angle need be added", 0, "compare", "scene.yaml", "-o",
            "system.h5")
    answer = it.tool("compare", "scene.yaml", "-o", "system.h5", shown=False)
    worst = max(c["errors"]["frequency"] for c in answer["configurations"])
    it.holds(worst < 1e-9, f"Ritz: wrong by {worst:.1g} at any angle")
    found = {float(c["at"].split("=")[1]):
             [f for f in c["frequencies_hz"] if f > 1e-3][:2]
             for c in answer["configurations"] if c["listed"]}
    flexible = found[90]
    it.right("frequencies in the band at 90 degrees", np.array(flexible),
             right[-1][:2], 1e-7)
    it.row(f"{wrong[-1][0]:.3g} and {wrong[-1][1]:.3g} Hz at 90 degrees",
           f"{right[-1][0]:.3g} and {right[-1][1]:.3g} Hz",
           f"{flexible[0]:.3g} and {flexible[1]:.3g} Hz, to 1e-7; the worst "
           "error between listed angles is printed")
    it.picture("""set xlabel "angle of the hinge, degrees"
set ylabel "Hz"
set xrange [0:90]
set yrange [0.5:3.2]
set key top right
set arrow from 0, 1.8 to 90, 1.8 nohead lw 1.5 lc rgb "#777777" dt 2
set label "end of the band" at 2, 1.7 tc rgb "#555555"
plot for [k = 2:3] $data using 1:k with lines lw 2 lc rgb "#2166ac" title k == 2 ? "right" : "", \\
    for [k = 2:3] $ritz using 1:k with points pt 7 ps 0.7 lc rgb "#2166ac" title k == 2 ? "Ritz" : "", \\
    for [k = 4:5] $data using 1:k with lines lw 2 dt 2 lc rgb "#b2182b" title k == 4 ? "mode chosen at 0 degrees alone" : ""
""", "Frequencies over the angle: the second mode is in the band from 25 degrees on, "
               "and a model of the mode at 0 degrees does not follow it.",
               data=(angles, *np.transpose(right)[:2],
                     *np.transpose(wrong)[:2]),
               ritz=(list(found), *np.transpose(list(found.values()))))
