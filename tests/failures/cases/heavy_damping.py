"""Gregory's values at zeta = 0.3

With 30 % of damping every mode overlaps with its neighbours, however far apart they are. The formula for light damping gives the second mode of two joined oscillators more than five times its value.

Ritz warns, as for close modes: what counts is the coupling in the exact Gramian, not a rule about gaps or ratios.
"""

import numpy as np

import failure

GROUP = "Rankings"


def run(it):
    pair = failure.load("close-pair")
    gregory, exact, pairs, answer = pair.both(it, pair.oscillators(0.35), 0.3)
    it.wrong("second value by Gregory", gregory[1], pairs[1], 4)
    it.notes(answer, "trust the exact ones")
    it.right("exact values", np.sort(answer["system_values"])[::-1], exact,
             1e-8)
    it.row(f"second value {gregory[1]:.2g}", f"{pairs[1]:.2g}",
           f"`modes 1 and 2 couple`; exact values beside, "
           f"{answer['system_values'][2]:.2g} and "
           f"{answer['system_values'][3]:.2g}")
