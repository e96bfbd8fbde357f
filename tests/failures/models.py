"""Small models, as arrays of NumPy: K, M, where grids stand, what a row is.

Written apart from Ritz and from its tests, which share nothing with these.
"""
import pathlib

import numpy as np
import scipy.io
from scipy.spatial.transform import Rotation

DATA = pathlib.Path(__file__).resolve().parents[2] / "data"


class Model:
    """K, M and D of dofs (grid, component) at positions by grid."""

    def __init__(self, K, M, dofs, positions=None, D=None):
        self.K, self.M, self.D = np.asarray(K), np.asarray(M), D
        self.dofs, self.positions = dofs, positions or {}

    def rows(self, grid):
        """Of that grid."""
        return [i for i, (g, _) in enumerate(self.dofs) if g == grid]


def chain(masses, springs, D=None):
    """Masses in a row; springs[i] is before mass i, 0 where there is none."""
    n = len(masses)
    K = np.zeros((n, n))
    for i, k in enumerate(springs):
        K[i, i] += k
        if i > 0:
            K[i - 1, i - 1] += k
            K[i, i - 1] -= k
            K[i - 1, i] -= k
    return Model(K, np.diag(np.asarray(masses, float)),
                 [(i + 1, 1) for i in range(n)],
                 {i + 1: (float(i), 0.0, 0.0) for i in range(n)}, D)


def ring(n):
    """Unit masses on a ring of unit springs: lambda = 2 - 2 cos(2 pi j / n)."""
    K = 2 * np.eye(n) - np.roll(np.eye(n), 1, 0) - np.roll(np.eye(n), -1, 0)
    return Model(K, np.eye(n), [(i + 1, 0) for i in range(n)])


def assemble(elements, n):
    """Sum of (rows, k, m)."""
    K, M = np.zeros((n, n)), np.zeros((n, n))
    for rows, k, m in elements:
        K[np.ix_(rows, rows)] += k
        M[np.ix_(rows, rows)] += m
    return K, M


def bending(h, EI=1.0, mass=1.0):
    """Stiffness and consistent mass of a plane beam element, (w, theta)."""
    k = EI / h**3 * np.array([[12, 6 * h, -12, 6 * h],
                              [6 * h, 4 * h * h, -6 * h, 2 * h * h],
                              [-12, -6 * h, 12, -6 * h],
                              [6 * h, 2 * h * h, -6 * h, 4 * h * h]])
    m = mass * h / 420 * np.array([[156, 22 * h, 54, -13 * h],
                                   [22 * h, 4 * h * h, 13 * h, -3 * h * h],
                                   [54, 13 * h, 156, -22 * h],
                                   [-13 * h, -3 * h * h, -22 * h, 4 * h * h]])
    return k, m


def beam(n, lumped=False):
    """Free beam of n elements along x, EI = rho A = L = 1: T3 and R2 of a grid
    (R2 is minus the slope). Lumped masses have no rotational inertia."""
    h = 1.0 / n
    k, m = bending(h)
    turn = np.diag([1.0, -1.0, 1.0, -1.0])
    if lumped:
        m = np.diag([h / 2, 0, h / 2, 0])
    K, M = assemble([(range(2 * e, 2 * e + 4), turn @ k @ turn,
                      turn @ m @ turn) for e in range(n)], 2 * n + 2)
    return Model(K, M, [(g + 1, c) for g in range(n + 1) for c in (3, 5)],
                 {g + 1: (g * h, 0.0, 0.0) for g in range(n + 1)})


def space_beam(n, EI=(1.0, 1.0), L=1.0):
    """Free beam of n elements along x with six dofs a grid; EA = 1e4, GJ = 1,
    rho A = 1, and as much rotational inertia about its axis."""
    h = L / n
    turn = np.diag([1.0, -1.0, 1.0, -1.0])
    elements = []
    for e in range(n):
        at = 6 * e
        rod = np.array([[1, -1], [-1, 1]]) / h
        lump = np.array([[2, 1], [1, 2]]) * h / 6
        k, m = bending(h, EI[0])
        elements += [([at, at + 6], 1e4 * rod, lump),
                     ([at + 3, at + 9], rod, 1e-2 * lump),
                     ([at + 1, at + 5, at + 7, at + 11], k, m)]
        k, m = bending(h, EI[1])
        elements.append(([at + 2, at + 4, at + 8, at + 10],
                         turn @ k @ turn, turn @ m @ turn))
    K, M = assemble(elements, 6 * n + 6)
    return Model(K, M, [(g + 1, c) for g in range(n + 1)
                        for c in range(1, 7)],
                 {g + 1: (g * h, 0.0, 0.0) for g in range(n + 1)})


def turned(model, vector):
    """The same body turned as a whole; symmetric to the last bit."""
    R = Rotation.from_rotvec(vector).as_matrix()
    T = np.kron(np.eye(len(model.K) // 3), R)
    K, M = T @ model.K @ T.T, T @ model.M @ T.T
    return Model((K + K.T) / 2, (M + M.T) / 2, model.dofs,
                 {g: tuple(R @ p) for g, p in model.positions.items()})


def lattice(a, b, c, stiffness=1e3):
    """Free block of a x b x c unit cubes of bars with every diagonal, unit
    masses at their corners, three dofs a grid: what a solid mesh looks like."""
    grids = [(x, y, z) for x in range(a + 1) for y in range(b + 1)
             for z in range(c + 1)]
    elements = []
    for i, p in enumerate(grids):
        for j, q in enumerate(grids[:i]):
            d = np.subtract(p, q).astype(float)
            if np.abs(d).max() > 1:
                continue
            e = d / np.linalg.norm(d)
            k = stiffness * np.outer(e, e) / np.linalg.norm(d)
            elements.append((list(range(3 * i, 3 * i + 3)) +
                             list(range(3 * j, 3 * j + 3)),
                             np.block([[k, -k], [-k, k]]), 0.0))
    K, _ = assemble(elements, 3 * len(grids))
    return Model(K, np.eye(len(K)), [(i + 1, c) for i in range(len(grids))
                                     for c in (1, 2, 3)],
                 {i + 1: tuple(map(float, p)) for i, p in enumerate(grids)})


def shipped(folder, name, damping=False):
    """K, M, D and rows of data/FOLDER/NAME."""
    def read(what):
        return scipy.io.mmread(DATA / folder / f"{name}.{what}.mtx").toarray()

    try:
        K, M = read("k"), read("m")
    except OSError:
        K, M = read("K"), read("M")
    dofs = [tuple(map(int, line.split()))
            for line in (DATA / folder / f"{name}.dofs").read_text().split("\n")
            if line.strip() and not line.startswith("#")]
    return Model(K, M, dofs, None, read("D") if damping else None)
