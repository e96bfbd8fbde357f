#!/usr/bin/python3 -s
"""page.py - write docs/benchmarks.md from the last results of bench.py, in
build/bench/results.json; text() makes the same tables for a terminal."""
import json
import pathlib
import sys

from targets import NOT_ASKED

ROOT = pathlib.Path(__file__).resolve().parents[3]
RESULTS = ROOT / "build" / "bench" / "results.json"

# How many solves of eight right-hand sides block Lanczos takes for 50 modes to
# 1e-10, measured on solids and on plates; six more solve for 48 columns.
BLOCKS = {"S": 32, "P": 21}
COLUMN_BLOCKS = 6
DISTURBED = 0.05  # warn if others used more than this part of the processors
SWEEP_BYTES = 2 * 8  # a solve reads each entry of the factor twice

JOB_HEAD = ["program", "seconds", "least - most", "of processor", "peak MB",
            "residual", "eigenvalues", "at least", "limited by",
            "phases, seconds"]
TARGET_HEAD = ["#", "what", "model", "value", "limit", "stretch", "verdict",
               "from, or why not"]
MODEL_HEAD = ["model", "dofs", "entries of K", "of M", "of the factor",
              "its flops", "factor at least, s", "a block solve at least, s"]


def number(value, digits=3):
    """A number with `digits` digits, never as 1.2e+02."""
    if value is None:
        return ""
    if value == 0 or 1e-3 <= abs(value) < 1e5:
        text = f"{value:.{digits}g}"
        return f"{value:.0f}" if "e" in text else text
    return f"{value:.{digits - 1}e}"


def rates(result):
    """Floating-point operations and bytes read a second, on all cores; None if
    they were not measured."""
    limits = result.get("limits")
    if not limits:
        return None
    most = max(limits.values(), key=lambda found: found["threads"])
    return most["flops"], most["read"]


def work(result, model, job):
    """How many factors a job makes, and how often it reads one for a solve; None
    if that is not known."""
    said = result["runs"][model].get(job, {}).get("said", {})
    blocks = BLOCKS[model[0]] + COLUMN_BLOCKS
    if job.startswith("slepc"):
        return 1, said["solves"] + COLUMN_BLOCKS
    return {"basis": (2, blocks),
            "basis-no-count": (1, blocks),
            "basis-arpack": (2, blocks),
            "macneal-rubin": (2, blocks),
            "krylov": (1, 2 * COLUMN_BLOCKS)}.get(job)


def floor(result, model, job):
    """The least seconds that the job can take on this machine, and what limits
    it: its factors at the speed of dense products, and its solves at the speed
    at which memory is read."""
    facts, rate = result["models"][model], rates(result)
    if not rate or "factor_flops" not in facts or not work(result, model, job):
        return None, ""
    factors, solves = work(result, model, job)
    flops = factors * facts["factor_flops"] / rate[0]
    reading = solves * SWEEP_BYTES * facts["factor_entries"] / rate[1]
    part = 100 * flops / (flops + reading)
    return flops + reading, f"flops {part:.0f} %, memory {100 - part:.0f} %"


def job_rows(result, model):
    rows, missing = [], []
    for job, title in result["titles"].items():
        run = result["runs"][model].get(job)
        if run is None:
            continue
        if "wall" not in run:
            missing.append(f"{title} ({run['why']})")
            continue
        wall = run["wall"]
        phases = ", ".join(f"{name} {number(seconds)}" for name, seconds
                           in run.get("phases", {}).items())
        spread = (f"{number(wall['least'])} - {number(wall['most'])}"
                  if wall["runs"] > 1 else "one run")
        least, limited = floor(result, model, job)
        rows.append([title, number(wall["median"]), spread,
                     number(run["cpu"]["median"]),
                     number(run["peak"]["median"] / 1e6),
                     number(run.get("residual"), 2),
                     number(run.get("agreement"), 2),
                     number(least), limited, phases])
    return rows, missing


