#!/usr/bin/python3 -s
"""methods.py FOLDER-OF-THE-TOOLS [--solid N] - every method on every data set
it fits, at equal order: the tables of docs/methods/errors.md, on standard output.

Each component is reduced by each method to the same number of columns, as near
as its blocks and clusters allow, and measured by ritz-verify against the full
model up to its fifth flexible mode. --solid N adds a block of N x N x N bricks
(25: 52 728 dofs), which takes most of an hour. Files of others come from
RITZ_EXTERNAL_DATA; where one is absent its table is left out, and said so.
"""
import argparse
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy
import scipy.io
import scipy.sparse

HERE = pathlib.Path(__file__).resolve().parent
DATA = HERE.parent.parent / "data"
EXTERNAL = pathlib.Path(os.environ.get(
    "RITZ_EXTERNAL_DATA", HERE.parent.parent.parent / "shared" / "data"))

# How a method is asked for an order: "modes" by their number, "interface" by
# nothing, its order being that of the attached dofs, "measured" by as many modes
# as there are of those; and what else it is told.
METHODS = [
    ("guyan", "interface", []),
    ("irs", "interface", []),
    ("serep", "measured", []),
    ("craig-bampton", "modes", []),
    ("krylov-cms-fixed", "modes", []),
    ("macneal-rubin", "modes", []),
    ("rubin", "modes", []),
    ("macneal", "modes", []),
    ("inertia-relief", "modes", []),
    ("krylov-cms-free", "modes", []),
    ("normal-modes", "modes", ["--loads", "inputs"]),
    ("krylov", "modes", ["--loads", "inputs,outputs"]),
    ("krylov-damped", "modes", ["--loads", "inputs,outputs"]),
    ("tangential", "modes", ["--loads", "inputs,outputs"]),
]


class Refused(Exception):
    """What a tool said."""


def run(bin_, *words):
    """One tool with --json, its object."""
    done = subprocess.run([bin_ / words[0], *map(str, words[1:]), "--json"],
                          capture_output=True, text=True)
    if done.returncode not in (0, 1) or not done.stdout.strip():
        raise Refused(done.stderr.strip().splitlines()[0])
    answer = json.loads(done.stdout)
    if done.returncode == 1:
        raise Refused(answer.get("error", "it failed"))
    return answer


def write(folder, name, A):
    """A matrix that ritz-import reads."""
    path = folder / f"{name}.mtx"
    scipy.io.mmwrite(path, scipy.sparse.coo_matrix(A), symmetry="symmetric",
                     precision=17)
    return path


def rows(folder, name, count, directions="0"):
    """What --dofs reads."""
    path = folder / f"{name}.dofs"
    path.write_text("".join(f"{k} {d}\n" for k in range(1, count + 1)
                            for d in directions))
    return path


def abaqus(path):
    """`row col value` lines, both triangles, no header."""
    t = numpy.loadtxt(path)
    A = scipy.sparse.coo_matrix((t[:, 2], (t[:, 0].astype(int) - 1,
                                           t[:, 1].astype(int) - 1)))
    return (A + A.T) / 2


def lund(external, folder, _):
    """Grounded, no geometry."""
    p = external / "pairs/lund"
    return dict(order=16, options=[
        "--stiffness", p / "lund_a.mtx", "--mass", p / "lund_b.mtx",
        "--dofs", rows(folder, "lund", 147), "--port", "ends=1,40,80,147:0",
        "--input", "in=20:0", "--output-at", "out=120:0"])


def lf10(external, folder, _):
    """A damped beam, the model's own input and output."""
    p = external / "second_order/LF10"
    return dict(order=8, damping=None, options=[
        "--stiffness", p / "K.mtx", "--mass", p / "M.mtx", "--damping",
        p / "D.mtx", "--dofs", rows(folder, "lf10", 18), "--port",
        "ends=1,18:0", "--input", "in=9:0", "--output-at", "out=9:0"])


