"""Two beams of rectangular section, end to start on a hinge about their axis: as
it turns, the soft plane of one meets the stiff plane of the other."""
import numpy as np
import scipy.linalg as la

import models

ELEMENTS = 6


def beams():
    return (models.space_beam(ELEMENTS, (1.0, 4.0)),
            models.space_beam(ELEMENTS, (1.5, 6.0)))


def joint(degrees, n):
    """T: dofs of both, each in its own axes, of those that are free."""
    t = np.radians(degrees)
    R = np.array([[1, 0, 0], [0, np.cos(t), -np.sin(t)],
                  [0, np.sin(t), np.cos(t)]])
    T = np.zeros((2 * n, 2 * n - 5))
    T[:n, :n] = np.eye(n)
    T[n:n + 3, n - 6:n - 3] = R.T
    T[n + 4:n + 6, n - 3:n] = R.T[1:]
    T[n + 3, n] = 1.0
    T[n + 6:, n + 1:] = np.eye(n - 6)
    return T


def modes(degrees):
    """Eigenvalues of the system, and its modes as dofs of both bodies."""
    a, b = beams()
    T = joint(degrees, len(a.K))
    K, M = la.block_diag(a.K, b.K), la.block_diag(a.M, b.M)
    eigenvalues, X = la.eigh(T.T @ K @ T, T.T @ M @ T)
    return eigenvalues, T @ X


def reduced(degrees, bases):
    """Eigenvalues of the bodies in bases of their own, joined."""
    bodies = beams()
    n = len(bodies[0].K)
    Q = [la.orth(basis, rcond=1e-6) for basis in bases]
    held = la.null_space(joint(degrees, n).T).T  # rows that must be zero
    free = la.null_space(held @ la.block_diag(*Q))
    K, M = (la.block_diag(*(q.T @ getattr(body, name) @ q
                            for q, body in zip(Q, bodies)))
            for name in "KM")
    return la.eigvalsh(free.T @ K @ free, free.T @ M @ free)


def scene(it, angles, band, select="", basis="full"):
    """Both bodies as components, and scene.yaml."""
    a, b = beams()
    it.component("a", a, "--port", f"end={ELEMENTS + 1}")
    it.component("b", b, "--port", "start=1")
    it.write("scene.yaml", f"""\
scene: two beams on a hinge
components:
  a: {{model: a.h5, basis: {basis}}}
  b: {{model: b.h5, basis: {basis}}}
joints: [{{name: twist, between: [a/end, b/start], type: hinge, axis: [1, 0, 0], angles_deg: {list(angles)}}}]
band_hz: [0, {band}]
{select}""")
