#!/usr/bin/python3 -s
"""with_nastran_solvers.py PROGRAMS - NASTRAN-95 and MYSTRAN run our decks: of
the matrices that they write, ritz-basis finds the frequencies that they print.
NASTRAN-95 solves a system in which our component is DMIG beside its own bars."""
import re
import sys
import tempfile

import h5py
import numpy
import scipy.linalg
import scipy.sparse

from common import EXTERNAL, Tap, Tools
from solvers import (MYSTRAN, NASTRAN95, need, printed_complex_hertz,
                     printed_hertz, run_mystran, run_nastran95)

FEER = "EIGR    1       FEER    0.0     1.-9            {modes}"
SOLVERS = {
    # BANDIT would number the grids again, and permute the matrices; a negative
    # unit of OUTPUT4 means binary and sparse, as dense masses may crash it;
    # FEER ends at a relative error of squares of 1e-9 %
    "NASTRAN-95": dict(
        run=run_nastran95, deck=".deck", op4=".op4", head="""\
NASTRAN BANDIT=-1
ID RITZ,PART
APP DISP
SOL 3,0
TIME 10
ALTER 42 $
OUTPUT4 KGG,MGG,,,//-1/-14 $
ENDALTER $
CEND
TITLE = PART
METHOD = 1
{spc}BEGIN BULK
""" + FEER + "\n"),
    # without GRIDSEQ rows are in the order of the GRID cards
    "MYSTRAN": dict(
        run=run_mystran, deck=".dat", op4=".OU1", head="""\
ID RITZ,PART
SOL 3
OUTPUT4 KGG,MGG,,,//-1/21 $
CEND
TITLE = PART
METHOD = 1
{spc}BEGIN BULK
EIGRL   1                       {modes}
PARAM   GRDPNT  0
PARAM   GRIDSEQ GRID
"""),
}
BAR = ["MAT1    1       7.+10           .3      2700.",
       "PBAR    1       1       2.-3    3.-7    5.-7    6.-7"]


def bars(first, last):
    """Cards of an inclined row of bars, with a weight at each grid."""
    cards = ["PARAM   COUPMASS1"] + BAR
    for k in range(first, last + 1):
        cards += [f"GRID    {k:<8d}        {0.1 * k:<8.2f}{0.0:<8.2f}"
                  f"{0.05 * k:<8.3f}",
                  f"{f'CONM2   {100 + k:<8d}{k:<8d}0       .3':72s}+C{k}",
                  f"+C{k:<6d}1.-3            2.-3                    3.-3"]
    cards += [f"CBAR    {k:<8d}1       {k:<8d}{k + 1:<8d}0.      1.      0."
              for k in range(first, last)]
    return cards


def plate(wide=6, deep=4):
    """Cards of a plate, held at one edge; it resists no drilling."""
    def at(i, j):
        return 1 + i + 10 * j

    cards = ["PARAM   COUPMASS1", BAR[0],
             "PSHELL  1       1       .01     1               1"]
    for i, j in numpy.ndindex(wide + 1, deep + 1):
        cards += [f"GRID    {at(i, j):<8d}        {0.15 * i:<8.2f}"
                  f"{0.1 * j:<8.2f}0.",
                  f"SPC1    1       {'6' if i else '123456':8s}{at(i, j)}"]
    for e, (i, j) in enumerate(numpy.ndindex(wide, deep)):
        cards.append(f"CQUAD4  {e + 1:<8d}1       {at(i, j):<8d}"
                     f"{at(i + 1, j):<8d}{at(i + 1, j + 1):<8d}{at(i, j + 1)}")
    return cards


def half_digit(text):
    """Half a unit of the last digit of a printed number."""
    mantissa, exponent = text.upper().split("E")
    return 0.5 * 10.0 ** (int(exponent) - len(mantissa.split(".")[1]))


def hertz_of(tools, component, modes):
    tools("ritz-basis", "normal-modes", "--modes", modes, component,
          "-o", "modes.h5")
    with h5py.File(tools.path("modes.h5")) as f:
        hertz = f["columns/hertz"][:]
    return numpy.sort(hertz[hertz > 0.0])


