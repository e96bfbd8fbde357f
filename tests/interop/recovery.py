"""The rotor of data/dualspin under a force, with the stresses of its bars: what
its full model does, what a reduced one does, and what ritz-recover writes of a
simulator's file. Of these only read_pvd() and read_xdmf() read ritz-recover."""
import pathlib
import re
import subprocess
import sys

import h5py
import meshio
import numpy
import scipy.io
import scipy.sparse

from common import DATA

# The force acts at the feed of the antenna, along x; the hub is at 0.
FEED, HUB = 29, 1
SECONDS = 2.0
# of K, s
STIFFNESS_DAMPING = 0.01
DAMPED = ["--damping", f"rayleigh 0 {STIFFNESS_DAMPING}"]
# all times that are compared
EVERY = 0.02


def force(t):
    """It begins with three derivatives of zero, and stays below 2 Hz."""
    return numpy.sin(numpy.pi * t / 2.0) ** 4 * numpy.cos(2.4 * numpy.pi * t)


class Rotor:
    """NAME.h5, 24 modes and the motion of the ports, of NAME-full.h5."""

    def __init__(self, tools, name, held, scale):
        self.tools, self.name, self.held, self.scale = tools, name, held, scale
        rotor = DATA / "dualspin" / "rotor"
        subprocess.run([sys.executable, DATA / "dualspin" / "stresses.py",
                        f"{rotor}.bdf", tools.path("rows.mtx"),
                        tools.path("rows.txt")], check=True)
        self.S = scipy.sparse.csr_matrix(scipy.io.mmread(
            tools.path("rows.mtx")))
        self.rows = [tuple(line.split()) for line in
                     open(tools.path("rows.txt")) if line[0] != "#"]
        scipy.io.mmwrite(tools.path("unit.mtx"),
                         scipy.sparse.identity(self.S.shape[1]).tocoo())
        (tools.folder / f"{name}.bdf").write_text(
            "SPC = 1\nBEGIN BULK\n"
            + (f"SPC1,1,123456,{HUB}\n" if held else "")
            + rotor.with_suffix(".bdf").read_text())
        self.write("full", "--recovery", "stress=rows.mtx",
                   "--recovery-rows", "stress=rows.txt")
        self.write("u", "--output-matrix", "unit.mtx")
        self.write("s", "--output-matrix", "rows.mtx")
        tools("ritz-basis", "craig-bampton", "--modes", 24, f"{name}-full.h5",
              "-o", "basis.h5")
        tools("ritz-reduce", "--recovery", "acceleration", f"{name}-full.h5",
              "basis.h5", "-o", f"{name}.h5")
        self.signal = f"{name}-force.txt"
        t = numpy.linspace(0.0, SECONDS, 20001)
        numpy.savetxt(tools.path(self.signal),
                      numpy.c_[t, scale * force(t)], "%.17g")

    def write(self, what, *options):
        rotor = DATA / "dualspin" / "rotor"
        hub = [] if self.held else ["--port", f"hub={HUB}"]
        self.tools(
            "ritz-import", "--stiffness", f"{rotor}.op4:KGG", "--mass",
            f"{rotor}.op4:MGG", "--bulk", f"{self.name}.bdf", "--units",
            "kg m s", "--port", f"feed={FEED}:1", *hub, "--input",
            f"push={FEED}:1", *options, "-o", f"{self.name}-{what}.h5")

    def simulate(self, model, held, *more):
        """Output of ritz-simulate at each time that is compared; `held`: file
        of a force that stays from one of these to the next."""
        step, hold = (EVERY, ["--hold", "zero"]) if held else (2.5e-4, [])
        self.tools("ritz-simulate", model, "--seconds", SECONDS, "--step",
                   step, "--every", round(EVERY / step), *DAMPED, *hold,
                   "--input", f"push={held or self.signal}", *more,
                   "-o", "own.h5")
        return h5py.File(self.tools.path("own.h5"))

    def split(self, u):
        """Translations of all 41 grids, in the frame of the hub, which is
        tangent, and stresses."""
        u = u.reshape(len(u), -1, 6)
        at = self.places()
        # rows of axes are along basic ones, the hub's are basic
        moved = numpy.einsum("tga,gab->tgb", u[:, :, :3], self.axes)
        moved -= u[:, :1, :3]
        moved -= numpy.cross(u[:, :1, 3:], (at - at[0])[None, :, :])
        return moved, (self.S @ u.reshape(len(u), -1).T).T

    def places(self):
        """Of all grids, with that of a hub that the deck holds."""
        with h5py.File(self.tools.path(f"{self.name}.h5")) as f:
            self.ids = list(f["grids/id"][:])
            at = f["grids/position"][:].reshape(-1, 3)
            self.axes = f["grids/frames"][:][f["grids/frame"][:]]
        if HUB not in self.ids:
            self.ids, at = [HUB] + self.ids, numpy.vstack([[0, 0, 0], at])
            self.axes = numpy.concatenate([numpy.eye(3)[None], self.axes])
        return at

    def full(self, held=None):
        """Displacements and stresses of the full model."""
        with self.simulate(f"{self.name}-u.h5", held, "--up-to-hz",
                           500) as run:
            return self.split(run["y"][:])

    def reduced(self, held=None):
        """Those of the reduced one."""
        with self.simulate(f"{self.name}.h5", held, "--coordinates") as run:
            return self.spread(run)

    def spread(self, run):
        """u = T q, and stresses by mode displacement."""
        with h5py.File(self.tools.path(f"{self.name}.h5")) as f:
            self.places()
            u = numpy.zeros((len(run["seconds"]), self.S.shape[1]))
            at = numpy.array([self.ids.index(g) for g in f["dofs/grid"][:]])
            u[:, 6 * at + f["dofs/component"][:] - 1] = \
                run["coordinates/q"][:] @ f["T"][:].T
        return self.split(u)

    def stated(self):
        """Error of displacements and of stresses that ritz-verify measures
        below 4 Hz: of the largest response to a harmonic unit force, here of
        the largest value of the force."""
        errors = []
        for what in "us":
            model = f"{self.name}-{what}.h5"
            self.tools("ritz-reduce", "--estimates", "none", model, "basis.h5",
                       "-o", "checked.h5")
            self.tools("ritz-verify", "--band-hz", "0.05,4", *DAMPED, model,
                       "checked.h5", "-o", "verified.h5")
            self.tools("ritz-frf", "--from-hz", 0.05, "--to-hz", 4, "--points",
                       400, *DAMPED, model, "-o", "response.h5")
            with h5py.File(self.tools.path("response.h5")) as f, \
                    h5py.File(self.tools.path("verified.h5")) as v:
                most = numpy.hypot(f["H/real"][:], f["H/imag"][:]).max()
                values = dict(zip(v["errors/name"][:], v["errors/value"][:]))
            errors.append(values[b"response-relative"] * most * self.scale)
        return errors

    def pick(self, point, cell, beside=False):
        """Displacements of all grids, or what they are beside the hub, and
        stresses of all bars that are cells of a mesh, NaN where a row is of
        none."""
        moved, turned = numpy.zeros((2, len(self.ids), 3))
        for grid, x, turn in zip(point["grid"].ravel(), point["displacement"],
                                 point["displacement, rotations"]):
            moved[self.ids.index(int(grid))] = x
            turned[self.ids.index(int(grid))] = turn
        if beside:
            at = self.places()
            moved -= moved[0] + numpy.cross(turned[0], at - at[0])
        number = {int(e): k for k, e in enumerate(cell["element"].ravel())}
        stress = [cell[f"stress {word}"].ravel()[number[int(e)]]
                  if int(e) in number else numpy.nan for e, word in self.rows]
        return moved, numpy.array(stress)

    def read_pvd(self, path, beside=False):
        """Times, displacements and stresses of a collection."""
        path = pathlib.Path(self.tools.path(path))
        found = re.findall(r'timestep="([^"]*)".*?file="([^"]*)"',
                           path.read_text())
        frames = [meshio.read(path.parent / name) for _, name in found]
        picked = [self.pick(mesh.point_data,
                            {k: v[0] for k, v in mesh.cell_data.items()},
                            beside)
                  for mesh in frames]
        return (numpy.array([float(t) for t, _ in found]),
                *map(numpy.array, zip(*picked)))

    def read_xdmf(self, path, first):
        """The same of XDMF, whose elements are those of `first`, a frame of
        the same mesh."""
        mesh = meshio.read(self.tools.path(first))
        fixed = {"grid": mesh.point_data["grid"]}
        own = {"element": mesh.cell_data["element"][0]}
        times, picked = [], []
        with meshio.xdmf.TimeSeriesReader(self.tools.path(path)) as series:
            series.read_points_cells()
            for k in range(series.num_steps):
                t, point, cell = series.read_data(k)
                times.append(t)
                picked.append(self.pick(
                    {**fixed, **point},
                    {**own, **{k: v[0] for k, v in cell.items()}}))
        return numpy.array(times), *map(numpy.array, zip(*picked))


def error(found, expected):
    """Of the largest value, where something was found."""
    return numpy.nanmax(numpy.abs(found - expected)) / \
        numpy.abs(expected).max()


def maxima(path):
    """Element and word of each row of a table of maxima, its value and time."""
    rows = [line.rstrip("\n").split("\t") for line in open(path)
            if line[0] != "#"][1:]
    return ([tuple(row[1:3]) for row in rows],
            numpy.array([[float(row[3]), float(row[4])] for row in rows]))