def merged(targets):
    """Join the rows of models that were not measured for the same reason. Rows
    of models that were not requested are left out if another model has the
    row."""
    asked = {row["what"] for row in targets if row["notes"] != NOT_ASKED}
    found = {}
    for row in targets:
        if row["notes"] == NOT_ASKED and row["what"] in asked:
            continue
        key = (row["number"], row["what"], row["verdict"], row["notes"],
               "" if row["verdict"] == "not measured" else row["model"])
        other = found.setdefault(key, row | {"model": None})
        other["model"] = ", ".join(filter(None, [other["model"],
                                                 row["model"]]))
    return found.values()


def target_rows(result):
    rows = []
    for row in merged(result["targets"]):
        least, most = row["at_least"], row["at_most"]
        sign = "≥ " if least is not None else "≤ "
        limit = row.get("limit", least if least is not None else most)
        rows.append([str(row["number"] or ""), row["what"], row["model"] or "",
                     number(row.get("value")),
                     sign + number(limit) if limit is not None else "",
                     sign + number(row["stretch"]) if row["stretch"] else "",
                     row["verdict"], row["notes"]])
    return rows


def model_rows(result):
    rows, rate = [], rates(result)
    for model, facts in result["models"].items():
        entries, flops = (facts.get(key) for key in
                          ("factor_entries", "factor_flops"))
        bound = entries and rate
        rows.append([model, str(facts["dofs"]), str(facts["entries_K"]),
                     str(facts["entries_M"]), number(entries), number(flops),
                     number(flops / rate[0]) if bound else "",
                     number(SWEEP_BYTES * entries / rate[1]) if bound else ""])
    return rows


def machine_lines(result):
    m = result["machine"]
    lines = [f"{m['processor']}, {m['cores']} cores, "
             f"{m['vector_bits']}-bit vectors, {m['memory'] / 2**30:.0f} GiB, "
             f"{m['system']}"]
    for part in result["parts"]:
        lines.append(
            f"{', '.join(part['models'])}{' --quick' * part['quick']}: "
            f"{part['date']}, commit {part['commit'] or 'unknown'}, medians of "
            f"{part['repeats']} runs or fewer, {part['seconds']:.0f} s in all")
        if part["others"] > DISTURBED:
            lines.append(f"DISTURBED: other programs took "
                         f"{100 * part['others']:.0f} % of the processors "
                         "meanwhile: trust no time of this run")
    for found in result.get("limits", {}).values():
        lines.append(
            f"{found['threads']} thread{'s' * (found['threads'] > 1)}: dense "
            f"products {found['flops'] / 1e9:.0f} GFlop/s, memory read "
            f"{found['read'] / 1e9:.0f} GB/s"
            + (f", used for the first time {found['first_use'] / 1e9:.1f} GB/s"
               if "first_use" in found else ""))
    lines.append(", ".join(f"{name} {version}" for name, version
                           in m["packages"].items()))
    return lines


def as_text(head, rows):
    """A table in columns as wide as their text; the last is not padded."""
    widths = [max(len(row[i]) for row in [head, *rows])
              for i in range(len(head))]
    return "\n".join("  ".join(cell.ljust(width) for cell, width
                               in zip(row, widths)).rstrip()
                     for row in [head, *rows])


