#!/usr/bin/python3 -s
"""bench.py FOLDER-OF-THE-TOOLS [--quick] - measure the tools and other people's
programs on the same matrices in one run: seconds of whole processes, memory,
residuals, differences of eigenvalues; and compare with targets.toml.

Results are written to build/bench/results.json, tables to standard output.
page.py makes docs/benchmarks.md from the results. The status is 0 even if
targets are missed.
"""
import argparse
import json
import os
import pathlib
import shutil
import signal
import sys
import tempfile

# of the harness itself; before NumPy is loaded, which reads it
os.environ["OMP_NUM_THREADS"] = "1"

import figures
import machine
import models
import page
import quality
import rounds
import targets
from stopwatch import Failed, Stopwatch
from workshop import ROOT, USUAL, Workshop, say


def measure_figures(shop):
    found = {}
    for function, names, usual, quick in figures.FIGURES:
        for model in quick if shop.quick else usual:
            if (model and model not in shop.models) or not shop.wants(
                    function.__name__):
                continue
            say(shop, model, function.__name__)
            try:
                figure = function(shop, model)
            except (Failed, quality.Unknown) as reason:
                figure = {name: {"why": str(reason)} for name in names}
            found.setdefault(model, {}).update(figure)
    return found


def measure_in(shop, folder, result):
    shop.folder = pathlib.Path(folder)
    result["limits"] = machine.limits(shop, result["machine"]["cores"])
    for model in shop.models:
        say(shop, model, "is made")
        shop.make_model(model)
    timing = rounds.Timing(shop)
    timing.first()
    result["figures"] = measure_figures(shop)
    timing.others()
    result["runs"] = timing.finish()
    result["models"] = shop.facts
    for model, runs in result["runs"].items():
        say(shop, model, "residuals and eigenvalues")
        quality.measure(shop, model, runs)


def measure(shop):
    others = machine.Others(shop.stopwatch)
    shop.prepare()
    result = {"machine": machine.describe(ROOT),
              "titles": {job: row["title"] for job, row in shop.jobs.items()}}
    try:
        with tempfile.TemporaryDirectory(
                prefix="ritz-bench-", dir=folder_in_memory()) as folder:
            measure_in(shop, folder, result)
    finally:
        shutil.rmtree(shop.disk, ignore_errors=True)
    result["parts"] = [{
        "models": shop.models, "quick": shop.quick,
        "repeats": max(shop.repeats, 1), "seconds": shop.elapsed(), "others": others.part(),
        "date": result["machine"].pop("date"),
        "commit": result["machine"].pop("commit")}]
    return result


def join(result, earlier):
    """Add what an earlier run on the same machine measured of other models, and
    of jobs and figures that this run left out."""
    if earlier["machine"]["processor"] != result["machine"]["processor"]:
        sys.exit("bench.py: --add: the last run was on another processor")
    for key in ("runs", "figures", "models"):
        for model, found in earlier[key].items():
            result[key][model] = found | result[key].get(model, {})
    result["parts"] = earlier["parts"] + result["parts"]


def folder_in_memory():
    """A folder in tmpfs if the models fit there, else in TMPDIR."""
    shared = pathlib.Path("/dev/shm")
    if shared.is_dir() and shutil.disk_usage(shared).free > 4e9:
        return shared
    return None


def words(text):
    return text.split(",")


def main():
    parser = argparse.ArgumentParser(
        prog="./bootstrap bench", usage="%(prog)s [OPTION]...",
        description="The tools beside other programs, and their targets.")
    parser.add_argument("tools", help=argparse.SUPPRESS)
    parser.add_argument("--quick", action="store_true",
                        help="S10 and P50, SLEPc and SciPy; five minutes")
    parser.add_argument("--models", type=words, metavar="NAME[,NAME]",
                        help="of " + ", ".join(models.SHAPES)
                        + " [" + ",".join(USUAL) + "]")
    parser.add_argument("--repeats", type=int, metavar="N",
                        help="rounds after the first, 5; 3 of --quick; 0: "
                        "the first one counts")
    parser.add_argument("--only", type=words, metavar="NAME[,NAME]",
                        help="these rows of tests/bench/speed/jobs.toml and "
                        "functions of figures.py [all]")
    parser.add_argument("--limit", type=float, default=3600.0,
                        metavar="SECONDS",
                        help="a process that takes longer is stopped [3600]")
    parser.add_argument("--add", action="store_true",
                        help="keep what the last run measured of other models "
                        "and rows")
    arguments = parser.parse_args()
    if set(arguments.models or []) - set(models.SHAPES):
        parser.error("models are " + ", ".join(models.SHAPES))
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    stopwatch = Stopwatch()
    try:
        result = measure(Workshop(arguments, stopwatch))
    except KeyboardInterrupt:
        sys.exit(130)
    finally:
        stopwatch.close()
    if arguments.add and page.RESULTS.exists():
        join(result, json.loads(page.RESULTS.read_text()))
    result["targets"] = targets.evaluate(result)
    page.RESULTS.write_text(json.dumps(result, indent=1) + "\n")
    print(page.text(result))


if __name__ == "__main__":
    main()
