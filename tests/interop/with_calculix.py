#!/usr/bin/python3 -s
"""with_calculix.py PROGRAMS - CalculiX stores the matrices of a deck, and finds
the frequencies that ritz-basis finds of them; the forces that it prints for unit
displacements are our guyan, and so is its substructure from version 2.21 on.
Its buckling factor is that of ritz-check, with the geometric stiffness that its
matrices gain by a small load.

CCX names the program [ccx], which must then condense substructures; that of
Debian 12 does not. docs/import.md tells why, and how release 2.23 is built."""
import json
import os
import re
import shutil
import sys
import tempfile

import h5py
import numpy
import scipy.io
import scipy.sparse

from common import EXTERNAL, Tap, Tools
from solvers import need_calculix, run_calculix

STORE = ["*STEP", "*FREQUENCY, SOLVER=MATRIXSTORAGE", "12", "*END STEP"]
FREQUENCY = ["*STEP", "*FREQUENCY", "12", "*END STEP"]
# half a unit of the last digit of 0.1000000 and of thirteen digits
SEVEN, THIRTEEN = 5.1e-7, 5.1e-13
KEPT = 55, 63  # two corners of the free end
PUSHED = 55  # its first node
SUBSTRUCTURE = [
    "*STEP", "*SUBSTRUCTURE GENERATE", "*RETAINED NODAL DOFS, SORTED=NO",
    "KEPT, 1, 3", "*SUBSTRUCTURE MATRIX OUTPUT, STIFFNESS=YES, OUTPUT "
    "FILE={}, FILE NAME=part", "*END STEP"]
# half a unit of the last digit of 1.0000000000000, of which .sti files are
STORED = 5.1e-14


def block(bricks=(6, 2, 2), size=(1.2, 0.2, 0.3)):
    """A block of steel, clamped at x = 0; sets HELD and KEPT."""
    count = numpy.array(bricks) + 1
    index = numpy.arange(count.prod()).reshape(count) + 1
    step = numpy.array(size) / bricks
    lines = ["*NODE"]
    for at in numpy.ndindex(*count):
        lines.append(", ".join([str(index[at])]
                               + [f"{x:.9f}" for x in step * at]))
    lines.append("*ELEMENT, TYPE=C3D8, ELSET=ALL")
    for e, (i, j, k) in enumerate(numpy.ndindex(*bricks)):
        node = [index[i + a, j + b, k + c] for a, b, c in
                [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0),
                 (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]]
        lines.append(", ".join(map(str, [e + 1] + node)))
    return lines + [
        "*MATERIAL, NAME=STEEL", "*ELASTIC", "2.1E11, 0.3", "*DENSITY",
        "7850.", "*SOLID SECTION, ELSET=ALL, MATERIAL=STEEL",
        "*NSET, NSET=HELD", ", ".join(map(str, index[0].ravel())),
        "*NSET, NSET=KEPT", ", ".join(map(str, KEPT)),
        "*BOUNDARY", "HELD, 1, 3"]


def write(tools, name, lines):
    (tools.folder / name).write_text("\n".join(lines) + "\n")


def printed_hertz(path):
    """Cycles of the first table of a .dat file."""
    rows = re.findall(r"^ +\d+((?: +-?\d\.\d+E[-+]\d+){4})$",
                      path.read_text(), re.M)
    return numpy.array([float(row.split()[2]) for row in rows])


def hertz_of(tools, component, modes):
    tools("ritz-basis", "normal-modes", "--modes", modes, component,
          "-o", "modes.h5")
    with h5py.File(tools.path("modes.h5")) as f:
        hertz = f["columns/hertz"][:]
    return numpy.sort(hertz[hertz > 0.0])


def stored(tools, deck, *options):
    """Import the matrices that CalculiX stored; returns what is printed."""
    run_calculix(deck + ".inp", tools.folder)
    return tools("ritz-import", "--stiffness", deck + ".sti", "--mass",
                 deck + ".mas", "--dofs", deck + ".dof", "--bulk",
                 deck + ".inp", *options, "-o", deck + ".h5")


