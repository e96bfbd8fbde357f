"""Times of tools on large sparse state spaces: the table of
docs/methods/sparse-spaces.md.

    /usr/bin/python3 -s tests/bench/spaces.py build/release/bin

Seconds are of the processor, of the tool and what it starts, on one thread.
"""
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

import numpy
import scipy.io
import scipy.sparse as sparse


def write(folder, name, **matrices):
    """Matrix Market files; the option of ritz-import that names them."""
    files = []
    for letter, A in matrices.items():
        path = folder / f"{name}.{letter}.mtx"
        scipy.io.mmwrite(path, sparse.coo_matrix(A), precision=17)
        files.append(f"{letter}={path}")
    return ",".join(files)


def rail(folder):
    """Cooling of a rail [Saak2003]; None where there are no external data."""
    at = pathlib.Path(os.environ.get("RITZ_EXTERNAL_DATA", "../shared/data"),
                      "state_space/rail_371")
    if not at.exists():
        return None
    return ",".join(f"{letter}={at / letter}.mtx" for letter in "ABCE")


def heat(folder, n=100):
    """Bilinear elements on n x n cells of a square, cold on one side."""
    K = numpy.array([[4, -1, -2, -1], [-1, 4, -1, -2], [-2, -1, 4, -1],
                     [-1, -2, -1, 4]]) / 6
    M = numpy.array([[4, 2, 1, 2], [2, 4, 2, 1], [1, 2, 4, 2],
                     [2, 1, 2, 4]]) / (36 * n * n)
    i, j = (x.ravel() for x in numpy.meshgrid(range(n), range(n),
                                              indexing="ij"))
    corner = numpy.stack([i * (n + 1) + j, (i + 1) * (n + 1) + j,
                          (i + 1) * (n + 1) + j + 1, i * (n + 1) + j + 1])
    rows = numpy.repeat(corner[:, None], 4, 1).transpose(2, 0, 1).ravel()
    columns = numpy.repeat(corner[None], 4, 0).transpose(2, 0, 1).ravel()
    K, M = (sparse.csc_matrix((numpy.tile(A.ravel(), n * n), (rows, columns)))
            for A in (K, M))
    kept = numpy.array([a * (n + 1) + b for a in range(1, n + 1)
                        for b in range(1, n + 1)])
    B, C = numpy.zeros((n * n, 2)), numpy.zeros((2, n * n))
    a, b = numpy.divmod(numpy.arange(n * n), n)
    B[(a < n // 4) & (b < n // 4), 0] = 1
    B[n * n // 2 + n // 2, 1] = 1
    C[0, n * n - n // 3] = 1
    C[1, (a >= n // 2) & (b >= n // 2)] = 4 / n / n
    return write(folder, "heat", A=-K[kept][:, kept], B=B, C=C,
                 E=M[kept][:, kept])


def beam(folder, n=706):
    """Masses on a fourth difference, damped, in first-order form."""
    D2 = sparse.diags([1.0, -2.0, 1.0], [0, 1, 2], shape=(n - 2, n)).tocsc()
    ends = sparse.diags([numpy.r_[1, numpy.zeros(n - 2), 1]], [0])
    K = D2.T @ D2 + ends
    one = sparse.identity(n)
    B, C = numpy.zeros((2 * n, 3)), numpy.zeros((3, 2 * n))
    for k, (u, y) in enumerate(((0.2, 0.1), (0.5, 0.4), (0.9, 0.7))):
        B[n + int(u * n), k] = C[k, int(y * n)] = 1
    return write(folder, "beam", B=B, C=C,
                 A=sparse.bmat([[None, one], [-K, -0.001 * one - 0.01 * K]]))


def seconds(folder, *command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([str(x) for x in command], cwd=folder, text=True,
                          capture_output=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        return "refused"
    used = (after.ru_utime - before.ru_utime + after.ru_stime
            - before.ru_stime)
    return f"{used:.2g} s" if used < 10 else f"{used:.0f} s"


def main():
    bin_ = pathlib.Path(sys.argv[1]).resolve()
    os.environ["OMP_NUM_THREADS"] = "1"
    steps = {
        "import, with stability": ("ritz-import", "-q", "--state-space",
                                   "MATRICES", "-o", "m.h5"),
        "response, 400 points": ("ritz-frf", "-q", "m.h5", "--to-hz", "BAND",
                                 "--points", "400", "-o", "f.h5"),
        "krylov, 40 states": ("ritz-basis", "-q", "krylov", "--modes", "40",
                              "m.h5", "-o", "b.h5"),
        "tangential, 10 states": ("ritz-basis", "-q", "tangential", "--modes",
                                  "10", "m.h5", "-o", "b.h5"),
        "balanced, 20 states": ("ritz-basis", "-q", "balanced", "--modes",
                                "20", "m.h5", "-o", "b.h5"),
        "reduction": ("ritz-reduce", "-q", "m.h5", "b.h5", "-o", "r.h5"),
        "verify, with norms": ("ritz-verify", "-q", "m.h5", "r.h5", "-o",
                               "v.h5"),
    }
    table = {name: [] for name in steps}
    for model, band in ((rail, "0.01"), (heat, "100"), (beam, "0.1")):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            matrices = model(folder)
            for step, command in steps.items():
                words = [{"MATRICES": matrices, "BAND": band}.get(x, x)
                         for x in command]
                table[step].append(
                    "" if matrices is None else
                    seconds(folder, bin_ / words[0], *words[1:]))
                print(f"{model.__name__}: {step}: {table[step][-1]}",
                      file=sys.stderr, flush=True)
    print("| | rail, 1357 states | heat, 10 000 states | beam, 1412 states |")
    print("|---|---|---|---|")
    for step, cells in table.items():
        print(f"| {step} | {' | '.join(cells)} |")


if __name__ == "__main__":
    main()
