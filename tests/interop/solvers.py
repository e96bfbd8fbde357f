"""NASTRAN-95, MYSTRAN and CalculiX, each run on one deck in a folder.

RITZ_SOLVERS [build/interop/solvers] is where ./bootstrap interop unpacks the
first two; CalculiX is the program that CCX names [ccx]."""
import os
import pathlib
import re
import shutil
import subprocess

from common import DATA, skip

FOLDER = pathlib.Path(os.environ.get(
    "RITZ_SOLVERS", DATA.parent / "build/interop/solvers")).resolve()
NASTRAN95 = FOLDER / "nastran95/_data/bin/nastrn"
MYSTRAN = FOLDER / "mystran/_data/bin/mystran"
CALCULIX = os.environ.get("CCX", "ccx")


def need(*programs):
    """Skips the script if one of these is not there."""
    for program in programs:
        if not shutil.which(program):
            skip(f"there is no {program}: ./bootstrap interop installs it")


def need_calculix():
    need(CALCULIX)


def run(command, folder, log, seconds=300, **more):
    """Text that a program printed, which is kept in the file log too."""
    done = subprocess.run(command, cwd=folder, text=True, errors="replace",
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          timeout=seconds, **more)
    (pathlib.Path(folder) / log).write_text(done.stdout)
    return done.stdout


def run_nastran95(deck, folder):
    """Printed output; unit -14 of OUTPUT4 lands in deck.op4. Positive units are
    dense, and full columns end the program."""
    folder, stem = pathlib.Path(folder), pathlib.Path(deck).stem
    scratch = folder / (stem + ".scratch")
    scratch.mkdir(exist_ok=True)
    here = dict(os.environ, RFDIR=str(NASTRAN95.parents[1] / "rf"),
                DIRCTY=str(scratch), DBMEM="12000000", OCMEM="2000000",
                OPTPNM="none")
    for name in "LOGNM", "NPTPNM", "DICTNM", "PLTNM", "PUNCHNM":
        here[name] = str(folder / f"{stem}.{name[:-2].lower()}")
    for k in range(1, 11):
        here[f"SOF{k}"] = "none"
    for k in range(11, 24):
        here[f"FTN{k}"] = str(scratch / f"unit{k}")
    matrices = folder / (stem + ".op4")
    matrices.unlink(missing_ok=True)  # it opens no file that is there already
    here["FTN14"] = str(matrices)
    with open(folder / deck) as text:
        return run([NASTRAN95], folder, stem + ".out", stdin=text, env=here)


def run_mystran(deck, folder):
    """Text of deck.F06. Unit 21 of OUTPUT4 lands in deck.OU1."""
    run([MYSTRAN, deck], folder, pathlib.Path(deck).stem + ".out")
    found = pathlib.Path(folder) / (pathlib.Path(deck).stem + ".F06")
    return found.read_text(errors="replace") if found.exists() else ""


def run_calculix(deck, folder):
    """Printed output; deck is a file name without its ending .inp."""
    deck = pathlib.Path(deck)
    stem = deck.stem if deck.suffix == ".inp" else deck.name
    program = pathlib.Path(shutil.which(CALCULIX)).resolve()
    one = dict(os.environ, OMP_NUM_THREADS="1")
    return run([program, stem], folder, stem + ".out", env=one)


NUMBER = r"\s+([-+]?\d[-+.\dE]*)"
# a mode, its extraction order, eigenvalue, which may have a star, radians,
# cycles, and two more
REAL = re.compile(rf"^\s*\d+\s+\d+{NUMBER}\*?" + NUMBER * 4 + r"\s*$")
# a root, its extraction order, real and imaginary part, cycles, damping
COMPLEX = re.compile(r"^\s*\d+\s+\d+" + NUMBER * 4 + r"\s*$")


def rows_below(title, row, text, at):
    """Fields `at` of the rows below a title that is printed with spaces."""
    found = text.find(title)
    lines = text[found:].splitlines() if found >= 0 else []
    rows = [row.match(line) for line in lines]
    return [r.group(at) for r in rows if r]


def printed_hertz(text):
    """Frequencies of the table of real eigenvalues that NASTRAN-95 and MYSTRAN
    print, as text, in their order, which is ascending."""
    return rows_below("R E A L   E I G E N V A L U E S", REAL, text, 3)


def printed_complex_hertz(text):
    """Frequencies of NASTRAN-95's summary of complex eigenvalues."""
    return rows_below("E I G E N V A L U E   S U M M A R Y", COMPLEX, text, 3)
