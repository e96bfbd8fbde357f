"""Softening without stiffening: a blade above its first frequency

A structure that spins is softened by W^2 M within the plane of rotation, since centrifugal forces grow with deflection, and stiffened by the tension that the same forces make. A program whose strains are linear has the first term and not the second. Its blade then loses all stiffness at the rate of its first frequency, where that of the real one only rises: the inconsistent model of [PadillaVonFlotow1992].

Ritz takes geometric stiffness KG of the centrifugal load with the model, and keeps all terms. Asked for the inconsistent model, or without KG, it names the component and what is missing, and at which rate the stiffness stops being positive definite.
"""
import numpy as np
import scipy.linalg as la

import failure
import models

GROUP = "Runs over time"
N, W = 12, 5.0


def blade():
    """Clamped beam of unit length, lumped masses with a small rotary inertia;
    EI = rho A = 1; and KG of its tension at 1 rad/s."""
    model = models.beam(N)
    h = 1.0 / N
    masses = np.full(N + 1, h)
    masses[[0, -1]] = h / 2
    M = np.diag(np.column_stack([masses, masses * h * h / 24]).ravel())
    KG = np.zeros_like(model.K)
    turn = np.diag([1.0, -1.0, 1.0, -1.0])
    g = turn @ (np.array([[36, 3*h, -36, 3*h], [3*h, 4*h*h, -3*h, -h*h],
                          [-36, -3*h, 36, -3*h], [3*h, -h*h, -3*h, 4*h*h]])
                / (30 * h)) @ turn
    for e in range(N):
        tension = sum(masses[i] * i * h for i in range(e + 1, N + 1))
        rows = np.ix_(range(2 * e, 2 * e + 4), range(2 * e, 2 * e + 4))
        KG[rows] += tension * g
    free = slice(2, None)
    return models.Model(model.K[free, free], M[free, free], model.dofs[2:],
                        model.positions), KG[free, free]


SCENE = """scene: blade
components:
  blade: {model: %s, stiffening: {spin_yy: spin}}
spin: {axis: [0, 1, 0], rate: %g}
spin_model: %s
"""
WITHOUT = """scene: blade
components:
  blade: {model: without.h5}
spin: {axis: [0, 1, 0], rate: %g}
"""


def run(it):
    model, KG = blade()
    rest = la.eigvalsh(model.K, model.M)
    right = np.sqrt(la.eigvalsh(model.K + W**2 * (KG - model.M), model.M)[0])
    naive = np.sqrt(max(la.eigvalsh(model.K - W**2 * model.M, model.M)[0], 0))
    it.wrong("first frequency at 5 rad/s", naive, right, 0.9)

    failure.write_matrix(it.folder / "KG.mtx", KG)
    component = it.component("blade", model, "--geometric-stiffness",
                             "KG.mtx@spin")
    it.reduce(component, "full")
    bare = it.component("bare", model)
    it.reduce(bare, "full", out="without")
    it.write("without.yaml", WITHOUT % W)
    for name in ("consistent", "inconsistent"):
        it.write(f"{name}.yaml", SCENE % ("reduced.h5", W, name))
    answer = it.tool("assemble", "inconsistent.yaml", "-o", "wrong.h5")
    it.notes(answer, "stops being positive definite")
    it.right("rate at which it fails", answer["stable_rate"], np.sqrt(rest[0]),
             1e-5)
    it.says("unstable", 0, "poles", "wrong.h5")
    answer = it.tool("assemble", "without.yaml", "-o", "without-spun.h5")
    it.notes(answer, "component 'blade' has no 'stiffening: {spin_yy: LOAD}'")
    it.notes(answer, f"above {np.sqrt(rest[0]):.6g} rad/s, where the stiffness")
    it.right("rate at which it fails without KG", answer["stable_rate"],
             np.sqrt(rest[0]), 1e-5)
    it.tool("assemble", "consistent.yaml", "-o", "spun.h5")
    answer = it.tool("poles", "spun.h5")
    found = 2 * np.pi * min(p["hertz"] for p in answer["poles"])
    it.right("first frequency at 5 rad/s", found, right, 1e-6)
    it.row(f"{naive:.4g} rad/s, unstable", f"{right:.4g} rad/s",
           f"{found:.4g} rad/s; without KG a warning that names the component "
           f"and {np.sqrt(rest[0]):.4g} rad/s, up to which the stiffness is "
           "definite")
