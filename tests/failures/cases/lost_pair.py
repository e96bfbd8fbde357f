"""A member of a double mode is lost

Lanczos from a single vector sees one direction of each eigenspace, however long it runs. On a cube of bars, whose modes come in pairs and triplets, thirty steps with full reorthogonalisation, and with a proper shift, give each frequency once. Nothing looks wrong, and modes are missing.

Ritz returns every member: it counts the eigenvalues below a frequency by Sylvester's law and searches until as many are found, and it never cuts a cluster, so that a list may be longer than asked.
"""
import numpy as np
import scipy.linalg as la

import models
import naive

GROUP = "Modes"


def run(it):
    cube = models.lattice(3, 3, 3)
    right = la.eigvalsh(cube.K, cube.M)[6:14]
    found = naive.lanczos(cube.K, cube.M, -right[0], 30)
    once = found[found > 1e-3 * right[0]]
    below = right[-1] * 1.0001
    it.wrong("modes up to the eighth", np.sum(once < below), len(right), 0.4)
    it.wrong("third flexible eigenvalue", once[2], right[2], 0.05)

    component = it.component("cube", cube)
    answer = it.tool("basis", "macneal-rubin", "--modes", 7,
                     component, "-o", "modes.h5")
    flexible = [f for f in answer["frequencies_hz"] if f > 0]
    it.right("flexible frequencies", flexible[:8], naive.hertz(right), 1e-9)
    it.holds(len(flexible) == 9, "Ritz: nine of seven, to cut no cluster")
    it.row(f"{np.sum(once < below)} modes up to "
           f"{naive.hertz(right)[-1]:.3g} Hz", str(len(right)),
           f"{len([f for f in flexible if f < naive.hertz(below)])}, asked "
           "for seven: the last is one of three")
    it.picture("""set xlabel "mode, flexible ones"
set ylabel "Hz"
set xrange [0.5:9.5]
set yrange [3:6]
set key top left Left reverse
plot $right using 1:2 with linespoints lw 1.4 pt 6 ps 1.2 lc rgb "#2166ac" title "right, and Ritz", \\
    $naive using 1:2 with linespoints lw 1.4 pt 5 ps 0.6 lc rgb "#b2182b" title "Lanczos from one vector"
""", "Modes by number: a solver that sees each frequency once runs ahead.",
               right=(range(1, 10), flexible),
               naive=(range(1, 7), naive.hertz(once[:6])))
