#!/usr/bin/python3 -s
"""with_ansys_archive.py PROGRAMS - coded databases that ANSYS wrote, which come
with mapdl-archive, are read as that package reads them."""
import pathlib
import sys
import tempfile

import h5py
import mapdl_archive
import numpy
import scipy.io
import scipy.sparse
from mapdl_archive import examples

from common import Tap, Tools

FOLDER = pathlib.Path(examples.__file__).resolve().parent


def import_grids(tools, path, numbers):
    """A component of unit masses on springs at the nodes of a deck."""
    eye = scipy.sparse.identity(3 * len(numbers), format="coo")
    scipy.io.mmwrite(tools.path("eye.mtx"), eye, symmetry="symmetric")
    with open(tools.path("part.map"), "w") as rows:
        for number in sorted(numbers):
            rows.writelines(f"{number} {c}\n" for c in (1, 2, 3))
    return tools("ritz-import", "--stiffness", "eye.mtx", "--mass", "eye.mtx",
                 "--dofs", "part.map", "--bulk", path, "-o", "part.h5")


def axes_of(angles):
    """Rows: the axes x, y, z that THXY, THYZ and THZX leave, in turn."""
    axes = numpy.eye(3)
    for axis, degrees in zip((2, 0, 1), angles):
        about, rest = axes[axis], numpy.radians(degrees)
        axes = numpy.array([
            a * numpy.cos(rest) + numpy.cross(about, a) * numpy.sin(rest)
            + about * (about @ a) * (1.0 - numpy.cos(rest)) for a in axes])
    return axes


def check_archive(tap, tools, path):
    known = mapdl_archive.Archive(str(path), parse_vtk=False)
    said = import_grids(tools, path, known.nnum)
    order = numpy.argsort(known.nnum)
    with h5py.File(tools.path("part.h5")) as file:
        tap.check(numpy.array_equal(file["grids/id"][:],
                                    numpy.asarray(known.nnum)[order]),
                  f"{path.name}: all {len(order)} nodes")
        tap.near(file["grids/position"][:], known.nodes[order, :3], 4e-16,
                 f"{path.name}: where they are")
        frames = file["grids/frames"][:]
        found = numpy.array([frames[k] for k in file["grids/frame"][:]])
        wanted = [axes_of(a) for a in known.node_angles[order]]
        tap.near(found, wanted, 1e-14, f"{path.name}: their axes")
    tap.check(f"{len(known.elem)} elements for pictures; 0 left out" in said,
              f"{path.name}: all {len(known.elem)} elements")


def main():
    tap = Tap()
    paths = sorted(FOLDER.glob("*.cdb"))
    tap.check(len(paths) >= 4, "the package brings archives")
    for path in paths:
        with tempfile.TemporaryDirectory() as folder:
            check_archive(tap, Tools(sys.argv[1], folder), path)
    tap.finish()


main()
