#!/usr/bin/python3 -s
"""effectivity.py FOLDER-OF-THE-TOOLS - bound over true error of every estimate
of ritz-reduce, for every method on every data set that it fits: the tables of
docs/methods/estimates.md, on standard output.

The truth is made here, by NumPy and SciPy alone: all eigenvalues of the full
matrices, each made exact to quadruple rounding by its Rayleigh quotient in long
double, and responses by the sum of all modes. Status 1 if any bound is below
the error it bounds.
"""
import pathlib
import re
import sys

import h5py
import numpy
import scipy.linalg
import scipy.sparse

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import methods  # noqa: E402  (the data sets are those of methods.py)

ZETA = 0.01
EPS = numpy.finfo(float).eps
LONG = numpy.longdouble


def sparse(group):
    """A matrix of a container."""
    return scipy.sparse.csc_matrix(
        (group["data"][()], group["indices"][()], group["indptr"][()]),
        shape=group.attrs["shape"])


def hertz(eigenvalue):
    """Frequency of an eigenvalue."""
    return numpy.sqrt(abs(eigenvalue)) / (2 * numpy.pi)


def precise(K, M, X):
    """Rayleigh quotients of columns, in long double; what they add up."""
    K, M, X = (A.astype(LONG) for A in (K, M, X))
    KX = K @ X
    quotient = (X * KX).sum(0) / (X * (M @ X)).sum(0)
    terms = (abs(X) * (abs(K) @ abs(X))).sum(0) / (X * (M @ X)).sum(0)
    return quotient.astype(float), terms.astype(float)


def exactly(A):
    """A matrix as it is."""
    return A


class Full:
    """All modes of a component, by dense eigenvalues; of K and M as `alter`
    changes them."""

    def __init__(self, path, rigid, alter=exactly):
        with h5py.File(path) as file:
            self.K = sparse(file["K"]).toarray()
            self.M = sparse(file["M"]).toarray()
            self.B = file["inputs/B"][()] if "inputs/B" in file else None
            self.C = ([file[f"outputs/{c}"][()] for c in ("C", "Cv", "Ca")]
                      if "outputs/C" in file else None)
            self.D = sparse(file["D"]).toarray() if "D" in file else None
        self.K, self.M = (alter((A + A.T) / 2) for A in (self.K, self.M))
        # 1 / (lambda + s): massless motions are at 0; s of the soft modes,
        # that rigid ones are told from them
        s = 1e-3 * numpy.trace(self.K) / max(numpy.trace(self.M), 1e-300)
        for _ in range(2):
            self.s = s
            kappa, X = scipy.linalg.eigh(self.M, self.K + s * self.M)
            keep = kappa > 1e-13 * kappa[-1]
            X, kappa = X[:, keep][:, ::-1], kappa[keep][::-1]
            soft = 1 / kappa - s
            s = soft[min(rigid, len(soft) - 1)]
        X = X / numpy.sqrt((X * (self.M @ X)).sum(0))
        for _ in range(2):  # X'MX = 1 to rounding of long double
            E = X.astype(LONG).T @ (self.M.astype(LONG) @ X.astype(LONG))
            X = X - X @ (E - numpy.eye(len(E))).astype(float) / 2
        value, _ = precise(self.K, self.M, X)
        order = numpy.argsort(value)
        self.value, self.X = value[order], X[:, order]


def respond(value, B, C, omega, rest=0):
    """max over pairs of a sum of modes of ratio ZETA, at each frequency."""
    w = omega[:, None]
    own = numpy.tile(numpy.maximum(value, 0), (len(omega), 1))
    Z = own - w**2 + 2j * ZETA * w * numpy.sqrt(own)
    c = C[0][None] + 1j * w[:, :, None] * C[1][None] \
        - (w**2)[:, :, None] * C[2][None]
    return (c / Z[:, None]) @ B + rest


