"""How accurate results are: residuals with a factor that the harness makes, and
differences between the eigenvalues of two programs."""
import json

import h5py
import numpy
import scipy.sparse.linalg

import models

# Rows above which SuperLU takes minutes, so that peer_slepc computes residuals.
LARGEST_FOR_SUPERLU = 45000
REFERENCES = "slepc-1x2", "scipy", "basis"
MODES = 50  # that all jobs but those of 500 compute


class Unknown(Exception):
    """Why something cannot be measured."""


def values_of_basis(path):
    """Eigenvalues (rad/s)^2 of the normal modes, ascending."""
    with h5py.File(path) as f:
        kind = f["columns/kind"][:]
        hertz = f["columns/hertz"][:]
    return numpy.sort((2 * numpy.pi * hertz[kind == b"normal"])**2)


def pairs_of_basis(path, interior):
    """Eigenvalues, and vectors as columns, with the interface held."""
    with h5py.File(path) as f:
        normal = numpy.flatnonzero(f["columns/kind"][:] == b"normal")
        hertz = f["columns/hertz"][:][normal]
        vectors = f["T"][:, normal.min():normal.max() + 1]
    return ((2 * numpy.pi * hertz)**2,
            vectors[:, normal - normal.min()][interior])


def read_pairs(path):
    """Eigenvalues and vectors from a file of peer_slepc."""
    with open(path, "rb") as file:
        rows, count = numpy.fromfile(file, numpy.int64, 2)
        values = numpy.fromfile(file, float, count)
        return values, numpy.fromfile(file).reshape(count, rows).T


def write_pairs(path, values, vectors):
    with open(path, "wb") as file:
        numpy.array(vectors.shape, numpy.int64).tofile(file)
        values.tofile(file)
        numpy.ascontiguousarray(vectors.T).tofile(file)


def difference(values, others, most=MODES):
    """Largest relative difference of two lists of eigenvalues, of their lowest
    `most`. It is infinite if one list ends before them and before the other
    one: a mode is missing."""
    count = min(max(len(values), len(others)), most)
    if min(len(values), len(others)) == 0:
        raise Unknown("no eigenvalues to compare")
    if min(len(values), len(others)) < count:
        return float("inf")
    a, b = numpy.sort(values)[:count], numpy.sort(others)[:count]
    return float(numpy.max(numpy.abs(a / b - 1)))


CLUSTER = 1e-3  # modes as near as this to each other belong together
ALLOWANCE = 10  # times residual over gap


def subspaces(M, pairs, others, residuals):
    """Largest angle between the same cluster of modes of two programs, as part
    of what is allowed: ten times the residuals of both over the relative
    distance to the next mode of 1 / lambda. The last cluster is left out, as the
    mode behind it is not known."""
    (values, X), (_, Y) = pairs, others
    cuts = [0, *(numpy.flatnonzero(numpy.diff(values) > CLUSTER * values[:-1])
                 + 1)]
    MX = M @ X
    worst = 0.0
    for first, last in zip(cuts, cuts[1:]):
        rest = Y[:, first:last] - X[:, first:last] @ (
            MX[:, first:last].T @ Y[:, first:last])
        angle = numpy.linalg.norm(numpy.sqrt(numpy.maximum(
            (rest * (M @ rest)).sum(axis=0), 0.0)))
        theta = 1 / values[max(first - 1, 0):last + 1]
        gap = numpy.abs(numpy.diff(theta))
        gap = min(gap[-1], gap[0] if first else gap[-1]) * values[first]
        worst = max(worst, angle * gap / (ALLOWANCE * sum(residuals)))
    return float(worst)


