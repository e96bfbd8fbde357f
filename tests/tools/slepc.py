"""What slepc.sh does in Python: make a model, damage one, compare bases.

membrane SIDE [EVERY]: write m.K.mtx, m.M.mtx and m.dofs of a free square grid of
SIDE x SIDE masses. Springs join neighbours, entries of M couple diagonal ones.
With EVERY = 7, say, only every seventh dof has a mass, and M is diagonal.
flaw KIND SIDE: the same with a mass of one on each grid, and a flaw at dof 250:
`soft`: a spring of negative stiffness; `light`: a mass of -0.01.
beam NUMBER: the same for equal masses in a row. Springs, no two alike, resist
the bending at each mass.
residual BASIS...: fail unless |lambda K^-1 M x - x| / |x| of all modes is below
1e-10, with the matrices that `beam` wrote and its first two masses held.
damping DOFS SIDE: write m.D.mtx, which is not symmetric, and m.K4.mtx, for that
grid.
alike REDUCED REDUCED...: fail unless all reduced components agree with the first.
same BASIS BASIS...: fail unless all bases agree with the first.
damage FILE ENTRY VALUE [unsealed]: overwrite an entry of K; with `unsealed` its
checksum is removed, otherwise it no longer fits.
"""
import sys

import h5py
import numpy as np


def springs(side):
    stiffness = {(k, k): 0.0 for k in range(side * side)}
    for at in range(side * side):
        for to in ([at + 1] if (at + 1) % side else []) + [at + side]:
            if to < side * side:
                stiffness[to, at] = -1.0
                for k in at, to:
                    stiffness[k, k] += 1.0
    return stiffness


def flaw(kind, side):
    at = 249
    stiffness = springs(int(side))
    mass = {(k, k): 1.0 for k in range(int(side) ** 2)}
    if kind == "soft":
        stiffness[at, at] -= 5.0
    else:
        mass[at, at] = -0.01
    write(int(side) ** 2, stiffness, mass)


def membrane(side, every=1):
    side, every = int(side), int(every)
    n = side * side
    stiffness = springs(side)
    mass = {(k, k): 1.0 for k in range(0, n, every)}
    if every == 1:  # entries of M where K has none, so that patterns differ
        for k in range(n - side):
            for to in ([k + side + 1] if (k + 1) % side else []) + \
                    ([k + side - 1] if k % side else []):
                mass[to, k] = 0.1
    write(n, stiffness, mass)


def write(n, stiffness, mass):
    for name, entries in ("K", stiffness), ("M", mass):
        with open(f"m.{name}.mtx", "w") as file:
            print("%%MatrixMarket matrix coordinate real symmetric", file=file)
            print(n, n, len(entries), file=file)
            for (i, j), value in sorted(entries.items()):
                print(i + 1, j + 1, value, file=file)
    with open("m.dofs", "w") as file:
        for k in range(n):
            print(k + 1, 3, file=file)


def bend(n):
    K = np.zeros((n, n))
    for k in range(n - 2):
        bend = np.array([1.0, -2.0, 1.0])
        K[k:k + 3, k:k + 3] += (1 + 0.3 * np.sin(k)) * np.outer(bend, bend)
    return K


def beam(number):
    n = int(number)
    K = bend(n)
    write(n, {(i, j): K[i, j] for i in range(n)
              for j in range(max(0, i - 2), i + 1)},
          {(k, k): 1.0 for k in range(n)})


def residual(*paths):
    """Two steps of refinement give as many digits as long doubles have."""
    for path in paths:
        T, hertz = columns(path)
        modes = np.isfinite(hertz)
        x = T[2:, modes].astype(np.longdouble)
        value = (2 * np.pi * hertz[modes].astype(np.longdouble)) ** 2
        K = bend(len(T))[2:, 2:]
        moved = 0 * x
        for _ in range(3):
            rest = x - K.astype(np.longdouble) @ moved
            moved += np.linalg.solve(K, rest.astype(float))
        worst = max(np.sqrt(((value * moved - x) ** 2).sum(axis=0) /
                            (x ** 2).sum(axis=0)))
        assert worst <= 1e-10, f"{path}: a residual of {worst}"


def damping(path, side):
    with open(path) as file:
        n = len(file.readlines())
    D = {(k, k): 0.1 + k % 5 for k in range(n)}
    D |= {(k + int(side), k): 0.5 for k in range(n - int(side))}
    K4 = {(k, k): 0.02 for k in range(0, n, 2)}
    for name, entries in ("D", D), ("K4", K4):
        with open(f"m.{name}.mtx", "w") as file:
            print("%%MatrixMarket matrix coordinate real general", file=file)
            print(n, n, len(entries), file=file)
            for (i, j), value in sorted(entries.items()):
                print(i + 1, j + 1, value, file=file)


def alike(first, *others):
    """All numbers agree to 1e-12 of the largest of their data set: sums of a few
    hundred products of six digits more."""
    with h5py.File(first) as one:
        sets = []
        one.visititems(lambda name, item: sets.append(name)
                       if isinstance(item, h5py.Dataset) else None)
        assert "K" in sets and "T" in sets, sets
        for path in others:
            with h5py.File(path) as other:
                for name in sets:
                    a, b = one[name][()], other[name][()]
                    if one[name].dtype.kind not in "fi":
                        assert np.array_equal(a, b), f"{path}: {name}"
                        continue
                    gap = np.where(np.isnan(a) & np.isnan(b), 0.0, abs(a - b))
                    assert gap.max(initial=0.0) <= 1e-12 * np.nanmax(
                        abs(a), initial=0.0), f"{path}: {name}"


def columns(path):
    with h5py.File(path) as file:
        return file["T"][:], file["columns/hertz"][:]


def same(first, *others):
    """Constraint modes agree to 1e-12 and eigenvalues to 1e-10, relative. The
    vectors of a cluster span the same space to ten times residual / gap:
    residuals are below 1e-11 of |K||x|, and gaps between the clusters of these
    models above 1e-3 of it."""
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
    {"membrane": membrane, "flaw": flaw, "beam": beam, "residual": residual,
     "damping": damping, "alike": alike, "same": same, "damage": damage}[sys.argv[1]](
        *sys.argv[2:])