def direct(K, M, D, B, C, omega):
    """A response by one solve for each frequency."""
    return numpy.array([(C[0] + 1j * w * C[1] - w**2 * C[2]) @ numpy.linalg.
                        solve(K + 1j * w * D - w**2 * M, B) for w in omega])


class Response:
    """The full model's response at some frequencies, and a reduced one's."""

    def __init__(self, full, rigid, band):
        self.full, self.rigid, self.band = full, rigid, band
        value = full.value.copy()
        value[:rigid] = 0
        self.value = value
        self.B = full.X.T @ full.B
        self.C = [c @ full.X for c in full.C]
        s = full.s
        A = numpy.linalg.solve(full.K + s * full.M, full.B)
        self.rest = full.C[0] @ A - (self.C[0] / (full.value + s)) @ self.B
        if len(value) == len(full.K):
            self.rest = 0 * self.rest

    def points(self, value):
        """At random and around all poles."""
        low = 1e-3 * self.band if self.rigid else 0
        f = [numpy.linspace(low, self.band, 300),
             numpy.random.default_rng(7).uniform(low, self.band, 1000)]
        zeta = [ZETA]
        if self.full.D is not None:
            zeta = 10.0 ** -numpy.arange(2, 8)
        for pole in hertz(numpy.concatenate([value, self.value])):
            for ratio in zeta:
                f.append(pole * (1 + ratio * numpy.linspace(-6, 6, 61)))
        f = numpy.unique(numpy.concatenate(f))
        return f[(f >= low) & (f <= self.band)] * 2 * numpy.pi

    def error(self, path, rigid):
        """Largest |H - H_r| / max |H|."""
        with h5py.File(path) as file:
            K, M, B = (file[k][()] for k in ("K", "M", "inputs/B"))
            C = [file[f"outputs/{c}"][()] for c in ("C", "Cv", "Ca")]
        value, Q = small_modes(K, M)
        value[:rigid] = 0
        w = self.points(value)
        if self.full.D is not None:
            with h5py.File(path) as file:
                D = file["D"][()]
            f = self.full
            H = direct(f.K, f.M, f.D, f.B, f.C, w)
            H_r = direct(K, M, D, B, C, w)
            return abs(H - H_r).max() / abs(H).max()
        H = respond(self.value, self.B, self.C, w, self.rest)
        H_r = respond(value, Q.T @ B, [c @ Q for c in C], w)
        return abs(H - H_r).max() / abs(H).max()

    def rounding(self, path, rigid):
        """Relative change of H_r by rounding: 4 eps of the sums in K and M."""
        with h5py.File(path) as file:
            K, M, B = (file[k][()] for k in ("K", "M", "inputs/B"))
            C = [file[f"outputs/{c}"][()] for c in ("C", "Cv", "Ca")]
            D = file["D"][()] if "D" in file else None
        value, off = reduced_values(self.full, path)
        _, Q = small_modes(K, M)
        w = self.points(value)[:, None]
        value[:rigid] = 0
        rate = ((D @ Q) * Q).sum(0) if D is not None \
            else 2 * ZETA * numpy.sqrt(numpy.maximum(value, 0))
        z = abs(value - w**2 + 1j * w * rate)
        p = abs(Q.T @ B).max(1)
        q = abs(C[0] @ Q).max(0) + w * abs(C[1] @ Q).max(0) \
            + w**2 * abs(C[2] @ Q).max(0)
        own = numpy.sqrt(off)
        moved = (p / z * own).sum(1) * (q / z * own).sum(1) \
            - (p / z * own)[:, :rigid].sum(1) \
            * (q / z * own)[:, :rigid].sum(1) \
            + 4 * EPS * w[:, 0]**2 * (p / z).sum(1) * (q / z).sum(1)
        zeta = numpy.array([c @ Q for c in C])
        H = (zeta[0] + 1j * w[:, :, None] * zeta[1]
             - (w**2)[:, :, None] * zeta[2]) / (
                 value - w**2 + 1j * w * rate)[:, None]
        return moved.max() / abs(H @ (Q.T @ B)).max()