def check_block(tap, tools):
    write(tools, "store.inp", block() + STORE)
    write(tools, "waves.inp", block() + FREQUENCY)
    said = stored(tools, "store", "--port", f"kept={KEPT[0]},{KEPT[1]}")
    tap.check("162 dofs at 54 grids" in said,
              "the rows of 54 free nodes have names")
    run_calculix("waves.inp", tools.folder)
    printed = printed_hertz(tools.folder / "waves.dat")
    tap.near(hertz_of(tools, "store.h5", 12), printed[:12], SEVEN,
             "frequencies are those of CalculiX")


def sparse(group):
    return scipy.sparse.csc_matrix(
        (group["data"][:], group["indices"][:], group["indptr"][:]),
        group.attrs["shape"]).toarray()


def forces(tools):
    """Forces at KEPT where one of its displacements is 1, the others 0: the
    columns of the condensed stiffness, with seven digits."""
    columns = []
    for node in KEPT:
        for direction in 1, 2, 3:
            write(tools, "unit.inp", block() + [
                "*STEP", "*STATIC", "*BOUNDARY", "KEPT, 1, 3, 0.",
                f"{node}, {direction}, {direction}, 1.",
                "*NODE PRINT, NSET=KEPT", "RF", "*END STEP"])
            run_calculix("unit.inp", tools.folder)
            rows = re.findall(r"^ +(\d+)((?: +-?\d\.\d+E[-+]\d+){3})$",
                              (tools.folder / "unit.dat").read_text(), re.M)
            found = {int(n): [float(x) for x in f.split()] for n, f in rows}
            columns.append([x for n in KEPT for x in found[n]])
    return numpy.array(columns).T


def check_guyan(tap, tools):
    tools("ritz-basis", "guyan", "store.h5", "-o", "basis.h5")
    tools("ritz-reduce", "store.h5", "basis.h5", "-o", "reduced.h5")
    with h5py.File(tools.path("reduced.h5")) as f:
        K = f["K"][:]
    tap.near(K, forces(tools), SEVEN,
             "forces of unit displacements are the columns of guyan")
    return K


def stored_stiffness(tools):
    """Of the .sti file: the rows and columns of KEPT, and what the last digits
    of all may change after condensation, |Phi|' |dK| |Phi|, |dK| <= e |K|."""
    with h5py.File(tools.path("store.h5")) as f:
        K = sparse(f["K"])
        kept = numpy.isin(f["dofs/grid"][:], KEPT)
    Phi = numpy.eye(len(K))[:, kept]
    Phi[~kept] = -numpy.linalg.solve(K[numpy.ix_(~kept, ~kept)],
                                     K[numpy.ix_(~kept, kept)])
    change = numpy.abs(Phi).T @ (STORED * numpy.abs(K)) @ numpy.abs(Phi)
    return K[numpy.ix_(kept, kept)], change.max()


def substructure(tools, output):
    """The matrix of part.mtx, and the version of the program."""
    write(tools, "sub.inp", block() + [line.format(output)
                                       for line in SUBSTRUCTURE])
    (tools.folder / "part.mtx").unlink(missing_ok=True)
    printed = run_calculix("sub.inp", tools.folder)
    write(tools, "unit.mtx", [f"{n},{d},{n},{d},1." for n in KEPT
                              for d in (1, 2, 3)])
    tools("ritz-import", "--stiffness", "part.mtx", "--mass", "unit.mtx",
          "--bulk", "sub.inp", "-o", "sub.h5")
    with h5py.File(tools.path("sub.h5")) as f:
        found = sparse(f["K"])
    version = re.search(r"Version (\d+)\.(\d+)", printed)
    return found, tuple(map(int, version.groups())) if version else None


def check_substructure(tap, tools, K):
    """CalculiX 2.20 condenses as if no kept dof moved the others, and so writes
    the rows and columns of the .sti file."""
    uncondensed, change = stored_stiffness(tools)
    found, version = substructure(tools, "USER DEFINED")
    error = numpy.abs(found - uncondensed).max()
    if (version == (2, 20) and "CCX" not in os.environ
            and error <= THIRTEEN * numpy.abs(uncondensed).max()):
        print("# skipped: CalculiX 2.20 does not condense substructures; CCX "
              "may name a program that does")
        return
    tap.near(found, K, THIRTEEN + change / numpy.abs(K).max(),
             "the substructure is guyan")
    if version != (2, 20):  # which ignores this output
        again, _ = substructure(tools, "MATRIX")
        tap.near(again, found, 0.0, "and so is its MATRIX INPUT, in every bit")


