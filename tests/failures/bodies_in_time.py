"""Two rows of masses, the end of one on the start of the other, and what programs
do that join them by forces over time."""
import numpy as np
import scipy.linalg as la

import models

START, STEP, END = 0.02, 0.01, 2.0


def rows():
    return (models.chain([1.0, 2.0, 1.5], [100.0, 50.0, 80.0]),
            models.chain([1.0, 2.5], [0.0, 60.0]))


def system():
    """K, M of both, C q = 0, and the start: at rest in the first mode of the
    joined system, and that mode's frequency in rad/s."""
    a, b = rows()
    K, M = la.block_diag(a.K, b.K), la.block_diag(a.M, b.M)
    C = np.array([[0.0, 0.0, 1.0, -1.0, 0.0]])
    T = la.null_space(C)
    w2, X = la.eigh(T.T @ K @ T, T.T @ M @ T)
    x = T @ X[:, 0]
    return K, M, C, START * x * np.sign(x[-1]), np.sqrt(w2[0])


def scene(it):
    """Both as components, scene.yaml, and start.txt of its coordinates."""
    a, b = rows()
    it.component("a", a, "--port", "end=3")
    it.component("b", b, "--port", "start=1", "--port", "tip=2")
    it.write("scene.yaml", """\
scene: two rows of masses
components:
  a: {model: a.h5, basis: full}
  b: {model: b.h5, basis: full}
joints:
  - {name: bond, between: [a/end, b/start], type: fixed}
inputs:
  - {name: push, at: b/tip, component: 1}
outputs:
  - {name: tip, at: b/tip, component: 1}
""")


def run(it, *words):
    """Columns of a run of ritz-simulate, tip positive first."""
    it.tool("simulate", "scene.yaml", "--seconds", END, "--step", STEP,
            "--initial", f"mode:1*{START}", *words, "-o", "run.h5")
    found = it.columns("run.h5")
    found["tip"] *= np.sign(found["tip"][0])
    return found
