"""peer_scipy.py K M [MODES [COLUMNS]] - the job by SciPy: eigsh in
shift-invert mode with a factor of SuperLU in its symmetric mode. K and M are
files of PETSc. Prints one JSON object."""
import json
import sys
import time

import numpy
import scipy.sparse
import scipy.sparse.linalg


def read(path):
    with open(path, "rb") as file:
        _, rows, columns, entries = numpy.fromfile(file, ">i4", 4)
        length = numpy.fromfile(file, ">i4", rows)
        index = numpy.fromfile(file, ">i4", entries).astype("i4")
        value = numpy.fromfile(file, ">f8", entries).astype("f8")
    return scipy.sparse.csr_matrix(
        (value, index, numpy.r_[0, numpy.cumsum(length)]), (rows, columns)).T


def main():
    modes, columns = (int(word) for word in (sys.argv[3:] + ["50", "48"])[:2])
    times = [time.monotonic()]
    K, M = read(sys.argv[1]).tocsc(), read(sys.argv[2]).tocsc()
    times.append(time.monotonic())
    factor = scipy.sparse.linalg.splu(
        K, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0,
        options={"SymmetricMode": True})
    times.append(time.monotonic())
    inverse = scipy.sparse.linalg.LinearOperator(K.shape, factor.solve)
    values = scipy.sparse.linalg.eigsh(
        K, modes, M, sigma=0.0, OPinv=inverse, tol=1e-10,
        v0=numpy.ones(len(K.indptr) - 1))[0]
    times.append(time.monotonic())
    right = numpy.random.default_rng(1).random((K.shape[0], columns))
    factor.solve(right)
    times.append(time.monotonic())
    names = ["read", "factor", "modes", "columns"]
    print(json.dumps({"phases": dict(zip(names, numpy.diff(times).tolist())),
                      "values": sorted(values.tolist())}))


main()
