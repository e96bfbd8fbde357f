"""Modes that change places over the angle

Modes are numbered by frequency. The sixth flexible mode of two beams at 0 degrees bends; ten degrees on it has passed below a pair of torsional modes, which do not depend on the angle at all. A program that follows "mode 6" joins two curves that have nothing to do with each other, and gives the damping, the gain or the controller notch of one to the other.

Ritz follows shapes by MAC, in clusters where frequencies coincide, and tells where modes change places, come near, or are lost.
"""
import numpy as np
import scipy.linalg as la

import hinge
import naive

GROUP = "Joints that turn"


def mac(M, x, y):
    return (x @ M @ y)**2


def followed(angles, mode):
    """Frequencies of the mode whose shape goes on from angle to angle."""
    a, b = hinge.beams()
    M = la.block_diag(a.M, b.M)
    shape, hertz = None, []
    for degrees in angles:
        eigenvalues, X = hinge.modes(degrees)
        k = mode if shape is None else int(np.argmax(
            [mac(M, shape, x) for x in X.T]))
        shape = X[:, k]
        hertz.append(naive.hertz(eigenvalues)[k])
    return hertz


def run(it):
    fine = np.arange(0, 61)
    bending = followed(fine, 12)
    numbered = [naive.hertz(hinge.modes(d)[0])[12] for d in fine]
    a, b = hinge.beams()
    M = la.block_diag(a.M, b.M)
    alike = mac(M, hinge.modes(0)[1][:, 12], hinge.modes(60)[1][:, 12])
    it.wrong("frequency of the sixth mode at 60 degrees", numbered[-1],
             bending[-1], 0.15)
    it.holds(alike < 0.01, f"naive: MAC {alike:.1g} of modes 6 and 6")

    hinge.scene(it, range(0, 61, 10), 6.0)
    it.says("change places", 0, "assemble", "--tracks", "tracks.tsv",
            "scene.yaml", "-o", "system.h5")
    rows = [line.split("\t") for line in
            (it.folder / "tracks.tsv").read_text().split("\n")[1:] if line]
    track = [row[0] for row in rows if row[1] == "twist=0" and row[2] == "6"][0]
    found = {row[1]: float(row[3]) for row in rows if row[0] == track}
    it.right("frequency of its track at 60 degrees", found["twist=60"],
             bending[-1], 1e-7)
    it.row(f"{numbered[-1]:.3g} Hz at 60 degrees", f"{bending[-1]:.3g} Hz",
           f"{found['twist=60']:.3g} Hz; `change places`")
    it.picture("""set xlabel "angle of the hinge, degrees"
set ylabel "Hz"
set xrange [0:60]
set yrange [4.2:5.5]
set key bottom left
plot $data using 1:2 with lines lw 5 lc rgb "#f4a582" title "sixth by frequency", \\
    "" using 1:3 with lines lw 2 lc rgb "#2166ac" title "followed by shape, 1 degree steps", \\
    $ritz using 1:2 with points pt 7 ps 0.7 lc rgb "#2166ac" title "track of ritz-assemble"
""", "The sixth mode by number, and the mode that was the sixth.",
               data=(fine, numbered, bending),
               ritz=(range(0, 61, 10),
                     [found[f"twist={d}"] for d in range(0, 61, 10)]))