class Residual:
    """Largest |lambda K^-1 M x - x| / |x|, x being of the interior. Each solve
    is refined once, with a residual in long doubles: on thin plates the
    rounding of the factor would otherwise hide the residual of the modes."""

    def __init__(self, K, M):
        self.K, self.M = (A.tocsr().astype(numpy.longdouble) for A in (K, M))
        self.factor = scipy.sparse.linalg.splu(
            K, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0,
            options={"SymmetricMode": True})

    def solve(self, right):
        return self.factor.solve(right.astype(float))

    def __call__(self, values, vectors):
        right = self.M @ vectors
        found = self.solve(right).astype(numpy.longdouble)
        found += self.solve(right - self.K @ found)
        error = (values * found - vectors).astype(float)
        size = numpy.linalg.norm
        return float((size(error, axis=0) / size(vectors, axis=0)).max())


class PeersResidual:
    """The same by peer_slepc with MUMPS, from files of matrices and pairs."""

    def __init__(self, solve, path):
        self.solve, self.path = solve, path

    def __call__(self, values, vectors):
        write_pairs(self.path, values, vectors)
        return self.solve("-check", self.path)["residual"]


def find_residual(solve, stem, interior, pairs):
    """The one of the two that suits the size; None for large models of which
    MUMPS has made no factor in this run, so that it may not fit in memory."""
    if len(interior) <= LARGEST_FOR_SUPERLU:
        K, M = (A[interior][:, interior] for A in models.load(stem)[:2])
        return Residual(K, M)
    return PeersResidual(solve, pairs) if pairs.exists() else None


def measure(shop, model, runs):
    """Add residuals and differences of eigenvalues to the runs of a model."""
    stem, out = shop.stem(model), shop.out(model)
    pairs = out / "slepc.pairs"

    def solve(*words):
        matrices = ["-stiffness", stem.with_suffix(".K.petsc"),
                    "-mass", stem.with_suffix(".M.petsc")]
        order = ["-st_mat_mumps_icntl_7", 5, "-mat_mumps_icntl_7", 5]
        return json.loads(shop.peer(
            [*shop.program("peer-slepc"), *matrices, *order, *words],
            OMP_NUM_THREADS="2")["out"])

    ran = [job for job in shop.jobs if "wall" in runs.get(job, {})]
    values, vectors = {}, {}
    port = models.load_port(stem)
    interior = numpy.setdiff1d(range(shop.facts[model]["dofs"]), port)
    for job in ran:
        path = out / f"{job}.h5"
        if runs[job]["said"].get("values"):
            values[job] = runs[job]["said"].pop("values")
        elif job == "slepc-1x2":
            said = solve("-vectors", pairs)
            shop.facts[model] |= {key: said[key] for key in
                                  ("factor_entries", "factor_flops")}
            values[job], vectors[job] = read_pairs(pairs)
        elif shop.jobs[job].get("pairs"):
            values[job], vectors[job] = pairs_of_basis(path, interior)
        elif job.startswith("basis-500"):
            values[job] = values_of_basis(path)
    if vectors:
        residual = find_residual(solve, stem, interior, pairs)
        for job, found in vectors.items():
            if residual:
                runs[job]["residual"] = residual(values[job], found)
    compare(shop.jobs, runs, values)
    M = models.load(stem)[1][interior][:, interior] if vectors else None
    for job, found in vectors.items():
        other = shop.jobs[job].get("beside")
        if other in vectors and residual:
            runs[job][f"subspaces beside {other}"] = subspaces(
                M, (values[job], found), (values[other], vectors[other]),
                [runs[name]["residual"] for name in (job, other)])


def requested(job):
    """How many modes the command of a job asks for."""
    words = job["command"].split()
    return int(words[words.index("--modes") + 1])


def compare(jobs, runs, values):
    reference = next((job for job in REFERENCES if job in values), None)
    for job, found in values.items():
        if job != reference and jobs[job].get("pairs") and reference:
            runs[job]["agreement"] = difference(found, values[reference])
        other = jobs[job].get("beside")
        if other in values:
            runs[job][f"error beside {other}"] = difference(
                found, values[other], requested(jobs[job]))