def small_modes(K, M):
    """Pairs of a small pencil; coordinates without mass are condensed out."""
    free = numpy.diag(M) == 0
    held = ~free
    S = numpy.zeros((len(K), held.sum()))
    S[held] = numpy.eye(held.sum())
    if free.any():
        S[free] = -numpy.linalg.solve(K[numpy.ix_(free, free)],
                                      K[numpy.ix_(free, held)])
    scale = 1 / numpy.sqrt((S * (M @ S)).sum(0))
    S = S * scale
    Q = S @ scipy.linalg.eigh(S.T @ K @ S, S.T @ M @ S)[1]
    value, _ = precise(K, M, Q)
    order = numpy.argsort(value)
    return value[order], Q[:, order] / numpy.sqrt((Q * (M @ Q)).sum(0))[order]


def estimates_of(path):
    """Estimates of a reduced model by their names: value and place."""
    with h5py.File(path) as file:
        told = file["estimates"]
        return {name.decode(): (value, where.decode()) for name, value, where
                in zip(told["name"], told["value"], told["where"])}


def cause_of(path, name):
    """The cause of a bound far above its estimate; "" if it has none."""
    with h5py.File(path) as file:
        told = file["estimates"]
        causes = told["cause"] if "cause" in told else []
        return {key.decode(): cause.decode() for key, cause
                in zip(told["name"], causes)}.get(name, "")


def reduced_values(full, path):
    """Eigenvalues of a reduced model, and their rounding. It is absolute,
    because the eigenvalue of a rigid mode may be 0."""
    with h5py.File(path) as file:
        K, M, T = (file[k][()] for k in ("K", "M", "T"))
    value, Q = small_modes(K, M)
    _, terms = precise(full.K, full.M, T @ Q)
    Q = abs(Q)
    terms += (Q * (abs(K) @ Q)).sum(0) + abs(value) * (Q * (abs(M) @ Q)).sum(0)
    return value, 4 * EPS * (terms + abs(value[-1]))


def judge(full, value, off, estimates):
    """Of each mode: bound, true error, rounding."""
    found = []
    for name, (bound, where) in estimates.items():
        match = re.fullmatch(r"mode-(\d+)", name)
        if not match:
            continue
        k = int(match[1]) - 1
        which = re.search(r"full mode (\d+)", where)
        f = hertz(value[k])
        if "near some" in where:
            true = min(abs(f / hertz(full.value) - 1))
        else:
            true = abs(f / hertz(full.value[int(which[1]) - 1
                                            if which else k]) - 1)
        found.append((bound, true, off[k] / abs(value[k]) / 2, where))
    return found


def lowest(least, value, full):
    """frequency-relative-least, and the true error of its mode by number."""
    which = re.match(r"mode (\d+)", least[1])
    if not which or least[0] <= 0:
        return None
    k = int(which[1]) - 1
    other = re.search(r"full mode (\d+)", least[1])
    p = int(other[1]) - 1 if other else k
    return least[0], abs(hertz(value[k]) / hertz(full.value[p]) - 1)


def contradictions(bin_, case, reduced, band, estimates):
    """What ritz-verify measures in the band and estimates deny."""
    answer = methods.run(bin_, "ritz-verify", case["component"], reduced, "-o",
                         case["folder"] / "verified.h5", "--band-hz", band)
    found = {m["name"]: m["value"] for m in answer["measures"]}
    error = found.get("frequency-relative", 0)
    least = estimates.get("frequency-relative-least", (0, ""))
    rounding = 1e-9  # of frequencies by another eigensolver
    for name, said, true in [
            ("frequency-relative", estimates.get("frequency-relative-bound",
                                                 (0, ""))[0], error),
            ("frequency-relative-least", error, least[0]),
            ("missing-modes", estimates.get("missing-modes-bound",
                                            (float("inf"), ""))[0],
             found.get("missing-modes", 0))]:
        if not said >= true - rounding:
            yield name, said, true


