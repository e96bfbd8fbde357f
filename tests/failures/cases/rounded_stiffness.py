"""K rounded to ten digits, and to five

Rigid motion costs no energy because large numbers cancel. Entries that were rounded on their way through a text file do not cancel: the free body hangs on springs, or falls off negative ones. With ten digits "rigid" modes of this beam lie up to 1.5 Hz, with five at 150 Hz, some of them imaginary.

Ritz reads how many digits the values have, and measures whether their rounding holds the body: `source-digits` and `grounding` of `ritz-check` fail. At ten digits six modes are still told to be rigid, by the gap behind them; at five a basis is refused.
"""
import numpy as np
import scipy.linalg as la

import models
import naive

GROUP = "Matrices as they come"


def rounded(A, digits):
    return np.array([[float(f"{value:.{digits - 1}e}") for value in row]
                     for row in A])


def rigid_hertz(K, M):
    """The largest of the six that should be zero."""
    return np.sqrt(np.max(np.abs(la.eigvalsh(K, M)[:6]))) / (2 * np.pi)


def run(it):
    beam = models.space_beam(10, (1 / 3, 1 / 7))
    beam.K *= np.pi * 1e5
    digits = np.arange(3, 17)
    held = [rigid_hertz(rounded(beam.K, d), beam.M) for d in digits]
    exact = naive.hertz(la.eigvalsh(beam.K, beam.M)[6:9])
    it.wrong("rigid modes at ten digits, Hz over the first flexible,",
             1 + held[digits.tolist().index(10)] / exact[0], 1, 1e-3)
    it.wrong("rigid modes at five digits, the same,",
             1 + held[digits.tolist().index(5)] / exact[0], 1, 0.1)

    for count in (10, 5):
        text = models.Model(rounded(beam.K, count), beam.M, beam.dofs,
                            beam.positions)
        path = it.component(f"beam{count}", text)
        it.says("too few: the body is held by them", 1, "check", path)
    answer = it.tool("basis", "macneal-rubin", "--modes", 3, "beam10.h5", "-o",
                     "basis.h5")
    it.holds(answer["frequencies_hz"][:6] == [0] * 6,
             "Ritz: six rigid modes out of ten digits")
    it.right("flexible frequencies out of ten digits",
             np.array(answer["frequencies_hz"][6:]), exact, 1e-6)
    it.says("not positive semidefinite", 1, "basis", "macneal-rubin",
            "--modes", 3, "beam5.h5", "-o", "basis.h5")
    ten, five = (held[digits.tolist().index(d)] for d in (10, 5))
    it.row(f"rigid modes up to {ten:.2g} Hz (ten digits), {five:.2g} Hz (five)",
           "0 Hz", "check fails: `the body is held by them`; at ten digits "
           "six modes at 0, at five the basis is refused")
    it.picture("""set logscale y
set format y "10^{%L}"
set xlabel "digits of K"
set ylabel "Hz"
set xrange [2.5:16.5]
set yrange [1e-4:1e6]
set ytics 100
set key top right
plot $data using 1:3 with lines lw 2 lc rgb "#777777" title "first flexible mode", \\
    "" using 1:2 with linespoints lw 2 pt 7 ps 0.6 lc rgb "#b2182b" title "largest of six \\"rigid\\" modes"
""", "What rounding of K makes of six rigid modes of a free beam, by the number "
               "of digits kept.",
               data=(digits, held, np.full(len(digits), exact[0])))