def compare(tap, printed, hertz, title, units=1.5):
    """Rounding of what is printed is half a unit of its last digit; cycles come
    from radians or squares that are rounded as well."""
    error = [abs(float(p) - f) / (2.0 * half_digit(p))
             for p, f in zip(printed, hertz)]
    tap.check(len(printed) >= len(hertz) and len(error) > 2
              and max(error) <= units,
              f"{title}: frequencies are those printed",
              f"{len(error)} modes, off by {max(error, default=9e9):.2f} units "
              f"of the last digit ({hertz[0]:.7g} to {hertz[-1]:.7g} Hz)")


def solve(tap, tools, name, stem, rigid, *options, modes=6):
    """Runs a deck, imports its matrices as STEM.h5, compares frequencies."""
    solver = SOLVERS[name]
    deck, op4 = stem + solver["deck"], stem + solver["op4"]
    printed = printed_hertz(solver["run"](deck, tools.folder))
    said = tools("ritz-import", "--stiffness", op4 + ":KGG", "--mass",
                 op4 + ":MGG", "--bulk", deck, *options, "-o", stem + ".h5")
    tap.check("rows named by  grids ascending" in said,
              f"{name}, {stem}: the deck names the rows of its matrices")
    compare(tap, printed[rigid:], hertz_of(tools, stem + ".h5", modes),
            f"{name}, {stem}")


def check_own(tap, tools, name):
    solver = SOLVERS[name]
    held = ["SPC1    1       123456  1"]
    for stem, cards, spc, rigid in (
            ("held", bars(1, 6) + held, "SPC = 1\n", 0),
            ("free", bars(6, 11), "", 6),
            ("plate", plate(), "SPC = 1\n", 0)):
        head = solver["head"].format(spc=spc, modes=12)
        (tools.folder / (stem + solver["deck"])).write_text(
            head + "\n".join(cards + ["ENDDATA", ""]))
        solve(tap, tools, name, stem, rigid, "--port", "end=6")


def check_external(tap, tools, name):
    """Two components of 26 grids, some with axes of their own."""
    folder = EXTERNAL / "nastran/public_solvers"
    if not folder.is_dir():
        print("# no external data: nas2cam is left out")
        return
    solver = SOLVERS[name]
    for part in "inboard", "outboard":
        stem = f"{name.lower().replace('-', '')}_{part}"
        deck = stem + solver["deck"]
        # of 12 that are wanted, FEER finds the twelfth to five digits only
        text = re.sub("^EIGR .*", FEER.format(modes=30),
                      (folder / deck).read_text(), flags=re.M)
        (tools.folder / deck).write_text(text)
        solve(tap, tools, name, stem, 6)


def sparse(group):
    return scipy.sparse.csc_matrix(
        (group["data"][:], group["indices"][:], group["indptr"][:]),
        group.attrs["shape"]).toarray()


def eigenvalues(K, M):
    return scipy.linalg.eigh(K, M, eigvals_only=True)


def check_craig_bampton(tap, tools):
    """MYSTRAN's own reduction of the outboard part to four grids and sixteen
    modes has the eigenvalues of ours, of the matrices that it wrote."""
    deck = EXTERNAL / "nastran/public_solvers/mystran_outboard_cb.dat"
    if not deck.is_file():
        return
    (tools.folder / "theirs.dat").write_text(deck.read_text())
    run_mystran("theirs.dat", tools.folder)
    (tools.folder / "theirs.dofs").write_text(
        "".join(f"{k} 0\n" for k in range(1, 41)))
    tools("ritz-import", "--stiffness", "theirs.OU1:KXX", "--mass",
          "theirs.OU1:MXX", "--dofs", "theirs.dofs", "-o", "theirs.h5")
    stem = "mystran_outboard"  # check_external made it
    tools("ritz-import", "--stiffness", stem + ".OU1:KGG", "--mass",
          stem + ".OU1:MGG", "--bulk", stem + ".dat", "--port",
          "inboard=3,11,19,27", "-o", "outboard.h5")
    tools("ritz-basis", "craig-bampton", "--modes", 16, "outboard.h5", "-o",
          "fixed.h5")
    tools("ritz-reduce", "outboard.h5", "fixed.h5", "-o", "ours.h5")
    with h5py.File(tools.path("theirs.h5")) as f:
        theirs = eigenvalues(sparse(f["K"]), sparse(f["M"]))
    with h5py.File(tools.path("ours.h5")) as f:
        ours = eigenvalues(f["K"][:], f["M"][:])
    # rounding of the largest, and 16 modes to the residual of Lanczos
    allowed = (4.0 * numpy.finfo(float).eps * ours[-1]
               + 1e-8 * numpy.abs(ours))
    tap.check(len(theirs) == len(ours)
              and (numpy.abs(theirs - ours) <= allowed).all(),
              "MYSTRAN, its own Craig-Bampton has the eigenvalues of ours",
              f"{len(ours)}, up to {ours[-1] ** 0.5 / 6.2832:.4g} Hz")