def line(bin_, case, full, truth, method, how, more):
    """One line of a table; how many bounds were too low."""
    folder, component = case["folder"], case["component"]
    basis, reduced = folder / "basis.h5", folder / "reduced.h5"
    order = methods.make_basis(bin_, method, how, more, component,
                               case["order"], case["rigid"], basis)
    words = ["ritz-reduce", component, basis, "-o", reduced, "--band-hz",
             f"0,{case['band']:.9g}"]
    if case.get("damping", 1):
        words += ["--damping", "modal 0.01"]
    answer = methods.run(bin_, *words)
    rigid = sum(f == 0 for f in answer["frequencies_hz"])
    value, off = reduced_values(full, reduced)
    estimates = estimates_of(reduced)
    modes = judge(full, value, off, estimates)
    low = [m for m in modes if not m[0] >= m[1]]
    told = [(b / max(t, r), b, t, w) for b, t, r, w in modes]
    worst = max(told, default=(0, 0, 0, ""))
    missing = estimates.get("missing-modes-bound", (float("nan"), ""))[0]
    least = estimates.get("frequency-relative-least", (0, ""))
    least = lowest(least, value, full)
    if least and not least[0] <= least[1]:
        low.append(("least", *least))
    low += contradictions(bin_, case, reduced, f"0,{case['band']:.9g}",
                          estimates)
    mean = numpy.exp(numpy.mean([numpy.log(x[0]) for x in told])) if told \
        else float("nan")
    response = ["", "", "", ""]
    for kind in ("bound", "estimate"):
        if f"response-relative-{kind}" not in estimates:
            continue
        bound, _ = estimates[f"response-relative-{kind}"]
        error = truth.error(reduced, rigid)
        ratio = bound / max(error, truth.rounding(reduced, rigid))
        response = ["none" if bound == float("inf") else
                    f"{bound:.1e}" + ("*" if kind == "estimate" else ""),
                    f"{error:.1e}",
                    "" if bound == float("inf") else f"{ratio:.2g}",
                    cause_of(reduced, f"response-relative-{kind}")
                    if ratio > 10 else ""]
        if kind == "bound" and not bound >= error:
            low.append(("response", bound, error))
    name = re.match(r"mode (\d+)", worst[3])
    told = ([f"{worst[1]:.1e}", f"{worst[2]:.1e}", f"{worst[0]:.2f}",
             f"{mean:.2f}", name[1]] if told else 5 * [""])
    told.append(f"{least[1] / least[0]:.2f}" if least else "")
    print(f"| {method} | {order} | {len(modes)} | {missing:.0f} | "
          + " | ".join(told + response) + " |", flush=True)
    for m in low:
        print("too low:", *m, file=sys.stderr)
    return len(low)


TITLES = ["method", "columns", "modes", "missing", "bound", "error", "ratio",
          "mean", "of mode", "over least", "response", "error", "ratio",
          "cause"]


def main():
    """Parse and run."""
    parser = methods.parser_of(__doc__)
    parser.add_argument("--methods", type=lambda word: word.split(","),
                        help="some methods, with commas between")
    asked = parser.parse_args()
    low = 0
    for case in methods.cases(asked.bin, asked.only, absent=methods.left_out):
        print(f"\n## {case['name']}\n\n| " + " | ".join(TITLES) + " |\n|"
              + "---|" * len(TITLES), flush=True)
        full = Full(case["component"], case["rigid"])
        truth = Response(full, case["rigid"], case["band"])
        for method, how, more in methods.some_methods(asked.methods):
            try:
                low += line(asked.bin, case, full, truth, method, how, more)
            except methods.Refused as sentence:
                methods.refused(method, sentence, len(TITLES) - 2)
    return 1 if low else 0


if __name__ == "__main__":
    sys.exit(main())
