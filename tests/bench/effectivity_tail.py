#!/usr/bin/python3 -s
"""effectivity_tail.py FOLDER-OF-THE-TOOLS - the balanced tail over the true
error, of components and of state spaces of others: a table of
docs/methods/estimates.md, on standard output.

The truth is the largest singular value of H - H_r at some 2000 frequencies, at
and beside all poles, by NumPy alone. Status 1 if a tail is below it.
"""
import pathlib
import sys
import tempfile

import h5py
import numpy
import scipy.io
import scipy.linalg

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import effectivity  # noqa: E402
import methods  # noqa: E402

STATES = (4, 8, 16, 24, 40)
DOFS = 400  # of components; gramians are dense
SPACES = ["building", "CDplayer", "heat-cont", "rail_371"]
ROUNDING = 1e-10  # of max |H|: errors below it are not told from rounding
SHAPES = 1e-12  # of max |H|: what shapes of double precision leave of a modal
# sum, some hundred eps by the condition of a mode (2e-13 measured on LF10)


class Component:
    """A component with one ratio for all modes, or its own D = a M + b K."""

    def __init__(self, path, rigid):
        full = effectivity.Full(path, rigid)
        self.value = full.value.copy()
        self.value[:rigid] = 0
        own = numpy.sqrt(numpy.maximum(self.value, 0))
        self.rate = 2 * effectivity.ZETA * own
        if full.D is not None:
            self.rate = ((full.D @ full.X) * full.X).sum(0)
        self.B = full.X.T @ full.B
        self.C = [c @ full.X for c in full.C]
        low = own[rigid] if rigid < len(own) else 1
        self.omega = numpy.concatenate(
            [low * numpy.logspace(-2, 0, 100)] +
            [own[rigid:] * (1 + z) for z in numpy.linspace(-0.05, 0.05, 21)])

    def at(self, w):
        """H at one frequency."""
        z = self.value - w**2 + 1j * w * self.rate
        c = self.C[0] + 1j * w * self.C[1] - w**2 * self.C[2]
        return (c / z) @ self.B


class Space:
    """E x' = A x + B u, y = C x in the eigenvectors of A."""

    def __init__(self, folder):
        def read(name):
            A = scipy.io.mmread(folder / f"{name}.mtx")
            return A.toarray() if hasattr(A, "toarray") else A
        A, B, C = read("A"), read("B"), read("C")
        if (folder / "E.mtx").exists():  # E and A are symmetric
            E = read("E")
            self.pole, V = scipy.linalg.eigh((A + A.T) / 2, (E + E.T) / 2)
            self.B, self.C = V.T @ B, C @ V
        else:
            self.pole, V = numpy.linalg.eig(A)
            self.B, self.C = numpy.linalg.solve(V, B), C @ V
        size = abs(self.pole)
        self.omega = numpy.concatenate(
            [[0], numpy.logspace(numpy.log10(size.min()) - 1,
                                 numpy.log10(size.max()) + 1, 1000)] +
            [abs(self.pole.imag) * (1 + z)
             for z in numpy.linspace(-0.05, 0.05, 11)])

    def at(self, w):
        """H at one frequency."""
        return (self.C / (1j * w - self.pole)) @ self.B


def error_of(truth, path):
    """Largest |H - H_r|, and of |H|."""
    with h5py.File(path) as file:
        A, B, C, D = (file[k][()] for k in "ABCD")
    eye = numpy.eye(len(A))
    error = size = 0
    poles = abs(numpy.linalg.eigvals(A).imag)
    # poles of rigid modes are 0 but for rounding, and H is infinite there
    poles = poles[poles >= truth.omega.min()]
    for w in numpy.unique(numpy.concatenate([truth.omega, poles])):
        if w == 0 and isinstance(truth, Component):
            continue
        H = truth.at(w)
        off = H - D - C @ numpy.linalg.solve(1j * w * eye - A, B)
        error = max(error, numpy.linalg.norm(off, 2))
        size = max(size, numpy.linalg.norm(H, 2))
    return error, size


def lines(bin_, name, folder, model, truth, words):
    """Of one model; how many tails are below the error."""
    basis, reduced = folder / "basis.h5", folder / "reduced.h5"
    low = 0
    for states in STATES:
        try:
            methods.run(bin_, "ritz-basis", "balanced", "--modes", states,
                        *words, model, "-o", basis)
            methods.run(bin_, "ritz-reduce", model, basis, "-o", reduced)
        except methods.Refused as sentence:
            print(f"{name}, {states} states: {sentence}", file=sys.stderr)
            continue
        error, size = error_of(truth, reduced)
        bound, _ = effectivity.estimates_of(reduced)["h-infinity-bound"]
        if error < ROUNDING * size:
            continue
        print(f"| {name} | {states} | {bound:.2e} | {error:.2e} | "
              f"{bound / error:.2f} |", flush=True)
        low += not bound >= error * (1 - 1e-6) - SHAPES * size
    return low


def main():
    """Parse and run."""
    asked = methods.parser_of(__doc__).parse_args()
    low = 0
    print("| model | states | bound | error | ratio |\n|---|---|---|---|---|")
    for case in methods.cases(asked.bin, asked.only, most=DOFS):
        words = (["--damping", f"modal {effectivity.ZETA}"]
                 if case.get("damping", 1) else [])
        low += lines(asked.bin, case["name"], case["folder"], case["component"],
                     Component(case["component"], case["rigid"]), words)
    for name in SPACES:
        place = methods.EXTERNAL / "state_space" / name
        if asked.only not in (None, name) or not (place / "A.mtx").exists():
            continue
        with tempfile.TemporaryDirectory() as work:
            folder = pathlib.Path(work)
            parts = ",".join(f"{k}={place / f'{k}.mtx'}" for k in "ABCE"
                             if (place / f"{k}.mtx").exists())
            model = folder / "space.h5"
            methods.run(asked.bin, "ritz-import", "--state-space", parts, "-o",
                        model)
            low += lines(asked.bin, name, folder, model, Space(place), [])
    return 1 if low else 0


if __name__ == "__main__":
    sys.exit(main())
