#!/usr/bin/python3 -s
"""run.py PROGRAMS - MBDyn runs what ritz-export writes for it. The environment
variable MBDYN names the program; without it nothing is run. Files are kept in
the folder that KEEP names, which must be empty.

free.mbdyn and clamped.mbdyn run the rotor of data/dualspin: frequencies, a
body that falls, and motion by a force against ritz-simulate, steps halved.
spin.mbdyn bends a block by spinning it; docs/simulators.md has an example."""
import os
import pathlib
import shlex
import subprocess
import sys
import tempfile

import h5py
import numpy
import scipy.linalg

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import recovery  # noqa: E402
from common import DATA, Block, Tap, Tools  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
SECONDS = 2.0
# N: displacements of 1e-5 m, whose squares linear equations leave out
PUSH = 1e-2


def record_groups(path):
    """Words of each group of a .fem, without comments."""
    groups, words = {}, []
    for line in open(path):
        if line.startswith("** RECORD GROUP "):
            words = groups.setdefault(int(line[16:].split(",")[0]), [])
        elif not line.startswith("**"):
            words += line.split()
    return groups


class Mbdyn:
    """The program, run in the folder of the tools."""

    def __init__(self, program, tools):
        self.program, self.tools = program, tools

    def __call__(self, name, fem, grid=29, **settings):
        """Run NAME.mbdyn of this folder with FEM as body.fem, X, Y and Z being
        the position of a grid."""
        self.groups = groups = record_groups(self.tools.path(fem))
        node = groups[2].index(str(grid))
        text = "".join(f"set: real {key} = {value!r};\n"
                       for key, value in settings.items())
        text += "".join(f"set: real {axis} = {groups[5 + k][node]};\n"
                        for k, axis in enumerate("XYZ"))
        text += f"set: integer MODES = {sum(map(int, groups[1][2:5]))};\n"
        folder = self.tools.folder
        (folder / "settings").write_text(text)
        (folder / "body.fem").write_bytes((folder / fem).read_bytes())
        (folder / f"{name}.mbdyn").write_bytes(
            (HERE / f"{name}.mbdyn").read_bytes())
        return self.run(name)

    def run(self, name):
        """Files NAME.* of a run of NAME.mbdyn as it stands in the folder, and
        what was printed."""
        # MBDyn reads variables of the environment that begin with MBDYN
        done = subprocess.run(
            [self.program, "-P", "-f", f"{name}.mbdyn", "-o", name],
            cwd=self.tools.folder, env={"PATH": os.defpath}, text=True,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if done.returncode != 0:
            sys.exit(done.stdout)
        return done.stdout

    def matrix(self, group):
        """A square matrix of the last run's .fem."""
        A = numpy.array(self.groups[group], dtype=float)
        return A.reshape(2 * (round(len(A) ** 0.5),))

    def mass_found(self, said):
        """The modal mass that MBDyn finds in the masses of nodes."""
        rows = said.split("Generalized mass: input - computed\n")[1]
        rows = rows.splitlines()[:len(self.matrix(9))]
        return self.matrix(9) - numpy.array([row.split() for row in rows],
                                            dtype=float)

    def mass(self):
        """Mass of the body of the last run, by group 11."""
        return numpy.array(self.groups[11], dtype=float)[::6].sum()

    def frequencies(self, name):
        """Hz of the oscillations among the eigenvalues, ascending."""
        text = open(self.tools.path(name + "_0.m")).read()
        step = float(text.split("dCoef = ")[1].split(";")[0])
        rows = text.split("alpha = [")[1].split("]")[0].replace(";", "\n")
        re, im, beta = numpy.array(
            [row.split() for row in rows.splitlines() if row.split()],
            dtype=float).T
        with numpy.errstate(all="ignore"):
            ratio = (re + 1j * im) / beta
            s = (ratio - 1.0) / (ratio + 1.0) / step
        hertz = s.imag / (2.0 * numpy.pi)
        return numpy.sort(hertz[numpy.isfinite(hertz) & (hertz > 1e-3)])

    def motion(self, name, node):
        """Position, orientation, velocity and so on of a node over time."""
        rows = [line.split() for line in open(self.tools.path(name + ".mov"))]
        return numpy.array([row[1:] for row in rows if int(row[0]) == node],
                           dtype=float)

    def positions(self, name, node):
        return self.motion(name, node)[:, :3]

    def modes(self, name, derivative=0):
        """Amplitudes q over time, or their rates: a row for each time."""
        rows = [line.split() for line in open(self.tools.path(name + ".mod"))]
        count = max(int(row[0].split(".")[1]) for row in rows)
        return numpy.array([row[1 + derivative] for row in rows],
                           dtype=float).reshape(-1, count)


def make_body(tools, name, held, *options):
    """NAME.h5, the rotor of data/dualspin by twelve modes, with lines of its
    deck that hold it."""
    rotor = DATA / "dualspin" / "rotor"
    (tools.folder / f"{name}.bdf").write_text(
        "SPC = 1\nBEGIN BULK\n" + held + rotor.with_suffix(".bdf").read_text())
    tools("ritz-import", "--stiffness", f"{rotor}.op4:KGG", "--mass",
          f"{rotor}.op4:MGG", "--bulk", f"{name}.bdf", *options, "-o",
          f"{name}-full.h5")
    tools("ritz-basis", "craig-bampton", "--modes", 12, f"{name}-full.h5",
          "-o", "basis.h5")
    tools("ritz-reduce", f"{name}-full.h5", "basis.h5", "-o", f"{name}.h5")


def flexible(tools, path):
    """Frequencies of a reduced component, by its own matrices."""
    with h5py.File(tools.path(path)) as f:
        w2 = scipy.linalg.eigh(f["K"][:], f["M"][:], eigvals_only=True)
    return numpy.sqrt(w2[w2 > 1e-6]) / (2.0 * numpy.pi)


def export(tools, body, fem, *options):
    tools("ritz-export", "--force", "--to", "mbdyn", *options, body, "-o", fem)


def linear_motion(tools, body, step):
    """Displacement of grid 29 at times of a step."""
    fine = step / 16.0
    tools("ritz-simulate", body, "--seconds", SECONDS, "--step", fine,
          "--every", 16, "--input", f"push=sine:0.3*{PUSH}", "-o", "motion.h5")
    with h5py.File(tools.path("motion.h5")) as f:
        y = f["y"][:]
    return y.reshape(-1)


def check_motion(tap, tools, mbdyn, name, fem, along, steps):
    """Halved steps approach ritz-simulate at the order of the method."""
    body = {"free": "free.h5", "clamped": "held.h5"}[name]
    exact = linear_motion(tools, body, steps[-1])
    errors = []
    for step in steps:
        mbdyn(name, fem, H=step, T=SECONDS, TOLERANCE=2e-12, PUSH=PUSH,
              GRAVITY=0.0)
        at = mbdyn.positions(name, 29)
        found = (at - at[0]) @ along
        every = round(step / steps[-1])
        count = min(len(found), len(exact[::every]))
        errors.append(numpy.abs(found[:count] - exact[::every][:count]).max()
                      / numpy.abs(exact).max())
    figures = " ".join(f"{e:.2e}" for e in errors)
    tap.check(errors[-1] <= 1e-4, f"{name}: the motion of grid 29 is that of "
              "ritz-simulate", figures)
    orders = [numpy.log2(a / b) for a, b in zip(errors, errors[1:])]
    tap.check(all(1.8 < order < 2.2 for order in orders),
              f"{name}: halved steps converge at second order",
              " ".join(f"{order:.2f}" for order in orders))


def check_free(tap, tools, mbdyn):
    for reference in "none", "mean-axis", "tangent":
        export(tools, "free.h5", f"{reference}.fem", "--frame", 1,
               "--reference", reference)
        said = mbdyn("free", f"{reference}.fem", H=0.01, T=0.01,
                     TOLERANCE=1e-9, PUSH=0.0, GRAVITY=0.0)
        tap.near(mbdyn.mass_found(said), mbdyn.matrix(9), 1e-6,
                 f"free, reference {reference}: MBDyn finds the modal mass in "
                 "the masses of nodes, as far as beams are in M")
        tap.near(mbdyn.frequencies("free"), flexible(tools, "free.h5"), 1e-6,
                 f"free, reference {reference}: frequencies, those of a body "
                 "that is turned")
        mbdyn("free", f"{reference}.fem", H=0.01, T=1.0, TOLERANCE=1e-10,
              PUSH=0.0, GRAVITY=9.81)
        fall = mbdyn.positions("free", 1)
        w = 2.0 * numpy.pi * 0.3  # z'' = -g sin(w t)
        depth = 9.81 / w ** 2 * (w - numpy.sin(w))
        tap.near(fall[-1] - fall[0], [0.0, 0.0, -depth], 1e-3,
                 f"free, reference {reference}: it falls")
        # modes have unit mass: sqrt(m) g is what gravity can be to one of them
        elastic = mbdyn.modes("free") @ mbdyn.matrix(10)
        part = numpy.abs(elastic).max() / (mbdyn.mass() ** 0.5 * 9.81)
        tap.check(part <= 1e-12,
                  f"free, reference {reference}: and feels no elastic force",
                  f"{part:.1e}")
    x, y, z = 0.5, 0.3, -0.4
    first = numpy.array([numpy.cos(y) * numpy.cos(z),
                         numpy.cos(x) * numpy.sin(z)
                         + numpy.sin(x) * numpy.sin(y) * numpy.cos(z),
                         numpy.sin(x) * numpy.sin(z)
                         - numpy.cos(x) * numpy.sin(y) * numpy.cos(z)])
    check_motion(tap, tools, mbdyn, "free", "none.fem", first,
                 (0.008, 0.004, 0.002))


def check_clamped(tap, tools, mbdyn):
    export(tools, "held.h5", "held.fem")
    export(tools, "free.h5", "tangent.fem", "--frame", 1, "--reference",
           "tangent")
    for fem, title in (("held.fem", "held by the deck"),
                       ("tangent.fem", "free, tangent at grid 1")):
        mbdyn("clamped", fem, H=0.01, T=0.01, TOLERANCE=1e-9, PUSH=0.0)
        found = mbdyn.frequencies("clamped")
        own = flexible(tools, "held.h5")
        tap.near(found / own, numpy.ones(len(own)), 1e-6,
                 f"clamped, {title}: {len(own)} frequencies")
    check_motion(tap, tools, mbdyn, "clamped", "held.fem",
                 numpy.array([1.0, 0.0, 0.0]), (0.004, 0.002, 0.001))


def momenta(mbdyn, block):
    """Linear and angular momentum of a block's nodes at the end of a run, by
    its own M, and its largest displacement."""
    state = mbdyn.motion("spin", 1)[-1]
    place, A = state[:3], state[3:12].reshape(3, 3)
    velocity, omega = state[12:15], A.T @ state[15:18]
    Psi = numpy.array(mbdyn.groups[8], dtype=float)
    Psi = Psi.reshape(len(mbdyn.matrix(9)), -1, 6)[:, :len(block.id), :3]
    q, rate = mbdyn.modes("spin")[-1], mbdyn.modes("spin", 1)[-1]
    X = block.position + numpy.tensordot(q, Psi, 1)
    v = velocity + (numpy.cross(omega, X)
                    + numpy.tensordot(rate, Psi, 1)) @ A.T
    p = (block.M @ v.ravel()).reshape(-1, 3)
    H = numpy.cross(place + X @ A.T, p).sum(axis=0)
    return (numpy.concatenate([p.sum(axis=0), H]),
            numpy.abs(X - block.position).max())


def check_spin(tap, tools, mbdyn):
    """A consistent mass matrix is kept: momenta of a block that spins, by its
    own M at its nodes, are those that a couple gave it."""
    block = Block((5, 2, 2))
    block.write(tools)
    tools("ritz-basis", "macneal-rubin", "--modes", 8, "block.h5", "-o",
          "basis.h5")
    tools("ritz-reduce", "block.h5", "basis.h5", "-o", "small.h5")
    export(tools, "small.h5", "block.fem", "--reference", "mean-axis")
    couple, found = 500.0, []
    for step in 0.004, 0.002, 0.001:
        said = mbdyn("spin", "block.fem", grid=1, H=step, T=1.5,
                     TOLERANCE=1e-7, COUPLE=couple)
        both, bent = momenta(mbdyn, block)
        found.append(both / couple)
    tap.near(mbdyn.mass_found(said), mbdyn.matrix(9), 1e-12,
             "spin: MBDyn finds the modal mass in the masses of nodes")
    exact = numpy.array([0.0, 0.0, 0.0, 0.0, 0.6, 0.8])
    errors = [numpy.abs(f - exact).max() for f in found]
    figures = " ".join(f"{e:.2e}" for e in errors)
    tap.check(3.5 < errors[1] / errors[2] < 4.5 and errors[2] < 1e-3,
              "spin: momenta of the nodes converge to those of the couple at "
              "second order", figures)
    tap.near((4.0 * found[2] - found[1]) / 3.0, exact, 1e-6,
             "spin: and are these where the order is taken out")
    tap.check(bent > 1e-3, "spin: the block is bent, by metres",
              f"{bent:.1e}")


def check_recovery(tap, tools, mbdyn):
    """ritz-recover reads the .mod of the rotor that its hub holds: stresses and
    displacements converge to those of the reduced model, and are those of the
    full one within the error that ritz-verify states."""
    rotor = recovery.Rotor(tools, "held", True, PUSH)
    rotor.signal = f"sine:0.3*{PUSH}"
    tools("ritz-export", "--force", "--to", "mbdyn", *recovery.DAMPED,
          "held.h5", "-o", "rotor.fem")
    own, full = rotor.reduced(), rotor.full()
    errors = []
    for step in 0.004, 0.002:
        mbdyn("clamped", "rotor.fem", H=step, T=SECONDS, TOLERANCE=2e-12,
              PUSH=PUSH)
        every = round(recovery.EVERY / step)
        tools("ritz-recover", "clamped.mod", "--step", step, "--component",
              "held.h5", "--transform", "floating", "--modes", "displacement",
              "--every", every, "--table", "maxima.tsv", "-o", "motion.pvd")
        times, *found = rotor.read_pvd("motion.pvd")
        count = len(times)
        errors.append([recovery.error(f, o[:count])
                       for f, o in zip(found, own)])
    tap.near(times, recovery.EVERY * numpy.arange(count), 1e-12,
             "recovery: times")
    limits = rotor.stated()
    for k, what in enumerate(["displacements", "stresses"]):
        tap.check(errors[0][k] <= 1e-2 and errors[1][k] <= 0.3 * errors[0][k],
                  f"recovery: {what} converge to those of ritz-simulate",
                  f"{errors[0][k]:.1e}, {errors[1][k]:.1e} with half the step")
        apart = recovery.error(found[k], full[k][:count])
        stated = limits[k] / numpy.abs(full[k]).max()
        tap.check(apart <= stated + errors[1][k],
                  f"recovery: {what} are those of the full model within the "
                  "stated error", f"{apart:.1e}, stated {stated:.1e}")


def page_block(after):
    """Indented lines of the page behind the line that begins so."""
    lines = (DATA.parent / "docs" / "simulators.md").read_text().splitlines()
    first = next(k for k, line in enumerate(lines) if line.startswith(after))
    block = []
    for line in lines[first + 2:]:
        if line and not line.startswith("    "):
            break
        block.append(line[4:])
    return "\n".join(block)


def check_page(tap, tools, mbdyn):
    """The example of docs/simulators.md turns as ritz-simulate says of the
    rotor in its bearing."""
    (tools.folder / "data").symlink_to(DATA)
    for line in page_block("The rotor of `data/dualspin`").splitlines():
        if line:
            tools(*shlex.split(line))
    (tools.folder / "rotor.mbdyn").write_text(page_block("`rotor.mbdyn`"))
    mbdyn.run("rotor")
    turn = numpy.radians(mbdyn.motion("rotor", 1)[:, 5])
    t = numpy.arange(4001) * 0.001
    couple = numpy.where(t < 2.0, 50.0 * (1.0 - numpy.cos(numpy.pi * t)), 0.0)
    numpy.savetxt(tools.path("couple.txt"), numpy.c_[t, couple], "%.17g")
    make_body(tools, "hinged", "SPC1,1,12345,1\n", "--port", "bearing=1:6",
              "--input", "couple=1:6", "--output-at", "turn=1:6")
    tools("ritz-simulate", "hinged.h5", "--seconds", 4, "--step", 0.001,
          "--every", 5, "--input", "couple=couple.txt", "--damping",
          "modal 0.005", "-o", "motion.h5")
    with h5py.File(tools.path("motion.h5")) as f:
        exact = f["y"][:].ravel()
    count = min(len(turn), len(exact))
    tap.near(turn[:count], exact[:count], 1e-4,
             "page: the rotor turns in its bearing as in ritz-simulate")


def main():
    program = os.environ.get("MBDYN")
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    if not program:
        print("1..0 # skipped: MBDYN does not name the program of MBDyn")
        return
    tap = Tap()
    keep = os.environ.get("KEEP")
    with tempfile.TemporaryDirectory() as folder:
        tools = Tools(sys.argv[1], keep or folder)
        mbdyn = Mbdyn(pathlib.Path(program).resolve(), tools)
        push = ["--input", "push=29:1", "--output-at", "feed=29:1"]
        make_body(tools, "free", "", "--port", "hub=1", *push)
        make_body(tools, "held", "SPC1,1,123456,1\n", *push)
        check_free(tap, tools, mbdyn)
        check_clamped(tap, tools, mbdyn)
        check_spin(tap, tools, mbdyn)
        check_recovery(tap, tools, mbdyn)
        check_page(tap, tools, mbdyn)
    tap.finish()


main()
