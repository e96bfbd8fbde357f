#!/usr/bin/python3 -s
"""caged.py FOLDER-OF-THE-TOOLS - COMPARE by hankel where springs and dampers hold
joints: kept modes, damped poles and what is exported, at every configuration of
two scenes and for both augmentations; a table of docs/methods/compare.md, on
standard output.

Poles of the full system, of stage one and of what is exported are made here by
SciPy, of all modes and their D. Status 1 if a kept mode is off by more than is
allowed, a pole by 1e-5 more than stage one has it already, or the response of
the exported states by 1e-9 of the largest |H|.
"""
import argparse
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

SPACECRAFT = methods.DATA / "dualspin"
POLES = 1e-5  # that stage two may add to the error of stage one
EXPORTED = 1e-9


def bodies(bin_, folder):
    """The three of data/dualspin."""
    for name, ports in (("rotor", ["bearing=1"]), ("platform", ["scan=1"]),
                        ("stator", ["bearing=1", "scan=5"])):
        path = SPACECRAFT / name
        words = ["--mass", f"{path}.op4:MGG", "--bulk", f"{path}.bdf"]
        if name != "platform":
            words += ["--stiffness", f"{path}.op4:KGG"]
        for port in ports:
            words += ["--port", port]
        methods.run(bin_, "ritz-import", *words, "--units", "kg m s", "-o",
                    folder / f"{name}.h5")


def matrices(group):
    """K, M and D, dense; D of the dampers alone."""
    found = []
    for key in "KMD":
        A = group.get(key)
        if A is None:
            A = numpy.zeros_like(found[0])
        elif isinstance(A, h5py.Group):
            A = effectivity.sparse(A).toarray()
        found.append((A[()] + A[()].T) / 2)
    return found


class System:
    """Modes and poles of a system whose modes have a ratio, D beside it."""

    def __init__(self, group, ratio, rigid):
        K, M, D = matrices(group)
        value, X = scipy.linalg.eigh(K, M)
        value[:rigid] = 0
        self.omega = numpy.sqrt(value)
        n = len(value)
        rate = X.T @ D @ X + numpy.diag(2 * ratio * self.omega)
        self.s, V = numpy.linalg.eig(numpy.block([
            [numpy.zeros((n, n)), numpy.eye(n)],
            [-numpy.diag(value), -rate]]))
        self.share = abs(V[:n])**2 / (abs(V[:n])**2).sum(0)

    def poles_of(self, kept, band):
        """Those of the band in which kept modes, in rad/s, have most."""
        which = [abs(self.omega - w).argmin() for w in kept]
        size = abs(self.s) / 2 / numpy.pi
        mine = (self.share[which].sum(0) > 0.5) & (self.s.imag >= 0) & (
            size <= band) & (size > 1e-3 * band)
        return self.s[mine]


def gap(poles, others):
    """Largest relative distance to the nearest other; the pair of it."""
    worst = (0.0, 0j, 0j)
    for s in poles:
        z = others[abs(others - s).argmin()]
        worst = max(worst, (abs(z - s) / abs(s), s, z), key=lambda w: w[0])
    return worst


def exported(bin_, folder, system, at, band):
    """Poles of the exported states; how far their response is from frf's."""
    states, response = folder / "states.mat", folder / "response.h5"
    methods.run(bin_, "ritz-export", "--to", "matlab", "--states", "--at", at,
                system, "-o", states)
    methods.run(bin_, "ritz-frf", "--at", at, "--from-hz", f"{band / 200:g}",
                "--to-hz", f"{band:g}", "--points", 200, system, "-o", response)
    space = scipy.io.loadmat(states)
    with h5py.File(response) as file:
        hertz = file["hertz"][()]
        H = file["H/real"][()] + 1j * file["H/imag"][()]
    A, B, C, D = (space[key] for key in "ABCD")
    mine = numpy.array([C @ numpy.linalg.solve(
        2j * numpy.pi * f * numpy.eye(len(A)) - A, B) + D for f in hertz])
    return (numpy.linalg.eigvals(A),
            abs(H.reshape(mine.shape) - mine).max() / abs(H).max())


