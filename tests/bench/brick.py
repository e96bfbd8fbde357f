#!/usr/bin/python3 -s
"""brick.py NX NY NZ FOLDER - a solid block of 8-node bricks, free, steel,
consistent mass: K.mtx, M.mtx, grids.bdf and dofs.txt (units kg m s).

Benchmarks use it; the element is integrated with 2 x 2 x 2 Gauss points.
"""
import itertools
import pathlib
import sys

import numpy
import scipy.io
import scipy.sparse

E, NU, RHO, SIZE = 2.1e11, 0.3, 7850.0, 0.1


def element():
    """Stiffness and mass, 24 x 24, of a cube with edges SIZE."""
    corner = numpy.array(list(itertools.product((-1, 1), repeat=3)))
    lame = E * NU / ((1 + NU) * (1 - 2 * NU))
    shear = E / (2 * (1 + NU))
    C = numpy.diag([2 * shear] * 3 + [shear] * 3)
    C[:3, :3] += lame
    K, M = numpy.zeros((24, 24)), numpy.zeros((24, 24))
    for point in itertools.product((-1 / 3**0.5, 1 / 3**0.5), repeat=3):
        f = 1 + corner * point
        N = f.prod(axis=1) / 8
        dN = numpy.stack([corner[:, i] * f[:, (i + 1) % 3] * f[:, (i + 2) % 3]
                          for i in range(3)]) / 8 * 2 / SIZE
        B = numpy.zeros((6, 24))
        for i in range(3):
            j = (i + 1) % 3
            B[i, i::3] = dN[i]
            B[3 + i, i::3] = dN[j]
            B[3 + i, j::3] = dN[i]
        weight = (SIZE / 2)**3
        K += B.T @ C @ B * weight
        M += RHO * weight * numpy.kron(numpy.outer(N, N), numpy.eye(3))
    return K, M


def main():
    nx, ny, nz = map(int, sys.argv[1:4])
    folder = pathlib.Path(sys.argv[4])
    node = numpy.arange((nx + 1) * (ny + 1) * (nz + 1)).reshape(
        nx + 1, ny + 1, nz + 1)
    cells = numpy.stack([node[i:i + nx, j:j + ny, k:k + nz].ravel()
                         for i, j, k in itertools.product((0, 1), repeat=3)],
                        axis=1)
    dofs = (3 * cells[:, :, None] + numpy.arange(3)).reshape(len(cells), 24)
    rows = numpy.repeat(dofs, 24, axis=1).ravel()
    cols = numpy.tile(dofs, (1, 24)).ravel()
    n = 3 * node.size
    for name, A in zip("KM", element()):
        A = scipy.sparse.coo_matrix(
            (numpy.tile(A.ravel(), len(cells)), (rows, cols)), (n, n)).tocsc()
        scipy.io.mmwrite(folder / f"{name}.mtx", (A + A.T) / 2,
                         symmetry="symmetric", precision=17)
    with open(folder / "grids.bdf", "w", encoding="ascii") as deck:
        for (i, j, k), m in numpy.ndenumerate(node):
            deck.write(f"GRID,{m + 1},,{i * SIZE:.6g},{j * SIZE:.6g},"
                       f"{k * SIZE:.6g}\n")
    with open(folder / "dofs.txt", "w", encoding="ascii") as table:
        for m in range(node.size):
            table.write("".join(f"{m + 1} {c}\n" for c in (1, 2, 3)))
    print(n)


main()
