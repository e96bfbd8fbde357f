#!/usr/bin/python3 -s
"""test.py FOLDER-OF-THE-TOOLS - test the harness: its models have the
properties that they should, its files can be read, its tables have all rows.
TAP."""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib

try:
    import h5py
    import numpy
    import scipy.sparse
except ImportError as missing:
    print("skipped:", missing)
    sys.exit(77)

import bench
import figures
import models
import output4
import page
import quality
import targets
from stopwatch import Failed, Stopwatch
from workshop import Workshop

HERE = pathlib.Path(__file__).resolve().parent
COUNTS, LENGTHS = (7, 6, 2), (0.7, 0.9, 0.1)
# sums of some thousand products, relative to the largest
ROUNDING = 1e-12
count = failed = 0


def check(holds, sentence, figure=""):
    global count, failed
    count += 1
    failed += not holds
    print("ok" if holds else "not ok", count, "-", sentence,
          f"# {figure}" if figure != "" else "")


def near(found, expected, sentence):
    error = abs(found / expected - 1)
    check(error < ROUNDING, sentence, f"{error:.1e}")


def check_solid():
    """Compare with closed forms of a block without holes."""
    block = models.make(COUNTS, LENGTHS, holes=0)
    volume, mass = numpy.prod(LENGTHS), models.RHO * numpy.prod(LENGTHS)
    x, y, z = block.position.T
    zero, one = numpy.zeros_like(x), numpy.ones_like(x)

    def motion(*parts):
        return numpy.stack(parts, axis=1).ravel()

    def energy(A, u):
        return u @ (A @ u)

    near(energy(block.M, motion(one, zero, zero)), mass,
         "mass of a block is density times volume")
    a, b = LENGTHS[:2]
    near(energy(block.M, motion(-y, x, zero)), mass * (a**2 + b**2) / 3,
         "inertia about an edge is m (a^2 + b^2) / 3")
    lame = (models.E * models.NU / ((1 + models.NU) * (1 - 2 * models.NU)))
    shear = models.E / (2 * (1 + models.NU))
    near(energy(block.K, motion(zero, y, zero)), (lame + 2 * shear) * volume,
         "energy of a uniform strain is (lambda + 2 mu) V")
    near(energy(block.K, motion(z, zero, zero)), shear * volume,
         "energy of a uniform shear is mu V")
    strained = abs(block.K).max()
    rigid = [motion(one, zero, zero), motion(zero, one, zero),
             motion(zero, zero, one), motion(-y, x, zero),
             motion(zero, -z, y), motion(z, zero, -x)]
    check(all(abs(block.K @ u).max() < ROUNDING * strained for u in rigid),
          "rigid motions strain nothing")


