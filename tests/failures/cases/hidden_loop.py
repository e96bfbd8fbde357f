"""An explicit integration that hides an unstable loop

An oscillator with a little negative damping, q'' - 0.02 q' + 1.5 q = u, as flutter or a badly phased controller leaves behind, with u = 0.5 q fed back. The loop grows as e^(t/100). A program that integrates explicitly computes the force at the start of each step and holds it over the step: the force is half a step late on average, and a late force along the displacement damps, here as 0.25 h q'. At h = 0.1 s more is taken than the loop gives, and the simulation decays. Halving the step twice tells; a single run does not.

Ritz computes the poles of the continuous loop beside the spectral radius of the map from one step to the next. It refuses the run and names the pole, and that the step would hide it; with `--force` it warns of the same. Propagated by one exponential the loop grows at any step.
"""
import numpy as np
import scipy.io
import scipy.linalg

import models

GROUP = "Runs over time"

STIFFNESS, DAMPING, GAIN = 1.5, -0.02, 0.5


def grown(step, seconds):
    """Size at the end over the size at the start, by the naive program: motion
    over a step is exact, the force held."""
    A = np.array([[0, 1, 0], [-STIFFNESS, -DAMPING, 1], [0, 0, 0.0]])
    E = scipy.linalg.expm(A * step)
    z = np.array([1.0, 0.0])
    for _ in range(round(seconds / step)):
        z = E[:2, :2] @ z + E[:2, 2] * GAIN * z[0]
    return np.hypot(*z)


def run(it):
    seconds, step = 200.0, 0.1
    right = np.exp(-DAMPING / 2 * seconds)
    naive = grown(step, seconds)
    it.wrong(f"size after {seconds:g} s", naive, right, 0.9)
    it.holds(naive < 1 < right, "it decays where the loop grows")

    row = models.chain([1.0], [STIFFNESS], D=np.array([[DAMPING]]))
    path = it.component("flutter", row, "--input", "push=1:1", "--output-at",
                        "q=1:1")
    it.reduce(path, "full", out="whole")
    scipy.io.savemat(it.folder / "gain.mat", {
        "A": [[-1.0]], "B": [[0.0]], "C": [[0.0]], "D": [[GAIN]]})
    it.tool("import", "--state-space", "gain.mat", "-o", "gain.h5",
            shown=False)
    loop = ("whole.h5", "--seconds", seconds, "--initial", "mode:1",
            "--controller", "gain.h5", "--connect", "q=u1", "--connect",
            "y1=push", "--feedback", "positive")
    it.says("would hide that", 1, "simulate", *loop, "--step", step, "-o",
            "none.h5")
    answer = it.tool("simulate", *loop, "--step", step, "--force", "-o",
                     "hidden.h5")
    it.notes(answer, "hides it")
    it.run("simulate", *loop, "--step", step, "--loop", "exact", "--force",
           "-o", "grows.h5")
    size = {}
    for name in "hidden", "grows":
        found = it.columns(f"{name}.h5")
        size[name] = found["seconds"], found["q"]
    end = np.abs(size["grows"][1][-80:]).max()
    it.right("size by one exponential", end, right, 0.05)
    it.right("size as held", np.abs(size["hidden"][1][-80:]).max(), naive, 0.05)
    it.row(f"decays to {naive:.2g} of its size in {seconds:g} s",
           f"grows to {right:.2g}", f"refused: `the loop is unstable`, a step "
           f"of {step:g} s `would hide that`; by one exponential {end:.2g}")
    it.picture("""set xlabel "s"
set ylabel "q"
set xrange [0:200]
set key top left Left reverse samplen 2
plot $grows using 1:2 with lines lw 1.2 lc rgb "#2166ac" title "the loop, by one exponential", \\
    $hidden using 1:2 with lines lw 1.2 lc rgb "#b2182b" title "force held over steps of 0.1 s"
""", "An unstable loop: as it moves, and as a step of 0.1 s shows it.",
               **{name: (t[::4], q[::4]) for name, (t, q) in size.items()})
