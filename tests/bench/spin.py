#!/usr/bin/python3 -s
"""spin.py FOLDER-OF-THE-TOOLS - the cost of a step while the rate of spin
changes, with a factorisation of O(r^3), and while it is constant, O(r^2), for
data/spin-up at several orders r. Prints the table of docs/methods/spin.md.

Status 1 if a step costs more at a constant rate than at a rate that changes.
"""
import pathlib
import subprocess
import sys
import tempfile
import time

DATA = pathlib.Path(__file__).resolve().parents[2] / "data" / "spin-up"
ORDERS = (6, 12, 24, 39)
STEPS = 20000
SCENE = """scene: spin-up
components: {{beam: {{model: {}, stiffening: {{spin_zz: spin}}}}}}
spin: {{axis: [0, 0, 1], profile: [[0, {}], [1, {}]]}}
"""


def seconds(tools, folder, model, rates, steps):
    """Time of a run, the least of three."""
    (folder / "scene.yaml").write_text(SCENE.format(model, *rates))
    best = float("inf")
    for _ in range(3):
        start = time.perf_counter()
        subprocess.run([tools / "ritz-simulate", "-q", "scene.yaml", "--method",
                        "trapezoidal", "--seconds", "1", "--step",
                        repr(1 / steps), "--every", str(steps), "-o", "run.h5"],
                       cwd=folder, check=True, capture_output=True)
        best = min(best, time.perf_counter() - start)
    return best


def main():
    tools = pathlib.Path(sys.argv[1]).resolve()
    failed = False
    print("| order | constant, us a step | changing, us a step | ratio |\n"
          "|---|---|---|---|")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        def run(*words):
            subprocess.run([tools / f"ritz-{words[0]}", "-q", *words[1:]],
                           cwd=folder, check=True, capture_output=True)

        run("import", "--stiffness", DATA / "K.mtx", "--mass", DATA / "M.mtx",
            "--geometric-stiffness", f"{DATA / 'KG.mtx'}@spin", "--bulk",
            DATA / "beam.bdf", "-o", "beam.h5")
        for order in ORDERS:
            run("basis", *(["full"] if order == 39 else
                           ["normal-modes", "--modes", str(order)]),
                "beam.h5", "-o", "basis.h5")
            run("reduce", "beam.h5", "basis.h5", "-o", "reduced.h5")
            cost = [(seconds(tools, folder, "reduced.h5", rates, STEPS)
                     - seconds(tools, folder, "reduced.h5", rates, 10)) / STEPS
                    for rates in ((2, 2), (1, 3))]
            failed |= cost[0] > cost[1]
            print(f"| {order} | {cost[0] * 1e6:.2f} | {cost[1] * 1e6:.2f} | "
                  f"{cost[1] / cost[0]:.1f} |")
    return 1 if failed else 0


sys.exit(main())
