#!/usr/bin/python3 -s
"""page.py - docs/benchmarks.md of the last results of bench.py, in
build/bench/results.json; text() is the same tables for a terminal."""
import json
import pathlib
import sys

from targets import NOT_ASKED

ROOT = pathlib.Path(__file__).resolve().parents[3]
RESULTS = ROOT / "build" / "bench" / "results.json"

# Blocks of eight right-hand sides that block Lanczos needs for 50 modes to
# 1e-10: measured on solids and on plates. Six more are 48 columns.
BLOCKS = {"S": 32, "P": 21}
COLUMN_BLOCKS = 6
DISTURBED = 0.05  # of the processors, by others
SWEEP_BYTES = 2 * 8  # forward and backward, an entry of the factor each

JOB_HEAD = ["program", "seconds", "least - most", "of processor", "peak MB",
            "residual", "eigenvalues", "at least", "phases, seconds"]
TARGET_HEAD = ["#", "what", "model", "value", "limit", "stretch", "verdict",
               "from, or why not"]
MODEL_HEAD = ["model", "dofs", "entries of K", "of M", "of the factor",
              "its flops", "factor at least, s", "a block solve at least, s"]


def number(value, digits=3):
    """As short as `digits` figures allow, without 1.2e+02."""
    if value is None:
        return ""
    if value == 0 or 1e-3 <= abs(value) < 1e5:
        text = f"{value:.{digits}g}"
        return f"{value:.0f}" if "e" in text else text
    return f"{value:.{digits - 1}e}"


def rates(result):
    """Operations and bytes a second on all cores; None if not measured."""
    limits = result.get("limits")
    if not limits:
        return None
    most = max(limits.values(), key=lambda found: found["threads"])
    return most["flops"], most["read"]


def floor(result, model, job):
    """Seconds below which no program gets that factors once (twice with a
    count) at the speed of products and solves at that of memory."""
    facts, rate = result["models"][model], rates(result)
    if not rate or "factor_flops" not in facts:
        return None
    factor = facts["factor_flops"] / rate[0]
    sweep = SWEEP_BYTES * facts["factor_entries"] / rate[1]
    said = result["runs"][model].get(job, {}).get("said", {})
    blocks = BLOCKS[model[0]] + COLUMN_BLOCKS
    if job == "basis":
        return 2 * factor + blocks * sweep
    if job in ("basis-no-count", "basis-arpack"):
        return factor + blocks * sweep
    if job.startswith("slepc"):
        return factor + (said["solves"] + COLUMN_BLOCKS) * sweep
    return None


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
        rows.append([title, number(wall["median"]), spread,
                     number(run["cpu"]["median"]),
                     number(run["peak"]["median"] / 1e6),
                     number(run.get("residual"), 2),
                     number(run.get("agreement"), 2),
                     number(floor(result, model, job)), phases])
    return rows, missing


def merged(targets):
    """Rows that were not measured for one reason become one; a model that was
    not asked for has none beside one that was."""
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
             f"{m['system']}",
             f"{m['date']}, commit {m['commit'] or 'unknown'}",
             ("--quick: " if result["quick"] else "")
             + f"medians of {result['repeats']} runs or fewer, "
             f"{result['seconds']:.0f} s in all"]
    if result["others"] > DISTURBED:
        lines.append(f"DISTURBED: other programs took "
                     f"{100 * result['others']:.0f} % of the processors "
                     "meanwhile: trust no time of this run")
    for found in result.get("limits", {}).values():
        lines.append(
            f"{found['threads']} thread{'s' * (found['threads'] > 1)}: dense "
            f"products {found['flops'] / 1e9:.0f} GFlop/s, memory read "
            f"{found['read'] / 1e9:.0f} GB/s")
    lines.append(", ".join(f"{name} {version}" for name, version
                           in m["packages"].items()))
    return lines


def as_text(head, rows):
    """Columns as wide as they need; the last is left free."""
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

How fast the tools are beside other people's programs, on the same matrices, in the same run. `./bootstrap bench` measures this; `./bootstrap bench --page` then writes this page from the results in `build/bench/results.json`. Nothing here is written by hand, and no figure is a promise: another machine has others.

## How it is measured

- The models are solid blocks (S) and plates (P) of steel with two round holes, of 8-node bricks, free in space; the number is thousands of dofs, roughly. Their interface is sixteen grids, 48 dofs. `tests/bench/speed/models.py` makes them.
- The job is Craig-Bampton: 50 modes with the interface held, to a residual of 1e-10, and the static response to each of 48 dofs. A peer solves for the interior alone: it reads PETSc's binary format, projects nothing and writes nothing. The tools read a container and write one.
- Times are of whole processes. Each runs once to warm up; then all run in random order, all models mixed, and the median is shown. What takes long runs once. Files are in memory (tmpfs). The tools get `RITZ_SYNC=0` and choose their threads; SLEPc runs with one rank of two threads and with two ranks of one, and the better counts.
- *Residual* is the largest |λ K⁻¹ M x - x| / |x| of the modes, computed by the harness with a factor of its own (SuperLU refined once, of larger models MUMPS). On a thin plate, what any factor rounds leaves 1e-10 to 1e-9. *Eigenvalues* is the largest relative difference from those of SLEPc; CalculiX makes its own matrices from the mesh and prints seven digits.
- *At least* is what the machine allows for the same work: the operations of the factor (MUMPS's, by METIS; twice with a count) at the speed of dense products, and the factor read twice for each solve at the speed of memory. The tools are given {solid} blocks of eight vectors on solids and {plate} on plates, and {columns} more for the interface; SLEPc's solves are those that it did, a vector each. A factor that fits into the processor's cache is read faster than that.
- *Peak* is the largest process; of SLEPc's ranks the sum.
- *Verdict*: a row passes if its value is within the limit, *stretch* if it is within that better figure too. Rows for which a tool still lacks an option name it, and are measured once the tool has it. A model that was not asked for has no row beside others.

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
