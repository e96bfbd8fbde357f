#!/usr/bin/python3 -s
"""with_nastran_readers.py PROGRAMS - OUTPUT4 files that ritz-export writes are
read by pyNastran and pyYeti to the same bits, DMIG cards to their digits."""
import itertools
import sys
import tempfile

import h5py
import numpy
import pyNastran.op4.op4
import pyyeti.nastran.op4
from pyNastran.bdf.bdf import BDF
from pyyeti.nastran import bulk

from common import Block, Tap, Tools

# in a container: K, M and T under their names, B under inputs
MEMBERS = {"K": "K", "M": "M", "T": "T", "B": "inputs/B"}


def dense(matrix):
    return numpy.asarray(matrix.todense() if hasattr(matrix, "todense")
                         else matrix)


def with_pynastran(path):
    found = pyNastran.op4.op4.read_op4(path, debug=None)
    return {name.upper(): dense(m.data) for name, m in found.items()}


def with_pyyeti(path):
    found = pyyeti.nastran.op4.read(path, into="dct", sparse=None)
    return {name.upper(): dense(m) for name, m in found.items()}


READERS = {"pyNastran": with_pynastran, "pyYeti": with_pyyeti}


def same_bits(a, b):
    """Values equal bit for bit, but for the sign of zero."""
    a, b = numpy.asarray(a), numpy.asarray(b)
    return a.shape == b.shape and a.dtype == b.dtype and (
        (a + 0.0).tobytes() == (b + 0.0).tobytes())


def check(tap, tools, expected, options):
    title = " ".join(option.strip("-") for option in options) or "binary"
    said = tools("ritz-export", "--to", "output4", *options,
                 "--matrix", ",".join(expected), "reduced.h5",
                 "-o", "reduced.op4")
    tap.check(all(name in said for name in expected),
              f"{title}: ritz-export names what it wrote")
    for reader, read in READERS.items():
        found = read(tools.path("reduced.op4"))
        tap.check(set(found) == set(expected),
                  f"{title}: {reader} finds each matrix", " ".join(found))
        for name, matrix in expected.items():
            if name in found:
                tap.check(same_bits(found[name], matrix),
                          f"{title}: {reader} reads {name} to the bit",
                          f"{matrix.shape[0]} x {matrix.shape[1]}")


def check_digits(tap, tools, expected):
    tools("ritz-export", "--to", "output4", "--text", "--digits", 9, "--force",
          "--matrix", "K", "reduced.h5", "-o", "nine.op4")
    for reader, read in READERS.items():
        error = numpy.abs(read(tools.path("nine.op4"))["K"] - expected["K"])
        # half a unit of the ninth digit of each entry
        tap.check((error <= 5.01e-9 * numpy.abs(expected["K"])).all()
                  and error.max() > 0.0,
                  f"nine digits: {reader} reads K rounded to nine digits")


def cards_by_pynastran(path, name):
    """Values and names of rows."""
    model = BDF(debug=None)
    model.read_bdf(path, punch=True, xref=False)
    A, rows, _ = model.dmig[name].get_matrix(is_sparse=False)
    return dense(A), [rows[k] for k in range(len(rows))]


def cards_by_pyyeti(path, name):
    frame = bulk.rddmig(path)[name.lower()]
    return frame.to_numpy(), [tuple(at) for at in frame.index]


def check_cards(tap, tools, expected, options):
    """Coordinates are 27 dofs of nine grids, which come first, and six scalar
    points. pyNastran sorts names as it likes."""
    # eleven digits of -1.2345678901-12, ten of -1.234567890D-12
    worst = 5e-10 if "--numbered" in options else 5e-11
    title = " ".join(["dmig"] + [option.strip("-") for option in options])
    tools("ritz-export", "--to", "dmig", "--force", *options, "reduced.h5",
          "-o", "reduced.dmig")
    with h5py.File(tools.path("reduced.h5")) as f:
        column = f["columns/dof"][:]
        place = [(int(f["dofs/grid"][k]), int(f["dofs/component"][k]))
                 for k in column[column >= 0]]
    place += [(1001 + k, 0) for k in range((column < 0).sum())]
    for reader, read in (("pyNastran", cards_by_pynastran),
                         ("pyYeti", cards_by_pyyeti)):
        for name in "KM":
            values, rows = read(tools.path("reduced.dmig"), name + "AAX")
            tap.check(sorted(rows) == sorted(place),
                      f"{title}: {reader} reads the names of rows")
            at = [place.index(row) for row in rows]
            matrix = expected[name][numpy.ix_(at, at)]
            # an asymmetry of rounding is averaged away
            matrix = (matrix + matrix.T) / 2.0
            error = numpy.abs(values - matrix)
            tap.check(values.shape == matrix.shape
                      and (error <= worst * numpy.abs(matrix)).all(),
                      f"{title}: {reader} reads {name} to its digits")


def main():
    tap = Tap()
    with tempfile.TemporaryDirectory() as folder:
        tools = Tools(sys.argv[1], folder)
        block = Block((4, 2, 2), turned=True)
        block.write(tools, "--input", "push=45:3")
        tools("ritz-basis", "craig-bampton", "--modes", 6, "block.h5",
              "-o", "basis.h5")
        tools("ritz-reduce", "block.h5", "basis.h5", "-o", "reduced.h5")
        with h5py.File(tools.path("reduced.h5")) as f:
            expected = {name: f[at][:] for name, at in MEMBERS.items()}
        for text, full in itertools.product([[], ["--text"]],
                                            [[], ["--dense"]]):
            check(tap, tools, expected, text + full)
        check_digits(tap, tools, expected)
        for options in [], ["--numbered"]:
            check_cards(tap, tools, expected, options)
    tap.finish()


if len(sys.argv) != 2:
    sys.exit(__doc__)
main()
