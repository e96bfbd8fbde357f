#!/usr/bin/python3 -s
"""Write the beam of SOURCE.md: K, M, KG (Matrix Market, lower triangles) and the
deck of its grids. Twelve Hermite elements in the xy plane; rows are T1, T2 and R3
of each grid."""
import math
import pathlib

LENGTH, ELEMENTS = 10.0, 12
EA, EI, MASS = 7e10 * 4e-4, 7e10 * 2e-7, 1.2  # N, N m^2, kg/m
HUB = 1e9  # N/m and N m, the bearing of the root
FOLDER = pathlib.Path(__file__).resolve().parent


def gauss4():
    """Points and weights on 0..1, exact to degree 7."""
    a, b = (math.sqrt(3 / 7 - s * 2 / 7 * math.sqrt(6 / 5)) for s in (1, -1))
    u, v = (0.25 + s * math.sqrt(30) / 72 for s in (1, -1))
    return [(0.5 - b / 2, v), (0.5 - a / 2, u), (0.5 + a / 2, u),
            (0.5 + b / 2, v)]


def shapes(s, h):
    """Across the axis: values, slopes and curvatures at s = x / h."""
    return ([1 - 3*s**2 + 2*s**3, h*(s - 2*s**2 + s**3), 3*s**2 - 2*s**3,
             h*(s**3 - s**2)],
            [(6*s**2 - 6*s)/h, 1 - 4*s + 3*s**2, (6*s - 6*s**2)/h,
             3*s**2 - 2*s],
            [(12*s - 6)/h**2, (6*s - 4)/h, (6 - 12*s)/h**2, (6*s - 2)/h])


def matrices():
    """K, M, KG as dictionaries of their lower triangles."""
    h = LENGTH / ELEMENTS
    K, M, KG = {}, {}, {}

    def add(A, i, j, value):
        if i >= j:
            A[i, j] = A.get((i, j), 0.0) + value

    for e in range(ELEMENTS):
        along, across = [3*e, 3*e + 3], [3*e + 1, 3*e + 2, 3*e + 4, 3*e + 5]
        for s, weight in gauss4():
            N, slope, bend = shapes(s, h)
            x = h * (e + s)
            tension = 0.5 * MASS * (LENGTH**2 - x**2)
            for a, i in enumerate(along):
                for b, j in enumerate(along):
                    add(K, i, j, weight * EA / h * (1 if a == b else -1))
                    add(M, i, j, weight * h * MASS * [1 - s, s][a]
                        * [1 - s, s][b])
            for a, i in enumerate(across):
                for b, j in enumerate(across):
                    add(K, i, j, weight * h * EI * bend[a] * bend[b])
                    add(M, i, j, weight * h * MASS * N[a] * N[b])
                    add(KG, i, j, weight * h * tension * slope[a] * slope[b])
    for i in range(3):
        add(K, i, i, HUB)
    return K, M, KG


def write_matrix(name, A):
    n = 3 * (ELEMENTS + 1)
    with open(FOLDER / name, "w") as out:
        print("%%MatrixMarket matrix coordinate real symmetric", file=out)
        print(n, n, len(A), file=out)
        for (i, j), value in sorted(A.items(), key=lambda item: item[0][::-1]):
            print(i + 1, j + 1, f"{value:.17g}", file=out)


def write_deck():
    """Grids with T3, R1 and R2 held, and a cell for each element."""
    with open(FOLDER / "beam.bdf", "w") as out:
        print("BEGIN BULK", file=out)
        for g in range(ELEMENTS + 1):
            print(f"GRID,{g + 1},,{g * LENGTH / ELEMENTS:.12g},0.0,0.0,,345",
                  file=out)
        for e in range(ELEMENTS):
            print(f"CBAR,{e + 1},1,{e + 1},{e + 2},0.0,1.0,0.0", file=out)
        print("ENDDATA", file=out)


if __name__ == "__main__":
    for name, A in zip(("K.mtx", "M.mtx", "KG.mtx"), matrices()):
        write_matrix(name, A)
    write_deck()
