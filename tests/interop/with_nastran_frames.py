#!/usr/bin/python3 -s
"""with_nastran_frames.py PROGRAMS - NASTRAN-95 solves two frames that meet at
four grids: one has its own bars, the other is our component as DMIG. Its
frequencies are those of the same matrices in SciPy, and those of the full
frames within the error of the reduction."""
import re
import sys
import tempfile

from common import EXTERNAL, Tap, Tools, skip
from solvers import NASTRAN95, need, printed_complex_hertz, run_nastran95

try:
    import h5py
    import numpy
    import scipy.linalg
    import scipy.sparse
except ImportError as missing:
    skip(missing)

PUBLIC = EXTERNAL / "nastran/public_solvers"
INTERFACE = [3, 11, 19, 27]
MODES = 16
# FEER finds six digits of the frequencies that are near its shift  [rad/s]
SHIFTS = ((11.0, (0, 1, 2)), (22.0, (3,)), (45.0, (4, 5)), (68.0, (6, 7)))
HEAD = ["NASTRAN BANDIT=-1", "ID RITZ,FRAMES", "APP DISP", "SOL 7,0",
        "TIME 10", "CEND", "TITLE = FRAMES", "CMETHOD = 1", "K2PP = KAAX",
        "M2PP = MAAX", "BEGIN BULK",
        f"{'EIGC    1       FEER    MAX':72s}+E1"]


def import_frame(tools, part):
    op4 = PUBLIC / f"nastran95_{part}.op4"
    tools("ritz-import", "--stiffness", f"{op4}:KGG", "--mass", f"{op4}:MGG",
          "--bulk", PUBLIC / f"nastran95_{part}.deck", "--port",
          "frame=" + ",".join(map(str, INTERFACE)), "-o", part + ".h5")


def matrices(tools, part):
    """K, M and the dofs of their rows."""
    with h5py.File(tools.path(part + ".h5")) as f:
        dofs = list(zip(map(int, f["dofs/grid"]),
                        map(int, f["dofs/component"])))
        if isinstance(f["K"], h5py.Dataset):
            column = f["columns/dof"][:]
            dofs = [dofs[row] if row >= 0 else (part, k)
                    for k, row in enumerate(column)]
            return f["K"][:], f["M"][:], dofs
        return *(scipy.sparse.csc_matrix(
            (f[name]["data"][:], f[name]["indices"][:], f[name]["indptr"][:]),
            f[name].attrs["shape"]).toarray() for name in "KM"), dofs


def hertz_of(tools, *parts):
    """Frequencies above rigid motion of parts that share dofs by name."""
    found = [matrices(tools, part) for part in parts]
    names = sorted({dof for _, _, dofs in found for dof in dofs}, key=str)
    place = {name: k for k, name in enumerate(names)}
    K, M = numpy.zeros((2, len(names), len(names)))
    for K_part, M_part, dofs in found:
        at = [place[dof] for dof in dofs]
        K[numpy.ix_(at, at)] += K_part
        M[numpy.ix_(at, at)] += M_part
    # bars have no inertia about their axes: 1 / lambda is finite
    mu = scipy.linalg.eigh(M, K + M, eigvals_only=True)
    hertz = numpy.sqrt(numpy.abs(1.0 / mu[mu > 1e-12] - 1.0)) / (
        2.0 * numpy.pi)
    return numpy.sort(hertz[hertz > 0.1])


def bulk_of(part):
    """Cards of a deck without those that choose how it is solved."""
    text = (PUBLIC / f"nastran95_{part}.deck").read_text()
    text = text[text.index("BEGIN BULK\n") + 11:text.index("ENDDATA")]
    return [line for line in text.splitlines()
            if not re.match(r"EIGR |\$", line)]


def write_component(tools):
    """The reduced component 'outboard' as cards."""
    tools("ritz-basis", "craig-bampton", "--modes", MODES, "outboard.h5",
          "-o", "basis.h5")
    tools("ritz-reduce", "outboard.h5", "basis.h5", "-o", "bare.h5")
    tools("ritz-verify", "outboard.h5", "bare.h5", "-o", "reduced.h5")
    tools("ritz-export", "--to", "dmig", "--numbered", "reduced.h5", "-o",
          "outboard.dmig")
    return [line for line in (tools.folder / "outboard.dmig").read_text()
             .splitlines() if not line.startswith("$")]


def solve(tools, cards, shift):
    """The frequencies that are printed, of the component beside bars."""
    root = f"+E1     0.      {shift:<40}8"
    (tools.folder / "frames.deck").write_text("\n".join(
        HEAD + [root] + bulk_of("inboard") + cards + ["ENDDATA", ""]))
    return printed_complex_hertz(run_nastran95("frames.deck", tools.folder))


def unit_of(text):
    """One unit of the last digit of a printed number."""
    mantissa, exponent = text.split("E")
    return 10.0 ** (int(exponent) - len(mantissa.split(".")[1]))


def check_shift(tap, tools, cards, shift, reduced, whole):
    printed = solve(tools, cards, shift)
    found = [min(printed, key=lambda text: abs(float(text) - f),
                 default="0.0E+09") for f in reduced]
    off = [(float(text) - f) / unit_of(text)
           for text, f in zip(found, reduced)]
    tap.check(max(map(abs, off)) <= 3.0,
              f"frequencies near {shift / 6.2832:.2f} Hz are SciPy's of the "
              "same matrices",
              f"{' '.join(found)}, off by {max(off, key=abs):.1f} units of the "
              "last digit")
    # frequencies of a subspace are not lower than those of the whole
    above = [float(text) / f - 1.0 for text, f in zip(found, whole)]
    tap.check(min(above) > -1e-6 and max(above) < 1e-4,
              "  and those of the whole frames, but for the reduction",
              f"above by {max(above):.1e} at most")


def main():
    need(NASTRAN95)
    if not PUBLIC.is_dir():
        skip("there are no third-party files")
    tap = Tap()
    with tempfile.TemporaryDirectory() as folder:
        tools = Tools(sys.argv[1], folder)
        for part in "inboard", "outboard":
            import_frame(tools, part)
        cards = write_component(tools)
        reduced = hertz_of(tools, "inboard", "reduced")
        whole = hertz_of(tools, "inboard", "outboard")
        # of NASTRAN-95; NX NASTRAN printed their first seven digits
        tap.near(whole[:5], [1.69880011, 1.76748734, 1.85772039, 3.41961215,
                             7.02421123], 1e-8,
                 "the whole frames have their printed frequencies in SciPy")
        for shift, modes in SHIFTS:
            modes = list(modes)
            check_shift(tap, tools, cards, shift, reduced[modes],
                        whole[modes])
    tap.finish()


if len(sys.argv) != 2:
    sys.exit(__doc__)
main()
