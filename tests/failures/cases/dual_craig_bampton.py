"""Dual Craig-Bampton

Components joined by forces in the place of displacements give an indefinite system: one negative eigenvalue for each interface force that has mass. Frequencies printed as sqrt(max(lambda, 0)) list them among the rigid modes, twelve of a free body; a time integration grows at the rate of the residual modes, whatever the band.

Ritz counts the negative eigenvalues of every configuration, prints them as negative frequencies, and gives such systems neither responses nor a second stage; nor is a body exported that has columns for it.
"""
import numpy as np
import scipy.linalg as la

import models
import naive

GROUP = "Reduced models that are unstable"


def dual(beam, modes):
    """K and M of two beams, end to start, joined by forces [Rixen2004]."""
    eigenvalues, Phi = la.eigh(beam.K, beam.M)
    n, kept = len(beam.K), 6 + modes
    Lambda = np.diag(eigenvalues[:kept])
    C_q, G_sum, H_sum = [], 0, 0
    for rows, sign in ((range(n - 6, n), 1.0), (range(6), -1.0)):
        F = sign * np.eye(n)[:, rows]
        G = Phi[:, kept:] / eigenvalues[kept:] @ (Phi[:, kept:].T @ F)
        C_q.append(F.T @ Phi[:, :kept])
        G_sum = G_sum + F.T @ G
        H_sum = H_sum + G.T @ beam.M @ G
    C_q = np.hstack(C_q)
    zero = np.zeros_like(Lambda)
    K = np.block([[np.block([[Lambda, zero], [zero, Lambda]]), C_q.T],
                  [C_q, -G_sum]])
    return K, la.block_diag(np.eye(2 * kept), H_sum)


def run(it):
    beam = models.space_beam(4)
    eigenvalues = la.eigvalsh(*dual(beam, 3))
    negative = eigenvalues[eigenvalues < -1.0]
    it.holds(len(negative) == 6, "naive: six negative eigenvalues")
    zeros = int(np.sum(naive.hertz(eigenvalues) < 1e-3))
    it.wrong("rigid modes", zeros, 6, 0.9)

    it.component("a", beam, "--port", "end=5")
    it.component("b", beam, "--port", "start=1")
    it.write("scene.yaml", """\
scene: two beams, end to end
components:
  a: {model: a.h5, basis: dual-craig-bampton, modes: 3}
  b: {model: b.h5, basis: dual-craig-bampton, modes: 3}
joints: [{name: weld, between: [a/end, b/start], type: fixed}]
inputs: [{name: push, at: a/end, component: 2}]
outputs: [{name: seen, at: b/start, component: 2}]
band_hz: [0, 5]
damping: {modal: 0.01}
""")
    it.says("negative-eigenvalues", 0, "assemble", "scene.yaml", "-o",
            "system.h5")
    found = np.array(it.tool("assemble", "scene.yaml", "-o", "system.h5",
                             shown=False)["configurations"][0]
                     ["frequencies_hz"])
    it.right("negative frequencies", np.sort(found[found < 0]),
             -np.sqrt(-negative) / (2 * np.pi), 1e-6)
    it.says("an unstable model has no steady response", 1, "frf",
            "--from-hz", 0.1, "system.h5", "-o", "response.h5")
    it.says("has negative eigenvalues", 1, "compare", "scene.yaml", "-o",
            "small.h5")
    it.row(f"{zeros} rigid modes, six of them growing",
           "six, and all others stable",
           "`negative-eigenvalues` 6, fail; no response, no second stage")