def block(external, folder, _):
    """A free solid of quadratic tetrahedra."""
    p = external / "abaqus"
    K = abaqus(p / "blockC3D10_STIF1.mtx")
    M = abaqus(p / "blockC3D10_MASS1.mtx")
    n = K.shape[0] // 3
    return dict(order=40, options=[
        "--stiffness", write(folder, "block.k", K), "--mass",
        write(folder, "block.m", M), "--dofs", rows(folder, "block", n, "123"),
        "--port", "face=1,2,3,4:123", "--input", f"in={n}:1", "--output-at",
        f"out={n // 2}:1"])


def rotor(external, folder, _):
    """A free rotor with double roots."""
    p = external / "ansys"
    return dict(order=40, options=[
        "--stiffness", p / "rotorAnsysStiffnessMatrixSparse.txt", "--mass",
        p / "rotorAnsysMassMatrixSparse.txt", "--dofs",
        rows(folder, "rotor", 115, "123"), "--port", "disc=10,60,100:123",
        "--input", "in=40:1", "--output-at", "out=41:1"])


def nas2cam(external, folder, _):
    """A free frame of a spacecraft."""
    p = external / "nastran/public_solvers"
    return dict(order=48, options=[
        "--stiffness", f"{p}/nastran95_outboard.op4:KGG", "--mass",
        f"{p}/nastran95_outboard.op4:MGG", "--bulk",
        p / "nastran95_outboard.deck", "--port", "frame=3,11,19,27",
        "--input", "in=1:3", "--output-at", "out=2:3"])


def dualspin(part, order, place):
    """A component of the demonstration."""

    def make(external, folder, _):
        p = DATA / "dualspin"
        return dict(order=order, options=[
            "--stiffness", f"{p}/{part}.op4:KGG", "--mass",
            f"{p}/{part}.op4:MGG", "--bulk", p / f"{part}.bdf", "--port",
            "bearing=1", "--input", f"in={place}:3", "--output-at",
            f"out={place}:3"])
    make.__doc__ = f"The {part} of the demonstration, free."
    return make


def truss(external, folder, _):
    """The plane truss of 72 dofs, free."""
    p = DATA / "truss72"
    return dict(order=18, options=[
        "--stiffness", p / "truss72.k.mtx", "--mass", p / "truss72.m.mtx",
        "--bulk", p / "truss72.bdf", "--dofs", p / "truss72.dofs", "--port",
        "ends=1,2:12", "--input", "in=36:2", "--output-at", "out=35:2"])


def solid(external, folder, n):
    """A free block of bricks, its port a patch of 4 x 4 grids."""
    subprocess.run([sys.executable, "-s", HERE / "brick.py", *3 * [str(n)], folder],
                   check=True, capture_output=True)
    port = ",".join(str(j * (n + 1) + k) for j in range(4)
                    for k in range(1, 5))
    points = ",".join(f"{50 * k}" for k in range(1, 17))
    return dict(order=110, given={"tangential": (38, points)}, options=[
        "--stiffness", folder / "K.mtx", "--mass", folder / "M.mtx", "--bulk",
        folder / "grids.bdf", "--dofs", folder / "dofs.txt", "--port",
        f"face={port}", "--input", f"in={(n + 1)**3}:1", "--output-at",
        f"out={(n + 1)**3}:2"])


SETS = [
    ("lund", lund, "pairs/lund/lund_a.mtx"),
    ("LF10", lf10, "second_order/LF10/K.mtx"),
    ("truss72", truss, None),
    ("blockC3D10", block, "abaqus/blockC3D10_STIF1.mtx"),
    ("rotorAnsys", rotor, "ansys/rotorAnsysMassMatrixSparse.txt"),
    ("nas2cam outboard", nas2cam,
     "nastran/public_solvers/nastran95_outboard.op4"),
    ("dual-spin rotor", dualspin("rotor", 40, 61), None),
    ("dual-spin stator", dualspin("stator", 24, 7), None),
]