def zeta(s):
    """Of a pole, %."""
    return f"{100 * -s.real / abs(s):.4f}"


class Scene:
    """A scene, its stage one and its full systems."""

    def __init__(self, bin_, folder, name, scene, ratio, band):
        self.bin, self.folder, self.name = bin_, folder, name
        self.text = (SPACECRAFT / f"{scene}.yaml").read_text().replace(
            "build/", "")
        self.ratio, self.band = ratio, band
        self.stage1 = folder / f"{name}-stage1.h5"
        self.full = {}
        methods.run(bin_, "ritz-assemble", self.write("system"), "-o",
                    self.stage1)

    def write(self, level):
        """The scene with an augmentation."""
        path = self.folder / f"{self.name}-{level}.yaml"
        path.write_text(self.text.replace("augment: system",
                                          f"augment: {level}"))
        return path

    def full_at(self, at, rigid):
        """The full system there, made once."""
        if at not in self.full:
            path = self.folder / "full.h5"
            methods.run(self.bin, "ritz-assemble", self.write("system"),
                        "--full", "--at", at, "-o", path)
            with h5py.File(path) as file:
                self.full[at] = System(file, self.ratio, rigid)
        return self.full[at]

    def line(self, level, system, index, c, kept):
        """One line; what of it is not as it must be."""
        with h5py.File(self.stage1) as file:
            group = file[f"configurations/{index}"]
            lam = group["lambda"][()]
            first = System(group, self.ratio, int((lam <= 1e-6).sum()))
        flexible = numpy.sqrt(lam[lam > 1e-6])
        modes = flexible[numpy.array(kept) - 1]
        full = self.full_at(c["at"], len(lam) - len(flexible))
        poles = full.poles_of(modes[modes <= 2 * numpy.pi * self.band],
                              self.band)
        states, response = exported(self.bin, self.folder, system, c["at"],
                                    self.band)
        worst, s, z = gap(poles, states)
        before = gap(poles, first.s)[0]
        e = c["errors"]
        cells = [self.name, level, c["at"], str(len(kept)),
                 f"{e['frequency']:.1e}", f"{e['frequency_allowed']:.1e}",
                 f"{1 - e['mac']:.1e}", f"{e['gain']:.1e}",
                 f"{e['damping']:.1e}", str(len(poles)), f"{before:.1e}",
                 f"{worst:.1e}", f"{abs(s) / 2 / numpy.pi:.4g}", zeta(s),
                 zeta(z), f"{response:.1e}"]
        print("| " + " | ".join(cells) + " |", flush=True)
        wrong = {"a kept mode": e["frequency"] > e["frequency_allowed"],
                 "a pole": not worst <= before + POLES or not len(poles),
                 "the export": not response <= EXPORTED}
        return [what for what, is_so in wrong.items() if is_so]

    def table(self, level):
        """All configurations; how many things are wrong."""
        system = self.folder / f"{self.name}-{level}.h5"
        found = methods.run(self.bin, "ritz-compare", self.write(level), "-o",
                            system)
        listed = [c for c in found["configurations"] if c["listed"]]
        count = 0
        for index, c in enumerate(listed):
            for what in self.line(level, system, index, c,
                                  found["kept"][index]):
                print(f"{self.name}, {level}, {c['at']}: {what} is off",
                      file=sys.stderr)
                count += 1
        return count


TITLES = ["scene", "augment", "at", "kept", "frequency", "allowed", "1 - MAC",
          "gain", "damping", "poles", "stage one off", "reduced off", "at Hz",
          "full, %", "reduced, %", "SciPy"]


def main():
    """Parse and run."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("bin", type=lambda word: pathlib.Path(word).resolve())
    bin_ = parser.parse_args().bin
    print("| " + " | ".join(TITLES) + " |\n|" + "---|" * len(TITLES),
          flush=True)
    wrong = 0
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        bodies(bin_, folder)
        for scene in (Scene(bin_, folder, "oblique", "oblique", 0.02, 10),
                      Scene(bin_, folder, "cages", "caged", 0.002, 10)):
            for level in ("system", "component"):
                wrong += scene.table(level)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