def system_hertz(tools):
    """Of the reduced 'held' and the whole 'free', joined at grid 6."""
    with h5py.File(tools.path("reduced.h5")) as a, \
            h5py.File(tools.path("free.h5")) as b:
        own = b["K"].attrs["shape"][0]
        first = list(b["dofs/grid"][:]).index(6)
        # the interface comes first in a Craig-Bampton basis
        place = numpy.concatenate([first + numpy.arange(6),
                                   own + numpy.arange(len(a["K"]) - 6)])
        K, M = numpy.zeros((2, own + len(a["K"]) - 6, own + len(a["K"]) - 6))
        for A, name in (K, "K"), (M, "M"):
            A[:own, :own] = sparse(b[name])
            A[numpy.ix_(place, place)] += a[name][:]
    return numpy.sqrt(eigenvalues(K, M)) / (2.0 * numpy.pi)


def check_system(tap, tools):
    """Rigid format 7 takes DMIG as K2PP and M2PP; its modes are by FEER."""
    tools("ritz-basis", "craig-bampton", "--modes", 8, "held.h5", "-o",
          "basis.h5")
    tools("ritz-reduce", "held.h5", "basis.h5", "-o", "bare.h5")
    tools("ritz-verify", "held.h5", "bare.h5", "-o", "reduced.h5")
    tools("ritz-export", "--to", "dmig", "--numbered", "reduced.h5", "-o",
          "held.dmig")
    cards = [line for line in (tools.folder / "held.dmig").read_text()
             .splitlines() if not line.startswith("$")]
    tap.check(sum(line.startswith("*") for line in cards) > 14,
              "NASTRAN-95, system: the component is written as DMIG")
    deck = ["NASTRAN BANDIT=-1", "ID RITZ,SYSTEM", "APP DISP", "SOL 7,0",
            "TIME 10", "CEND", "TITLE = SYSTEM", "CMETHOD = 1", "K2PP = KAAX",
            "M2PP = MAAX", "BEGIN BULK",
            f"{'EIGC    1       FEER    MAX':72s}+E1",
            "+E1     0.      100." + " " * 36 + "8"]
    (tools.folder / "system.deck").write_text(
        "\n".join(deck + bars(6, 11) + cards + ["ENDDATA", ""]))
    printed = printed_complex_hertz(run_nastran95("system.deck", tools.folder))
    # FEER of complex eigenvalues ends at an error of the seventh digit
    compare(tap, printed, system_hertz(tools)[:8],
            "NASTRAN-95, system with a component of DMIG", 4.0)


def main():
    need(NASTRAN95, MYSTRAN)
    tap = Tap()
    for name in SOLVERS:
        with tempfile.TemporaryDirectory() as folder:
            tools = Tools(sys.argv[1], folder)
            check_own(tap, tools, name)
            check_external(tap, tools, name)
            if name == "NASTRAN-95":
                check_system(tap, tools)
            else:
                check_craig_bampton(tap, tools)
    tap.finish()


if len(sys.argv) != 2:
    sys.exit(__doc__)
main()