def push(total):
    """*CLOAD of a force along -x, spread over the free end."""
    share = numpy.outer([0.25, 0.5, 0.25], [0.25, 0.5, 0.25]).ravel()
    return ["*CLOAD"] + [f"{PUSHED + k}, 1, {-total * part:.9f}"
                         for k, part in enumerate(share)]


def read_stored(path):
    """The triangle of a matrix that CalculiX stored."""
    row, col, value = numpy.loadtxt(path).T
    at = row.astype(int) - 1, col.astype(int) - 1
    return scipy.sparse.csc_matrix((value, at))


def check_buckling(tap, tools):
    """Loads s and -s change K by s KG and -s KG, and by the deformation of the
    elements: of the factor, by the strain at which it buckles or less."""
    total = 1e5
    write(tools, "buckle.inp", block() + ["*STEP", "*BUCKLE", "2"]
          + push(total) + ["*END STEP"])
    run_calculix("buckle.inp", tools.folder)
    loaded = []
    for sign, deck in (1, "pressed"), (-1, "pulled"):
        write(tools, deck + ".inp", block() + ["*STEP", "*STATIC"]
              + push(sign * total) + ["*END STEP", "*STEP, PERTURBATION"]
              + STORE[1:])
        run_calculix(deck + ".inp", tools.folder)
        loaded.append(read_stored(tools.folder / f"{deck}.sti"))
    gained = (loaded[0] - loaded[1]) / 2.0
    gained += gained.T - scipy.sparse.diags(gained.diagonal())
    scipy.io.mmwrite(tools.folder / "KG.mtx", gained, symmetry="symmetric",
                     precision=17)
    tools("ritz-import", "--stiffness", "store.sti", "--mass", "store.mas",
          "--dofs", "store.dof", "--bulk", "store.inp",
          "--geometric-stiffness", "KG.mtx@push", "-o", "column.h5")
    found = [check["value"] for check in
             json.loads(tools("ritz-check", "--json", "column.h5"))["checks"]
             if check["name"] == "buckling:push"]
    printed = re.search(r"^ +1 +(\S+)$",
                        (tools.folder / "buckle.dat").read_text(), re.M)
    factor = float(printed[1])
    tap.near(numpy.array(found), numpy.array([factor]),
             factor * total / (0.2 * 0.3 * 2.1e11),  # measured: 6.3e-4
             "the buckling factor is that of CalculiX")


def check_rod(tap, tools):
    """A connecting rod of quadratic tetrahedra, free, 2805 dofs."""
    deck = EXTERNAL / "calculix/conrod/conrod.inp"
    if not deck.is_file():
        print("# no external data: the connecting rod is left out")
        return
    shutil.copyfile(deck, tools.folder / "rod.inp")
    text = deck.read_text()
    write(tools, "freerod.inp",
          [text.replace(",SOLVER=MATRIXSTORAGE", "").replace(
              "\n10\n", "\n12\n").rstrip()])
    said = stored(tools, "rod")
    tap.check("2805 dofs" in said and "14 significant" in said,
              "the rod has 2805 rows, of 14 digits")
    run_calculix("freerod.inp", tools.folder)
    printed = printed_hertz(tools.folder / "freerod.dat")
    tap.near(hertz_of(tools, "rod.h5", 6)[-6:], printed[6:12], SEVEN,
             "frequencies of the rod are those of CalculiX")


def main():
    need_calculix()
    tap = Tap()
    with tempfile.TemporaryDirectory() as folder:
        tools = Tools(sys.argv[1], folder)
        check_block(tap, tools)
        check_buckling(tap, tools)
        check_substructure(tap, tools, check_guyan(tap, tools))
        check_rod(tap, tools)
    tap.finish()


if len(sys.argv) != 2:
    sys.exit(__doc__)
main()
