"""K unsymmetric by 1e-7

Superelements arrive unsymmetric in the seventh digit. A general eigensolver takes that for follower forces: of each double mode it makes a complex pair, one of which grows. A ring of twelve masses, undamped and stable, becomes unstable.

Ritz averages an asymmetry up to 1e-6 of the largest entry, says how large it was and keeps that in the component; more is refused.
"""
import numpy as np
import scipy.linalg as la

import models
from failure import write_matrix

GROUP = "Matrices as they come"


def run(it):
    ring = models.ring(12)
    noise = np.random.default_rng(3).uniform(-1, 1, ring.K.shape)
    skew = (noise - noise.T) / 2 * (ring.K != 0) * np.abs(ring.K).max()
    K = ring.K + 1e-7 * skew
    poles = np.sqrt(-la.eigvals(K).astype(complex))
    grows = np.max(np.abs(poles.real))
    it.holds(grows > 1e-8, "naive: a pole grows that should not")

    path = it.component("ring", models.Model(K, ring.M, ring.dofs),
                        "--output-at", "o=1:0")
    it.says("averaged away", 0, "import", "--stiffness", "ring.K.mtx",
            "--mass", "ring.M.mtx", "--dofs", "ring.dofs", "-o", "again.h5")
    poles = it.tool("poles", path, "--modes", 11)["poles"]
    omega = np.sqrt(2 - 2 * np.cos(2 * np.pi * np.arange(1, 7) / 12))
    it.right("frequencies", np.array(sorted(p["hertz"] for p in poles)),
             np.repeat(omega, [2] * 5 + [1]) / (2 * np.pi), 1e-6)
    write_matrix(it.folder / "more.K.mtx", ring.K + 1e-5 * skew)
    it.says("1e-06 is let pass", 1, "import", "--stiffness", "more.K.mtx",
            "--mass", "ring.M.mtx", "--dofs", "ring.dofs", "-o", "more.h5")
    it.row(f"a pole grows by {grows:.2g} rad/s", "none does",
           "averaged away, with a warning; at 1e-5 refused")