def as_markdown(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def count_verdicts(result):
    found = [row["verdict"] for row in merged(result["targets"])]
    return ", ".join(f"{found.count(v)} {v}" for v in
                     ("stretch", "pass", "fail", "not measured", "stated")
                     if v in found)


def tables(result, draw):
    yield "Targets", draw(TARGET_HEAD, target_rows(result)), (
        count_verdicts(result) + ".")
    for model in result["runs"]:
        rows, missing = job_rows(result, model)
        yield model, draw(JOB_HEAD, rows), (
            "Not run: " + "; ".join(missing) + "." if missing else "")
    yield "Models and limits", draw(MODEL_HEAD, model_rows(result)), ""


def text(result):
    parts = ["\n".join(machine_lines(result))]
    for title, table, note in tables(result, as_text):
        parts.append("\n".join(filter(None, ["== " + title, table, note])))
    return "\n\n".join(parts)


PAGE = """# Benchmarks

Times of the tools and of other people's programs for the same job, on the same matrices, in the same run. `./bootstrap bench` measures them; `./bootstrap bench --page` then writes this page from the results in `build/bench/results.json`. No line of it is written by hand. The figures are those of one machine and promise nothing for another.

## How it is measured

- The models are solid blocks (S) and plates (P) of steel with two round holes, meshed with 8-node bricks and free in space; the number is roughly thousands of dofs. The interface has sixteen grids, 48 dofs. `tests/bench/speed/models.py` makes them.
- The job is Craig-Bampton: 50 modes with the interface held, to a residual of 1e-10, and the static response to each of 48 dofs. Another program solves only for the interior: it reads matrices in PETSc's binary format, projects nothing and writes nothing. The tools read a container and write one.
- Times are of whole processes. Each program runs once to warm up; then the runs of all programs and models are mixed in random order, and the median is shown. Programs that take long run once. Files are in memory (tmpfs). The tools get `RITZ_SYNC=0` and choose their threads; SLEPc runs with one rank of two threads and with two ranks of one, and the faster of both is compared.
- *Residual* is the largest |λ K⁻¹ M x - x| / |x| of the modes, computed by the harness with a factor of its own: by SuperLU with one step of refinement, for larger models by MUMPS. On a thin plate the rounding of any factor leaves 1e-10 to 1e-9. *Eigenvalues* is the largest relative difference from those of SLEPc; CalculiX makes its own matrices from the mesh and prints seven digits.
- *At least* is the time that this machine needs for the same work if nothing else takes time: the operations of the factor (as MUMPS counts them with METIS; two factors with a count) at the speed of dense products, and two readings of the factor for each solve at the speed of memory. For the tools, {solid} solves with blocks of eight vectors are assumed on solids and {plate} on plates, and {columns} more for the interface; for SLEPc the solves that it made, of one vector each. A factor that fits into the processor's cache is read faster. *Limited by* says how this time divides into the two.
- *Phases* of the tools are those that `--record` writes: seconds from each step that the library reports to the next of another kind. "factor" includes its packing for solves, "eigenvectors" their refinement and residuals.
- *Peak* is the memory of the largest process; for SLEPc by itself the sum over its ranks. Of that of a tool, some 14 MB do not depend on the model: 11 MB are pages of the program and its libraries that were read from their files, 2 MB buffers of the BLAS. On S10 this is a fifth of the peak.
- Memory that is *used for the first time* is cleared by the system, and a virtual machine may have to get it back from its host, to which it returns free memory after some seconds. All times include this: at 0.5 GB/s, 0.8 s of the 0.4 GB of `ritz-basis` on S50. Short jobs suffer most. In runs that follow each other within the second, `krylov-cms-fixed` and `macneal-rubin` come closer to the times of their pages.
- The rows numbered 13 time each tool but ritz-chart, ritz-claims and ritz on small data: these start gnuplot or other tools, whose time would be counted.
- *Verdict*: `pass` if the value is within the limit, `stretch` if it is also within the better figure of that column. If a tool does not have the option yet, the row names it; it is measured as soon as the tool has it. Models that were not requested are left out where another model has the row.

## The machine

{machine}

"""


def markdown(result):
    parts = [PAGE.format(
        solid=BLOCKS["S"], plate=BLOCKS["P"], columns=COLUMN_BLOCKS,
        machine="\n".join("- " + line for line in machine_lines(result)))]
    for title, table, note in tables(result, as_markdown):
        parts.append("\n\n".join(filter(None, ["## " + title, table, note]))
                     + "\n\n")
    return "".join(parts).rstrip() + "\n"


def main():
    if not RESULTS.exists():
        sys.exit("page.py: no build/bench/results.json: run ./bootstrap bench")
    out = ROOT / "docs" / "benchmarks.md"
    out.write_text(markdown(json.loads(RESULTS.read_text())), encoding="utf-8")
    print(f"wrote {out.relative_to(ROOT)}")


if __name__ == "__main__":
    main()