def check_holes():
    model = models.make((29, 15, 7), (0.8, 0.4, 0.2))
    check(model.K.shape == (10944, 10944) and len(model.port) == 48,
          "S10 has 10944 dofs, 48 at its interface")
    near(model.M[::3, ::3].sum(), models.RHO * 0.8 * 0.4 * 0.2
         * len(model.bricks) / (29 * 15 * 7), "holes take mass away")
    at = model.position[model.port[::3] // 3] / (0.8 / 29, 0.4 / 15, 0.2 / 7)
    check(sorted(map(tuple, at.round().astype(int).tolist()))
          == [(i, j, 0) for i in (1, 2, 27, 28) for j in (1, 2, 13, 14)],
          "the interface is four patches on the lower side")


def check_files(tools, folder):
    """Check that ritz-import reads the matrices that were made, bit for bit."""
    model = models.make(COUNTS, LENGTHS, holes=1)
    stem = folder / "block"
    models.write_grids(model, stem)
    for spelling, write in (("binary", output4.write),
                            ("text", output4.write_text)):
        write(stem.with_suffix(".op4"), K=model.K, M=model.M)
        subprocess.run(
            [tools / "ritz-import", "-q", "--stiffness", f"{stem}.op4:K",
             "--mass", f"{stem}.op4:M", "--bulk", f"{stem}.bdf", "--dofs",
             f"{stem}.dofs", "--port",
             f"face={stem.with_suffix('.port').read_text()}:123", "-o",
             f"{stem}.h5"], check=True)
        with h5py.File(f"{stem}.h5") as f:
            same = all((scipy.sparse.csc_matrix(
                (f[c]["data"], f[c]["indices"], f[c]["indptr"]),
                f[c].attrs["shape"]) != A).nnz == 0
                for c, A in (("K", model.K), ("M", model.M)))
            port = sorted(f["ports/face/dofs"][:].tolist())
        check(same and port == model.port.tolist(),
              f"{spelling} OUTPUT4 is imported to the bit, with its port")
    vectors = numpy.arange(6.0).reshape(3, 2)
    quality.write_pairs(folder / "pairs", numpy.array([1.0, 2.0]), vectors)
    values, found = quality.read_pairs(folder / "pairs")
    check((values == [1, 2]).all() and (found == vectors).all(),
          "pairs are read as they were written")


def check_residual():
    K = scipy.sparse.diags([[-1.0] * 9, [2.0] * 10, [-1.0] * 9],
                           [-1, 0, 1], format="csc")
    M = scipy.sparse.identity(10, format="csc")
    values, vectors = numpy.linalg.eigh(K.toarray())
    residual = quality.Residual(K, M)
    check(residual(values, vectors) < ROUNDING, "modes leave no residual")
    check(abs(residual(values * 1.001, vectors) - 1e-3) < 1e-9,
          "an eigenvalue that is 0.1 % wrong leaves 0.001")


def check_differences():
    check(quality.difference([1.0, 2.0], [2.0, 1.0 + 1e-9]) < 2e-9,
          "eigenvalues are compared in their order")
    check(quality.difference([1.0, 2.0], [1.0, 2.0, 3.0]) == float("inf"),
          "a list that ends early has lost a mode")
    check(quality.difference([1.0, 2.0], [1.0, 2.0, 3.0], 2) == 0.0,
          "modes beyond those requested need no partner")
    n = 6
    values = numpy.array([1.0, 2.0, 2.0, 3.0, 4.0, 5.0])
    M, X = scipy.sparse.identity(n, format="csc"), numpy.eye(n)
    turned = X.copy()
    turned[1:3, 1:3] = [[0.6, -0.8], [0.8, 0.6]]
    same = quality.subspaces(M, (values, X), (values, turned), [1e-12, 1e-12])
    check(same < 0.1, "a cluster may be turned in itself", same)
    turned[:, 0] += 1e-9 * X[:, 3]
    # gap (1 - 1/2) / 1, allowed 10 (1e-12 + 1e-12) / gap
    wrong = quality.subspaces(M, (values, X), (values, turned), [1e-12, 1e-12])
    check(abs(wrong / (1e-9 * 0.5 / 2e-11) - 1) < 1e-6,
          "an angle is held against ten times residual over gap", wrong)


def check_joined():
    """An earlier run is kept where the new one measured nothing."""
    def run(model, **jobs):
        return {"machine": {"processor": "p"}, "runs": {model: jobs},
                "figures": {}, "models": {model: {"dofs": 1}},
                "parts": [{"models": [model]}]}

    new, old = run("S10", basis=2), run("S10", basis=1, reduce=3)
    bench.join(new, old)
    check(new["runs"] == {"S10": {"basis": 2, "reduce": 3}}
          and len(new["parts"]) == 2, "--add keeps what is not measured again")


def check_tables():
    rows = targets.read()
    jobs = tomllib.loads((HERE / "jobs.toml").read_text())
    named = {name for row in figures.FIGURES for name in row[1]}
    named |= set(jobs) | {"factor_entries", "factor_flops", "dofs",
                          "entries_K", "entries_M"}
    used = {word for row in rows for word in re.findall("'([^']+)'",
                                                        row["value"])}
    check(used <= named, "targets name jobs and figures that exist",
          " ".join(sorted(used - named)))
    check({row["number"] for row in rows} == set(range(15)),
          "every row of targets is there")
    check(all(set(row.get("after", [])) | {row.get("beside", name)}
              <= set(jobs) for name, row in jobs.items()),
          "jobs name jobs that exist")
    check(all(set(row.get("models", [])) <= set(models.SHAPES)
              for row in [*jobs.values(), *rows] if row.get("models")),
          "tables name models that exist")


def check_verdicts():
    def judge(value, bits=512, **limits):
        return targets.judge(limits, value, bits)[0]

    check([judge(v, at_least=2.0, stretch=3.0) for v in (1.9, 2.0, 3.0)]
          == ["fail", "pass", "stretch"], "at least 2, stretch 3")
    check([judge(v, at_most=0.5, stretch=0.25) for v in (0.6, 0.5, 0.2)]
          == ["fail", "pass", "stretch"], "at most 0.5, stretch 0.25")
    check(judge(float("nan"), at_most=1.0) == "fail", "NaN fails")
    check([judge(1.7, bits, at_least=2.0, at_least_128_bit=1.6)
           for bits in (128, 256)] == ["pass", "fail"],
          "processors with short vectors have a limit of their own")


def check_page():
    """Make the page of a run of one model with one job and no peer."""
    one = {"median": 2.0, "least": 1.0, "most": 3.0, "runs": 3}
    facts = {"dofs": 3, "entries_K": 9, "entries_M": 3}
    result = {
        "machine": {"processor": "none", "vector_bits": 256, "cores": 2,
                    "memory": 2**30, "system": "", "packages": {}},
        "parts": [{"models": ["S10", "S50"], "quick": True, "repeats": 3,
                   "seconds": 1.0, "others": 0.5, "date": "", "commit": ""}],
        "limits": {},
        "titles": {"basis": "a basis", "krylov": "another"},
        "models": {"S50": facts, "S10": facts},
        "runs": {"S50": {}, "S10": {
            "basis": {"wall": one, "cpu": one, "peak": one, "said": {},
                      "residual": 1e-12},
            "krylov": {"wall": one | {"median": 0.5}}}},
        "figures": {}}
    result["targets"] = targets.evaluate(result)
    verdict = {(row["what"], row["model"]): row for row in result["targets"]}
    row = verdict["krylov-cms-fixed at equal columns, part of "
                  "Craig-Bampton's time", "S10"]
    check(row["value"] == 0.25 and row["verdict"] == "pass",
          "a formula is evaluated")
    check(all(row["verdict"] == "not measured" and row["notes"]
              for row in result["targets"] if row["model"] == "S150"),
          "what was not measured says why")
    rows = page.target_rows(result)
    check([row[2] for row in rows if row[0] == "3"]
          == ["S10, S50"],
          "models that were not measured for one reason share a row")
    check([row[2] for row in rows if row[0] == "4"]
          == ["S10, S50", "S10", "S50"]
          and [row[2] for row in rows if row[0] == "7"] == ["S150"] * 5,
          "a model not asked for has a row only if no other has")
    del result["runs"]["S10"]["krylov"]
    text = page.markdown(json.loads(json.dumps(result)))
    check("DISTURBED: other programs took 50 %" in text,
          "a page of a disturbed run says so")
    check("| a basis | 2 | 1 - 3 | 2 |" in text and "## Targets" in text,
          "the page has a table of the model")


def check_stopwatch():
    held = bytearray(150_000_000)
    stopwatch = Stopwatch()
    try:
        done = stopwatch(["sh", "-c", "echo word"], {"PATH": "/usr/bin:/bin"},
                         "/")
        check(done["out"] == "word\n" and done["wall"] > 0.0,
              "a process is timed and heard")
        check(done["peak"] < len(held) / 2,
              "its peak memory is its own, not the harness's", done["peak"])
        for words, limit, expected in (
                (["sh", "-c", "echo why >&2; exit 3"], 9.0, "status 3: why"),
                (["sleep", "9"], 0.05, "took more than 0.05 s"),
                (["no-such-program"], 9.0, "no-such-program: No such file")):
            try:
                stopwatch(words, {"PATH": "/usr/bin:/bin"}, "/", limit)
                why = "done"
            except Failed as reason:
                why = str(reason)
            check(why.startswith(expected), f"a failure says why: {expected}",
                  why)
    finally:
        stopwatch.close()


def check_records():
    """A run that fails leaves its record, which a further run would append to."""
    def run_tool(command, environment, folder, limit):
        with open(command[-1], "a") as record:
            print('{"phases": {"reading": 1.5}}', file=record)
        if "fails" in command:
            raise Failed("status 1: why")
        return {}

    with tempfile.TemporaryDirectory() as folder:
        shop = Workshop.__new__(Workshop)
        shop.folder = shop.bin = pathlib.Path(folder)
        shop.limit, shop.stopwatch, shop.programs = 9.0, run_tool, {}
        shop.jobs = {word: {"command": f"ritz-basis {word}"}
                     for word in ("fails", "works")}
        try:
            shop.run("fails", "S10")
        except Failed:
            pass
        phases = shop.run("works", "S10")["said"]["phases"]
    check(phases == {"reading": 1.5}, "phases are those of a run that worked")


def main():
    tools = pathlib.Path(sys.argv[1]).resolve()
    check_solid()
    check_holes()
    with tempfile.TemporaryDirectory() as folder:
        check_files(tools, pathlib.Path(folder))
    check_residual()
    check_differences()
    check_joined()
    check_tables()
    check_verdicts()
    check_page()
    check_stopwatch()
    check_records()
    print(f"1..{count}")
    sys.exit(1 if failed else 0)


main()