def parser_of(doc):
    """A parser of what all benchmarks are told."""
    parser = argparse.ArgumentParser(description=doc.splitlines()[0])
    parser.add_argument("bin", type=lambda word: pathlib.Path(word).resolve())
    parser.add_argument("--only", help="one data set")
    return parser


def some_methods(names):
    """Those of METHODS that are named; all, if none are."""
    return [m for m in METHODS if not names or m[0] in names]


def cases(bin_, only=None, n=0, most=None, absent=lambda name: None):
    """Each data set that is there, imported into a folder that goes away.

    Not those of more dofs than `most`; n is for the solid. A case says what it
    is called, its component, how many modes are rigid and what band to look at.
    """
    for name, make, needs in SETS + ([("solid", solid, None)] if n else []):
        if only not in (None, name):
            continue
        if needs and not (EXTERNAL / needs).exists():
            absent(name)
            continue
        with tempfile.TemporaryDirectory() as place:
            folder = pathlib.Path(place)
            case = make(EXTERNAL, folder, n)
            case.update(name=name, about=make.__doc__, folder=folder,
                        component=folder / "component.h5")
            run(bin_, "ritz-import", *case["options"], "-o", case["component"])
            case["dofs"] = run(bin_, "ritz-info", case["component"])["dofs"]
            if most and case["dofs"] > most:
                continue
            case["band"], case["rigid"] = band_of(bin_, case["component"],
                                                  folder)
            yield case


def left_out(name):
    """In place of a table."""
    print(f"\n## {name}\n\nleft out: no external data")


def refused(method, sentence, more):
    """Print a refusal in place of a line of a table; `more` cells are empty."""
    text = str(sentence).split(": ", 1)[-1]
    print(f"| {method} | refused: {text} |" + " |" * more, flush=True)


def make_basis(bin_, method, how, more, component, order, rigid, out):
    """A basis as near to the order as the method allows, and its columns."""
    words = ["ritz-basis", method, *more, component, "-o", out]
    if how == "interface":
        return run(bin_, *words)["vectors"]
    if how == "measured":
        order = run(bin_, "ritz-basis", "guyan", component, "-o",
                    out)["vectors"]
    modes, seen = (order - rigid if how == "measured" else order), {}
    for _ in range(4):
        seen[modes] = run(bin_, *words, "--modes", modes)["vectors"]
        if seen[modes] == order or modes + order - seen[modes] in seen:
            break
        modes = max(0, modes + order - seen[modes])
        if modes in seen:
            break
    return seen[list(seen)[-1]]


def band_of(bin_, component, folder):
    """A little above the fifth flexible mode, Hz; how many are rigid."""
    f = run(bin_, "ritz-basis", "macneal-rubin", "--attach", "", "--modes", 6,
            component, "-o", folder / "modes.h5")["frequencies_hz"]
    flexible = [x for x in f if x > 0]
    five = flexible[:5]
    above = [x for x in flexible if x > 1.001 * five[-1]]
    return (math.sqrt(five[-1] * (above[0] if above else 1.1 * five[-1])),
            len(f) - len(flexible))


def measure(bin_, case, method, how, more):
    """One line of a table."""
    folder, component, order = case["folder"], case["component"], case["order"]
    basis, reduced = folder / "basis.h5", folder / "reduced.h5"
    if method in case.get("given", {}):
        order, points = case["given"][method]
        more = [*more, "--shift-hz", points]
    start = time.monotonic()
    order = make_basis(bin_, method, how, more, component, order,
                       case["rigid"], basis)
    seconds = time.monotonic() - start
    run(bin_, "ritz-reduce", component, basis, "-o", reduced)
    words = ["ritz-verify", component, reduced, "--band-hz",
             f"0,{case['band']:.9g}", "-o", folder / "verified.h5"]
    if case.get("damping", 1):
        words += ["--damping", "modal 0.01"]
    found = {m["name"]: m["value"] for m in run(bin_, *words)["measures"]}
    return order, seconds, found


