"""A peak between grid points, at zeta = 1e-4

A resonance at f is 2 zeta f wide: half a millihertz at 2.4 Hz. Of 300 points spread evenly in log f over two decades none falls into it: the largest response in the plot is a sixtieth of what is there, and which peak is highest is an accident of the grid. 400 points happen to come near, 401 do not.

Ritz adds each peak and twelve points beside it, from a quarter of its width to eight.
"""
import numpy as np

import models
import naive

GROUP = "Damping and responses"


def run(it):
    zeta = 1e-4
    row = models.chain([1.0] * 10, [1e4] * 10)
    _, omega, Phi = naive.modal_damping(row.K, row.M, zeta)

    def response(hertz):
        s = 2j * np.pi * np.atleast_1d(hertz)[:, None]
        return np.abs(np.sum(Phi[9]**2 / (
            s**2 + 2 * zeta * omega * s + omega**2), axis=1))

    peak = omega[0] * np.sqrt(1 - 2 * zeta**2) / (2 * np.pi)
    right = response(peak)[0]
    grid = np.geomspace(0.5, 40, 300)
    seen = response(grid).max()
    it.wrong("largest response", seen, right, 0.9)

    path = it.component("row", row, "--input", "push=10:1", "--output-at",
                        "tip=10:1")
    it.tool("frf", "--from-hz", 0.5, "--to-hz", 40, "--log", "--damping",
            "modal 1e-4", path, "-o", "response.h5")
    it.run("export", "--to", "tsv", "response.h5", "-o", "response.tsv",
           shown=False)
    table = np.loadtxt(it.folder / "response.tsv", comments="#")
    found = table[:, 1]
    it.right("largest response", found.max(), right, 1e-3)
    it.row(f"largest response {seen:.3g}", f"{right:.3g}",
           f"{found.max():.3g}, to 1e-3")
    near = (table[:, 0] > 2.3) & (table[:, 0] < 2.45)
    close = (grid > 2.3) & (grid < 2.45)
    it.picture("""set logscale y
set xlabel "Hz"
set ylabel "|H|"
set xrange [2.34:2.42]
set yrange [0.01:100]
set ytics 10
set key top left Left reverse samplen 2
plot $ritz using 1:2 with linespoints lw 1.4 pt 7 ps 0.3 lc rgb "#2166ac" title "Ritz", \\
    $grid using 1:2 with linespoints lw 2 pt 5 ps 0.5 lc rgb "#b2182b" title "even grid"
""", "The first peak of a row of masses at 1e-4 damping, as an even grid and as "
               "ritz-frf see it.",
               ritz=(table[near, 0], found[near]),
               grid=(grid[close], response(grid[close])))
