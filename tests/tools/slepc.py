"""Parts of slepc.sh that are Python: a model, and comparisons of bases.

membrane SIDE [EVERY]: write m.K.mtx, m.M.mtx and m.dofs of a free square of
SIDE x SIDE masses with springs between neighbours, and with entries of M
between diagonal neighbours. With EVERY, only every EVERY-th dof has a mass.
same BASIS BASIS...: compare each basis with the first.
damage FILE ENTRY VALUE [unsealed]: overwrite an entry of K, and leave its
checksum as it was or, with `unsealed`, remove it.
"""
import sys

import h5py
import numpy as np


def membrane(side, every=1):
    side, every = int(side), int(every)
    n = side * side
    stiffness = {}
    for at in range(n):
        for to in ([at + 1] if (at + 1) % side else []) + [at + side]:
            if to < n:
                stiffness[to, at] = -1.0
                for k in at, to:
                    stiffness[k, k] = stiffness.get((k, k), 0.0) + 1.0
    mass = {(k, k): 1.0 for k in range(0, n, every)}
    if every == 1:  # couple dofs in M that K does not couple
        for k in range(n - side):
            for to in ([k + side + 1] if (k + 1) % side else []) + \
                    ([k + side - 1] if k % side else []):
                mass[to, k] = 0.1
    for name, entries in ("K", stiffness), ("M", mass):
        with open(f"m.{name}.mtx", "w") as file:
            print("%%MatrixMarket matrix coordinate real symmetric", file=file)
            print(n, n, len(entries), file=file)
            for (i, j), value in sorted(entries.items()):
                print(i + 1, j + 1, value, file=file)
    with open("m.dofs", "w") as file:
        for k in range(n):
            print(k + 1, 3, file=file)


def columns(path):
    with h5py.File(path) as file:
        return file["T"][:], file["columns/hertz"][:]


def same(first, *others):
    """Constraint modes agree to 1e-12, eigenvalues to 1e-10, relative. Subspaces
    of clusters agree to ten times residual over gap: residuals of both are below
    1e-11 |K| |x|, and gaps between clusters of these models above 1e-3 |K|."""
    T, hertz = columns(first)
    modes = np.isfinite(hertz)
    value = hertz[modes] ** 2
    scale = np.maximum(value, 1e-6 * value.max(initial=0.0))
    cut = np.flatnonzero(np.diff(value) > 1e-6 * value[1:]) + 1
    for path in others:
        other, found = columns(path)
        assert (np.isfinite(found) == modes).all(), f"{path}: other columns"
        assert (abs(found[modes] ** 2 - value) <= 1e-10 * scale).all(), \
            f"{path}: eigenvalues"
        assert abs(other - T)[:, ~modes].max(initial=0.0) <= 1e-12, \
            f"{path}: constraint modes"
        for a, b in zip(np.split(T[:, modes], cut, axis=1),
                        np.split(other[:, modes], cut, axis=1)):
            if a.shape[1] > 0:
                angle = np.linalg.svd(np.linalg.qr(a)[0].T @
                                      np.linalg.qr(b)[0])[1]
                sine = np.sqrt(max(0.0, 1.0 - angle.min() ** 2))
                assert sine <= 1e-7, f"{path}: a subspace turns by {sine}"
                rest = b - a @ np.linalg.lstsq(a, b, rcond=None)[0]
                assert np.linalg.norm(rest) <= 10 * 1e-11 / 1e-3 * \
                    np.linalg.norm(b), f"{path}: subspaces"


def damage(path, entry, value, *how):
    with h5py.File(path, "r+") as file:
        data = file["K/data"]
        data[int(entry)] = float(value)
        if how:
            del data.attrs["checksum"]


if __name__ == "__main__":
    {"membrane": membrane, "same": same, "damage": damage}[sys.argv[1]](
        *sys.argv[2:])
