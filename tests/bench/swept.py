"""swept.py FOLDER-OF-THE-TOOLS - the error if the rates of a basis are left
out: the tables of docs/methods/swept.md.

The hinge between the two beams of tests/failures/hinge.py turns from 0 to 90
degrees in 2, 5 and 20 s, while the first bending mode vibrates. Each basis is
compared with the full model, which is integrated with the same step.
"""
import pathlib
import resource
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "failures"))
import failure
import hinge

BASES = (("switched", ("--sweep-modes", "10")),
         ("without-terms", ("--sweep-modes", "10")), ("one", ()))


def sweep(it, seconds, basis, options):
    """What ritz-simulate prints of a basis against the full model."""
    return it.tool("simulate", "scene.yaml", "--sweep",
                   f"twist=0:90:{seconds}s:smooth", "--step", "0.005",
                   "--every", "20", "--initial", "mode:8", "--sweep-basis",
                   basis, *options, "--sweep-against", "full", "-o", "run.h5")


def cost(it, basis, options):
    """Modes, and processor time of a step, from 4 000 more steps in a run."""
    spent = []
    for step in ("0.005", "0.0025"):
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        said = it.tool("simulate", "scene.yaml", "--sweep",
                       "twist=0:90:20s:smooth", "--step", step, "--every",
                       "100", "--initial", "mode:8", "--sweep-basis", basis,
                       *options, "-o", "run.h5")
        spent.append(resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
                     - before)
    return said["modes"], (spent[1] - spent[0]) / 4000


def main():
    with tempfile.TemporaryDirectory() as folder:
        it = failure.Failure("swept", pathlib.Path(sys.argv[1]).resolve(),
                             pathlib.Path(folder))
        hinge.scene(it, (0, 30, 60, 90), 4.0, "outputs: [{name: root, at: "
                    "b/start, component: 2}]\n")
        print("| turned in | rate over frequency | basis | modes | output off "
              "by | energy off by |\n|---|---|---|---|---|---|")
        for seconds in (2, 5, 20):
            for basis, options in BASES:
                said = sweep(it, seconds, basis, options)
                print(f"| {seconds} s | {said['rate_ratio']:.2g} | {basis} | "
                      f"{said['modes']} | {said['response_error']:.1e} | "
                      f"{said['energy_error']:.1e} |", flush=True)
        print("\n| basis | modes | microseconds a step |\n|---|---|---|")
        for basis, options in (BASES[0], BASES[2], ("full", ())):
            modes, seconds = cost(it, basis, options)
            print(f"| {basis} | {modes} | {1e6 * seconds:.0f} |", flush=True)


if __name__ == "__main__":
    main()
