#!/usr/bin/python3 -s
"""effectivity_damping.py FOLDER-OF-THE-TOOLS - estimate over true error of
responses where ratios differ between modes and nothing is proven: dampers at a
few places, any positive D, structural damping, ratios by modes and by bands; a
table of docs/methods/estimates.md, on standard output.

The truth is one sparse solve for each frequency or, of ratios, the sum of all
modes. Status 1 if an estimate is below a tenth of the error.
"""
import pathlib
import sys

import h5py
import numpy
import scipy.io
import scipy.sparse
import scipy.sparse.linalg

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import effectivity  # noqa: E402
import methods  # noqa: E402

METHODS = ["irs", "craig-bampton", "krylov-cms-fixed", "macneal-rubin",
           "krylov-cms-free", "normal-modes"]
RATIO = 0.02  # of the third flexible mode, about
ROUNDING = 1e-10  # errors below this are that of the solves
LOW = 0.05  # of the band, of a free body: below, solves round too much
DOFS = 400  # of sparse solves with that many frequencies


class Damped:
    """A component, its damping and its response at some frequencies."""

    def __init__(self, full, rigid, band):
        self.full, self.rigid, self.band = full, rigid, band
        self.rng = numpy.random.default_rng(5)
        self.value = full.value.copy()
        self.value[:rigid] = 0
        self.low = LOW * band if rigid else 0
        f = [numpy.linspace(self.low, band, 400)]
        for pole in effectivity.hertz(self.value[rigid:]):
            if pole < 1.2 * band:
                f += [pole * (1 + z * numpy.linspace(-6, 6, 61))
                      for z in (1e-3, 1e-2, 1e-1)]
        f = numpy.unique(numpy.concatenate(f))
        self.w = 2 * numpy.pi * f[(f >= self.low) & (f > 0) & (f <= band)]

    def third(self, D):
        """x'D x of the third flexible mode, and its frequency in rad/s."""
        k = min(self.rigid + 2, len(self.value) - 1)
        x = self.full.X[:, k]
        return x @ (D @ x), numpy.sqrt(self.value[k])

    def dampers(self):
        """Three, each between two rows where the third mode moves."""
        n = len(self.full.K)
        k = min(self.rigid + 2, len(self.value) - 1)
        best = numpy.argsort(-abs(self.full.X[:, k]))[:max(4, n // 4)]
        D = numpy.zeros((n, n))
        for _ in range(3):
            i, j = self.rng.choice(best, 2, replace=False)
            v = numpy.zeros(n)
            v[i], v[j] = 1, -1
            D += numpy.outer(v, v)
        d, w = self.third(D)
        return 2 * RATIO * w / d * D

    def random(self):
        """Five vectors of any signs, each over a tenth of the rows."""
        n = len(self.full.K)
        V = self.rng.standard_normal((n, 5)) * (self.rng.random((n, 5)) < 0.1)
        V[self.rng.integers(0, n), 0] = 1
        D = V @ V.T + 1e-2 * numpy.diag(numpy.diag(self.full.M))
        d, w = self.third(D)
        return 2 * RATIO * w / d * D

    def structural(self):
        """Loss factors from 0.01 to 0.07 of mixed motions: up to 0.07 K."""
        n = len(self.value)
        Q = numpy.linalg.qr(self.rng.standard_normal((n, n)))[0]
        V = self.full.M @ (self.full.X * numpy.sqrt(
            numpy.maximum(self.value, 0))) @ Q
        return (V * self.rng.uniform(0.01, 0.07, n)) @ V.T

    def solved(self, D, K4):
        """The full response by sparse solves."""
        full = self.full
        sparse = scipy.sparse.csc_matrix
        still = unmoved(full.K, full.M, full.X[:, :self.rigid])
        K, M = sparse(still + 1j * K4), sparse(full.M)
        D, B = sparse(D), full.B.astype(complex)
        return numpy.array([
            (full.C[0] + 1j * w * full.C[1] - w**2 * full.C[2]) @
            scipy.sparse.linalg.splu(K + 1j * w * D - w**2 * M).solve(B)
            for w in self.w])

    def summed(self, value, B, C, ratio, rest):
        """A response by its modes, each of its own ratio."""
        w = self.w[:, None]
        own = numpy.sqrt(numpy.maximum(value, 0))
        Z = own**2 - w**2 + 2j * ratio(own) * w * own
        c = C[0][None] + 1j * w[:, :, None] * C[1][None] \
            - (w**2)[:, :, None] * C[2][None]
        return (c / Z[:, None]) @ B + rest


def unmoved(K, M, X):
    """K without what rounding has left of the stiffness of rigid modes X."""
    MX = M @ X
    return K - MX @ (X.T @ K @ X) @ MX.T


def reduced_response(damped, path, ratio):
    """The response of a reduced file."""
    with h5py.File(path) as file:
        K, M, B = (file[k][()] for k in ("K", "M", "inputs/B"))
        C = [file[f"outputs/{c}"][()] for c in ("C", "Cv", "Ca")]
        D = file["D"][()] if "D" in file else 0 * K
        K4 = file["K4"][()] if "K4" in file else 0 * K
    value, Q = effectivity.small_modes(K, M)
    if not ratio:
        still = unmoved(K, M, Q[:, :damped.rigid])
        return effectivity.direct(still + 1j * K4, M, D, B, C, damped.w)
    value[:damped.rigid] = 0
    return damped.summed(value, Q.T @ B, [c @ Q for c in C], ratio, 0)


def by_modes(ratios, rigid):
    """Of the first flexible mode, the second, ...; the last for all above."""
    return lambda own: numpy.array([
        0 if k < rigid else ratios[min(k - rigid, len(ratios) - 1)]
        for k in range(len(own))])


def kinds(damped, folder):
    """Name, options of the import, options of the reduction, response, ratio."""
    full = damped.full
    zero = 0 * full.K
    f = effectivity.hertz(full.value[damped.rigid:])
    edge = float(f"{numpy.sqrt(f[1] * f[2]):.6g}")
    ratios = [0.002, 0.05, 0.005, 0.03, 0.01]

    def write(A):
        A = (A + A.T) / 2
        path = folder / "damping.mtx"
        scipy.io.mmwrite(path, scipy.sparse.coo_matrix(A), precision=17,
                         symmetry="symmetric")
        return path

    def exact(ratio):
        return damped.summed(damped.value, full.X.T @ full.B,
                             [c @ full.X for c in full.C], ratio, rest(full))
    if full.D is None:
        for name, D in (("dampers", damped.dampers()),
                        ("any D", damped.random())):
            yield name, ["--damping", write(D)], [], damped.solved(D, zero), 0
        K4 = damped.structural()
        yield ("K4", ["--structural-damping", write(K4)], [],
               damped.solved(zero, K4), 0)
        own = by_modes(ratios, damped.rigid)
        yield ("modes", [], ["--damping", "modes " + " ".join(map(str, ratios))],
               exact(own), own)

        def banded(omega):
            return numpy.where(omega / 2 / numpy.pi <= edge, 0.005, 0.03)
        yield ("bands", [], ["--damping", f"bands 0 {edge} 0.005 {edge} 1e9 "
                             "0.03"], exact(banded), banded)


def rest(full):
    """What no mode with mass answers."""
    if len(full.value) == len(full.K):
        return 0
    A = numpy.linalg.solve(full.K + full.s * full.M, full.B)
    return full.C[0] @ A - ((full.C[0] @ full.X) / (full.value + full.s)) @ (
        full.X.T @ full.B)


def table(bin_, case):
    """Lines of one data set; how many estimates are dangerous."""
    name, folder, component, band, rigid = (
        case[key] for key in ("name", "folder", "component", "band", "rigid"))
    basis, reduced = folder / "basis.h5", folder / "reduced.h5"
    low = 0
    damped = Damped(effectivity.Full(component, rigid), rigid, band)
    for kind, given, asked, H, ratio in kinds(damped, folder):
        try:
            methods.run(bin_, "ritz-import", *case["options"], *given, "-o",
                        component)
        except methods.Refused as sentence:  # rows that an import leaves out
            print(f"{name}, {kind}: {sentence}", file=sys.stderr)
            continue
        for method, how, more in methods.some_methods(METHODS):
            try:
                methods.make_basis(bin_, method, how, more, component,
                                   case["order"], rigid, basis)
                methods.run(bin_, "ritz-reduce", component, basis, "-o",
                            reduced, "--band-hz",
                            f"{damped.low:.9g},{band:.9g}", *asked)
            except methods.Refused as sentence:
                print(f"{name}, {kind}, {method}: {sentence}", file=sys.stderr)
                continue
            low += line(name, kind, method, H, damped, reduced, ratio)
    return low


def line(name, kind, method, H, damped, reduced, ratio):
    """One line; 1 if the estimate is dangerous."""
    found = effectivity.estimates_of(reduced)
    told = [key for key in ("response-relative-estimate",
                            "response-relative-bound") if key in found]
    if not told:
        return 0
    value = found[told[0]][0]
    cause = effectivity.cause_of(reduced, told[0])
    error = abs(H - reduced_response(damped, reduced, ratio)).max() \
        / abs(H).max()
    over = value / max(error, ROUNDING)
    print(f"| {name} | {kind} | {method} | "
          + ("none" if numpy.isinf(value) else f"{value:.1e}")
          + f" | {error:.1e} | "
          + ("" if numpy.isinf(value) else f"{over:.2g}")
          + (" **below** |" if value < error else " |")
          + f" {cause if over > 10 else ''} |", flush=True)
    return value < 0.1 * error and error > ROUNDING


def main():
    """Parse and run."""
    asked = methods.parser_of(__doc__).parse_args()
    print("| set | damping | method | estimate | error | ratio | cause |\n"
          + "|" + "---|" * 7)
    low = sum(table(asked.bin, case)
              for case in methods.cases(asked.bin, asked.only, most=DOFS))
    return 1 if low else 0


if __name__ == "__main__":
    sys.exit(main())
