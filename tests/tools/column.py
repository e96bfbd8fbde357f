"""column.py ELEMENTS [free]: write a column along x, clamped at the left or
free, as K.mtx, M.mtx, dofs and column.bdf, and its geometric stiffness: tip.mtx
of a force that pushes the right end, spin.mtx of spin about z at the left end,
per square of its rate. E I = rho A = length = 1, E A = 1000.
column.py alike FILE...: fail unless in each model of the containers the
geometric stiffness, summed over all bodies, is K within 1e-11 of the largest
entry.
"""
import sys

import h5py
import numpy as np

LENGTH = 1.0


def bending(h):
    return np.array([[12, 6 * h, -12, 6 * h],
                     [6 * h, 4 * h * h, -6 * h, 2 * h * h],
                     [-12, -6 * h, 12, -6 * h],
                     [6 * h, 2 * h * h, -6 * h, 4 * h * h]]) / h ** 3


def inertia(h):
    return h / 420 * np.array(
        [[156, 22 * h, 54, -13 * h],
         [22 * h, 4 * h * h, 13 * h, -3 * h * h],
         [54, 13 * h, 156, -22 * h],
         [-13 * h, -3 * h * h, -22 * h, 4 * h * h]])


def tensioned(h, tension):
    """Integral of N v' v' over an element; N is a function of the position."""
    A = np.zeros((4, 4))
    for x, w in zip(*np.polynomial.legendre.leggauss(6)):
        s = (x + 1) / 2
        v = np.array([6 * s * (s - 1) / h, (1 - s) * (1 - 3 * s),
                      6 * s * (1 - s) / h, s * (3 * s - 2)])
        A += h * w / 2 * tension(s * h) * np.outer(v, v)
    return A


def assemble(n):
    h = LENGTH / n
    size = 3 * (n + 1)
    K, M, tip, spin = (np.zeros((size, size)) for _ in range(4))
    for e in range(n):
        bend = np.ix_(*2 * [[3 * e + k for k in (1, 2, 4, 5)]])
        pull = np.ix_(*2 * [[3 * e, 3 * e + 3]])
        K[bend] += bending(h)
        K[pull] += 1000 / h * np.array([[1, -1], [-1, 1]])
        M[bend] += inertia(h)
        M[pull] += h / 6 * np.array([[2, 1], [1, 2]])
        tip[bend] += tensioned(h, lambda x: -1.0)
        spin[bend] += tensioned(
            h, lambda x: (LENGTH ** 2 - (e * h + x) ** 2) / 2)
    return {"K": K, "M": M, "tip": tip, "spin": spin}


def write(name, A):
    entries = [(i, j) for j in range(len(A)) for i in range(j, len(A))
               if A[i, j] != 0]
    with open(f"{name}.mtx", "w") as file:
        print("%%MatrixMarket matrix coordinate real symmetric", file=file)
        print(*A.shape, len(entries), file=file)
        for i, j in entries:
            print(i + 1, j + 1, repr(float((A[i, j] + A[j, i]) / 2)), file=file)


def values(item):
    """Of a dense matrix, or of a sparse one, whose zeros may not be stored."""
    if isinstance(item, h5py.Dataset):
        return item[()]
    n = len(item["indptr"]) - 1
    A = np.zeros((n, n))
    for j in range(n):
        for p in range(item["indptr"][j], item["indptr"][j + 1]):
            A[item["indices"][p], j] = item["data"][p]
    return A


def alike(*paths):
    for path in paths:
        with h5py.File(path) as file:
            models = []
            file.visititems(lambda name, item: models.append(item.parent)
                            if name.endswith("KG") else None)
            assert models, f"{path} has no geometric stiffness"
            for model in models:
                K = values(model["K"])
                KG = sum(values(load["matrix"] if "matrix" in load else load)
                         for load in model["KG"].values())
                gap = abs(K - KG).max() / abs(K).max()
                assert gap <= 1e-11, f"{path}, {model.name}: {gap}"


def main(n, *words):
    if n == "alike":
        return alike(*words)
    n = int(n)
    kept = np.arange(0 if "free" in words else 3, 3 * (n + 1))
    for name, A in assemble(n).items():
        write(name, A[np.ix_(kept, kept)])
    with open("dofs", "w") as file:
        for k in kept:
            print(k // 3 + 1, (1, 2, 6)[k % 3], file=file)
    with open("column.bdf", "w") as file:
        for k in range(n + 1):
            print(f"GRID,{k + 1},,{k * LENGTH / n:.7g},0.,0.", file=file)


main(*sys.argv[1:])
