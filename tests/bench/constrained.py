#!/usr/bin/python3 -s
"""constrained.py FOLDER-OF-THE-TOOLS [--chart FILE.svg] - methods that hold
constraints over time, on data/dualspin at clock = 60. Prints the tables of
docs/methods/constraints-in-time.md, and draws its chart.

Errors are against exact propagation of the eliminated system. Status 1 if an
order is off (ten times the stiffness gives a tenth of the violation, a tenth of
the step a hundredth of the error), or if a step costs more than four times (of
hybrid six times) that of the eliminated system by the same integrator.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import caged  # noqa: E402
import methods  # noqa: E402

SECONDS, STEP = 2.0, 1e-3
METHODS = ("none", "baumgarte", "sliding-mode", "penalty", "hybrid",
           "projection", "index-2")


class Bench:
    """Runs of one scene in a folder."""

    def __init__(self, bin_, folder):
        self.bin, self.folder = bin_, folder
        (folder / "build").mkdir()
        caged.bodies(bin_, folder / "build")
        text = (methods.DATA / "dualspin" / "scene.yaml").read_text()
        (folder / "scene.yaml").write_text(text)

    def run(self, name, *words, step=STEP, seconds=SECONDS, every=0,
            start=None):
        """Outputs, diagnostics or None, and the report of a run."""
        drive = ["--initial", "mode:10*0.01", "--start-digits", start] \
            if start else ["--input", "torque_rotor=sine:2"]
        every = every or max(round(STEP / step), 1)
        done = subprocess.run(
            [self.bin / "ritz-simulate", "scene.yaml", "--at",
             "clock=60,cone=0", "--seconds", str(seconds), "--step", str(step),
             "--every", str(every), *map(str, drive), *words, "--json", "-o",
             f"{name}.h5"], cwd=self.folder, capture_output=True, text=True,
            check=True)
        with h5py.File(self.folder / f"{name}.h5") as file:
            values = file.get("diagnostics/values")
            return (file["y"][:], None if values is None else values[:],
                    json.loads(done.stdout))


def error(found, exact):
    return float((abs(found - exact).max(axis=0)
                  / abs(exact).max(axis=0)).max())


def table_of_methods(bench, exact, least):
    """Print errors and costs of each method; return True if one is off."""
    print(f"| method | integrator | error at {STEP * 1e3:g} ms | at "
          f"{STEP * 1e2:g} ms | violation | highest, Hz | explicit step below, "
          "ms | a step, us |")
    print("|---|---|---|---|---|---|---|---|")
    wrong = False
    for method in METHODS:
        for integrator in (("generalised-alpha",) if method == "index-2" else
                           ("trapezoidal", "central-difference")):
            gains = ":hz=95" if method in ("penalty", "hybrid") else ""
            words = ("--constraints", method + gains, "--method", integrator)
            y, off, told = bench.run("run", *words)
            fine, _, _ = bench.run("run", *words, step=STEP / 10)
            facts = told["constraints"]
            errors = error(y, exact), error(fine, exact)
            springs = method in ("penalty", "hybrid")
            most = 6 if method == "hybrid" else 4
            wrong |= facts["step_cost"] > most * least[integrator]
            wrong |= not springs and not 80 < errors[0] / errors[1] < 125
            print(f"| {method}{gains} | {integrator} | {errors[0]:.1e} | "
                  f"{errors[1]:.1e} | {off[:, 0].max():.1e} | "
                  f"{facts['highest_hz']:.4g} | "
                  f"{facts['step_limit'] * 1e3:.3g} | "
                  f"{facts['step_cost'] * 1e6:.2g} |")
    return wrong


def table_of_springs(bench, exact):
    """Print what stiffness and inertia do; return True if an order is off."""
    print("\n| penalty, hz | inertia | violation | error of the output | "
          "highest, Hz | explicit step below, ms |")
    print("|---|---|---|---|---|---|")
    last, wrong = None, False
    for k in range(5):
        hz = 300 * 10 ** (k / 2)
        for inertia in (0, 9, 99) if k == 0 else (0,):
            y, off, told = bench.run(
                "run", "--constraints", f"penalty:hz={hz},inertia={inertia}",
                step=STEP / 50)
            most, facts = off[:, 0].max(), told["constraints"]
            if inertia == 0:
                wrong |= last is not None and not 8 < last / most < 13
                last = most
            print(f"| {hz:.4g} | {inertia} | {most:.1e} | "
                  f"{error(y, exact):.1e} | {facts['highest_hz']:.4g} | "
                  f"{facts['step_limit'] * 1e3:.3g} |")
    return wrong


def eliminated(bench):
    """Processor seconds of a step of the joined system, by name."""
    told = methods.run(bench.bin, "ritz-simulate", bench.folder / "scene.yaml",
                       "--at", "clock=60,cone=0", "--cost")
    return {i["name"]: i["seconds_per_second"] * i["step"]
            for i in told["integrators"]}


def drift(bench, chart):
    """Print violations over 4 s after a start rounded to four digits."""
    runs = [("none", "none", 2e-3), ("baumgarte-2", "baumgarte:alpha=2,beta=2",
                                     2e-3),
            ("baumgarte-10", "baumgarte:alpha=10,beta=10", 2e-3),
            ("baumgarte-10-20ms", "baumgarte:alpha=10,beta=10", 2e-2),
            ("sliding-mode", "sliding-mode:surface=10", 2e-3),
            ("penalty-30", "penalty:hz=30", 2e-3),
            ("penalty-95", "penalty:hz=95", 2e-3),
            ("projection", "projection", 2e-3)]
    print("\n| run | violation at 0 s | at 1 s | at 4 s |")
    print("|---|---|---|---|")
    for name, words, step in runs:
        _, off, _ = bench.run(name, "--constraints", words, step=step,
                              seconds=4.0, every=round(0.02 / step), start=4)
        at = [off[round(t / 0.02), 0] for t in (0.0, 1.0, 4.0)]
        print(f"| {name} | " + " | ".join(f"{x:.1e}" for x in at) + " |")
    if chart:
        methods.run(bench.bin, "ritz-chart", "diagnostics",
                    *(bench.folder / f"{name}.h5" for name, _, _ in runs),
                    "-o", chart)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("--chart", type=pathlib.Path)
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(asked.bin.resolve(), pathlib.Path(folder))
        exact, _, _ = bench.run("exact", step=STEP / 100)
        least = eliminated(bench)
        wrong = table_of_methods(bench, exact, least)
        print("\na step of the joined system: " + ", ".join(
            f"{name} {cost * 1e6:.2g} us" for name, cost in least.items()))
        wrong |= table_of_springs(bench, exact)
        drift(bench, asked.chart and asked.chart.resolve())
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