HEAD = """# How wrong each method is

The tables have the errors of every method on every data set to which it applies. Each model is reduced to the number of columns requested, or to as many as the method can have, and `ritz-verify` compares it with the full model up to its fifth flexible mode (damping `modal 0.01` where the model states none). The page is made by

    /usr/bin/python3 -s tests/bench/methods.py build/release/bin --solid 25 >docs/methods/errors.md

| column | meaning |
|---|---|
| missing | modes of the band without a pair in the reduced model (MAC below one half) |
| frequency, 1 - MAC, damping | the worst of the other modes; an error of 1 - MAC of 1 is a mode that is missing |
| response | from an input inside to an output inside: largest error over the largest response in the band, which for a free body is that of its rigid motion |
| static gain | of the flexible part, relative |

An empty field means that nothing could be compared.

What the tables show:

- Free-interface modes are best for the modes of a free body: macneal-rubin, rubin, macneal and inertia-relief span the same subspace and have these modes to rounding. Their static responses are exact at the port only: for an input elsewhere the static gain is inaccurate. normal-modes and krylov, which are given the inputs, have it to rounding.
- Craig-Bampton at equal order is less accurate by some digits where nothing holds the interface, as is the case for all components here. It is more accurate when neighbours are stiff.
- Krylov methods have accurate responses and gains where the same number of modes has not. They lose high modes that are not controllable from any load; for responses to these loads that is an advantage.
- guyan, irs and serep have no more columns than the port has dofs.
- The static gain leaves out as many of the lowest modes as the full model has rigid ones. A rigid motion that guyan or irs represent badly is therefore not taken for a compliance.

On the solid of 52 728 dofs tangential is given its expansion points, 50 to 800 Hz in steps of 50 Hz, and 38 columns. It needs a complex factor for each point, four minutes of processor time. Its own search for points factors one matrix for every other column in each of up to 50 rounds. It was stopped after 52 minutes of processor time with 10 columns requested, so it is not practical for such a body.

Methods that are not in the tables: `loaded-interface`, which needs neighbours; `dual-craig-bampton`, which for a single body is macneal-rubin; the Lanczos methods, whose models are state spaces; `rigid` and `full`."""

COLUMNS = [("missing-modes", "missing"), ("frequency-relative", "frequency"),
           ("mac", "1 - MAC"),
           ("damping-relative", "damping"), ("response-relative", "response"),
           ("static-gain-relative", "static gain")]


def cell(name, found):
    """A number of a table."""
    value = found.get(name)
    if value is None:
        return ""
    if name == "missing-modes":
        return f"{value:.0f}"
    return f"{1 - value if name == 'mac' else value:.1e}"


def table(bin_, case, names):
    """All methods on one data set."""
    print(f"\n## {case['name']}\n\n{case['about']} {case['dofs']} dofs, asked "
          f"for {case['order']} columns, measured up to {case['band']:.4g} "
          "Hz.\n")
    print("| method | columns | " + " | ".join(c for _, c in COLUMNS) + " |")
    print("|---|" + "---|" * (len(COLUMNS) + 1), flush=True)
    for method, how, more in some_methods(names):
        try:
            order, _, found = measure(bin_, case, method, how, more)
            cells = [cell(key, found) for key, _ in COLUMNS]
            print(f"| {method} | {order} | " + " | ".join(cells) + " |",
                  flush=True)
        except Refused as sentence:
            refused(method, sentence, len(COLUMNS))


def main():
    """Parse and run."""
    parser = parser_of(__doc__)
    parser.add_argument("--solid", type=int, default=0)
    parser.add_argument("--methods", type=lambda word: word.split(","),
                        help="some methods, with commas between")
    asked = parser.parse_args()
    if not asked.only:
        print(HEAD)
    for case in cases(asked.bin, asked.only, asked.solid, absent=left_out):
        table(asked.bin, case, asked.methods)


if __name__ == "__main__":
    main()
