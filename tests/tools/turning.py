"""turning.py FOLDER-OF-THE-TOOLS: hold ritz-simulate --sweep to a model in
space axes that shares nothing with it.

Two beams are joined at a locked hinge about their axis, and the first one is
held. The far beam has space axes: its K is Q(x) K Q(x)', its M does not change,
and no term has a rate of the hinge. That is right without rotary inertia. A
moment of inertia J about the axis n adds the motions of its points relative to
the commanded ones, with the rotations t and the rate w of the hinge

    -w J n.(t x t') / 2 + w^2 J ((t.n)^2 + |t|^2) / 4

to the Lagrangian. The first term has the order of w: without it the model in
space axes is wrong.
"""
import pathlib
import sys

import numpy as np
import scipy.linalg as la

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "failures"))
import failure
import hinge

SCENE = """\
scene: two beams on a hinge
components:
  a: {model: a.h5, basis: full}
  b: {model: b.h5, basis: full}
joints: [{name: twist, between: [a/end, b/start], type: hinge, axis: [1, 0, 0], angles_deg: [0], state: locked}]
outputs: [{name: y, at: b/start, component: 2}, {name: z, at: b/tip, component: 3}]
"""
ANGLE, SECONDS = np.pi / 2, 1.5
CROSS = np.array([[0, 0, 0], [0, 0, -1], [0, 1, 0]])  # n x
POINTS = np.diag([1.0, 0.5, 0.5])


def path(t):
    """The angle, and its first and second derivative."""
    s = np.poly1d([6, -15, 10, 0, 0, 0])
    return [ANGLE * s.deriv(k)(t / SECONDS) / SECONDS**k for k in range(3)]


def held_beams():
    pair = hinge.beams()
    pair[0].K[:6, :6] += np.diag([50.0] * 3 + [20.0] * 3)
    return pair


def beams(inertia):
    """With as much inertia about their axes. Mass along the axis is that across
    it: what M then tells of its points is exact."""
    pair = held_beams()
    for body in pair:
        n = len(body.M)
        body.M[3::6] *= inertia / 1e-2
        body.M[np.ix_(range(0, n, 6), range(0, n, 6))] = \
            body.M[np.ix_(range(1, n, 6), range(1, n, 6))]
    return pair


class Space:
    """Both beams in space axes."""

    def __init__(self, a, b):
        self.a, self.b, self.n = a, b, len(a.K)
        self.join = np.zeros((2 * self.n, 2 * self.n - 6))
        self.join[:self.n, :self.n] = np.eye(self.n)
        self.join[self.n:, self.n - 6:] = np.eye(self.n)
        self.M = self.joined(a.M, b.M)
        spins = np.zeros((self.n // 3, self.n // 3))  # J of all pairs of grids
        spins[1::2, 1::2] = b.M[3::6, 3::6]
        none = np.zeros((self.n, self.n))
        self.moment = self.joined(none, -0.5 * np.kron(spins, CROSS))
        self.pull = self.joined(none, -np.kron(spins, POINTS))

    def joined(self, first, second):
        return self.join.T @ la.block_diag(first, second) @ self.join

    def turn(self, angle):
        return np.kron(np.eye(self.n // 3), la.expm(angle * CROSS))

    def stiffness(self, angle):
        Q = self.turn(angle)
        return self.joined(self.a.K, Q @ self.b.K @ Q.T)

    def run(self, step, points):
        """y and z in axes of the far beam, from the first mode, by the
        trapezoidal rule; with or without the points of rotary inertia."""
        q = la.eigh(self.stiffness(0.0), self.M)[1][:, 0]
        v, out = np.zeros_like(q), []
        acceleration = la.solve(self.M, -self.stiffness(0.0) @ q)
        for k in range(round(SECONDS / step) + 1):
            u = self.turn(path(k * step)[0]).T @ q[self.n - 6:]
            out.append((u[1], u[self.n - 4]))
            angle, w, w1 = path((k + 1) * step)
            K, C = self.stiffness(angle), np.zeros_like(self.M)
            if points:
                C = 2 * w * self.moment
                K += w1 * self.moment + w * w * self.pull
            q = q + step * v + step**2 / 4 * acceleration
            v = v + step / 2 * acceleration
            acceleration = la.solve(
                self.M + step / 2 * C + step**2 / 4 * K, -K @ q - C @ v)
            q = q + step**2 / 4 * acceleration
            v = v + step / 2 * acceleration
        return np.array(out)


def sweep(it, step):
    """What ritz-simulate says of a turning beam."""
    return it.tool("simulate", "scene.yaml", "--sweep",
                   f"twist=0:90:{SECONDS}s:smooth", "--sweep-basis", "full",
                   "--step", step, "--initial", "mode:1", "-o", "r.h5")


def ritz(it, step):
    """y and z, and nothing that is approximate."""
    warnings = sweep(it, step)["warnings"]
    it.holds(not any("approximate" in w for w in warnings),
             f"no inertia is lost: {warnings}")
    it.tool("export", "--to", "tsv", "r.h5", "-o", "r.tsv")
    rows = [line.lstrip("# ").split("\t")
            for line in (it.folder / "r.tsv").read_text().splitlines()]
    head = next(k for k, row in enumerate(rows) if {"y", "z"} <= set(row))
    at = [rows[head].index(name) for name in "yz"]
    return np.array([[float(row[k]) for k in at] for row in rows[head + 1:]])


def off(y, reference):
    """Either may have the mode with the other sign."""
    y = y * np.sign(np.sum(y[0] * reference[0]))
    return (abs(y - reference).max(0) / abs(reference).max(0)).max()


def write(it, a, b):
    end = hinge.ELEMENTS + 1
    it.component("a", a, "--port", f"end={end}")
    it.component("b", b, "--port", "start=1", "--port", f"tip={end}")


def compare(it, inertia):
    """Ritz with both models in space axes, at two steps."""
    a, b = beams(inertia)
    write(it, a, b)
    space = Space(a, b)
    coarse = off(ritz(it, 0.01), space.run(0.01, True))
    y = ritz(it, 0.005)
    fine, vectors = (off(y, space.run(0.005, points))
                     for points in (True, False))
    print(f"J = {inertia:g}: off by {coarse:.2e}, {fine:.2e} at half the "
          f"step, {vectors:.2e} of rotations as vectors")
    it.holds(fine < 1e-4 and 3.7 < coarse / fine < 4.3,
             "Ritz is the model in space axes, to the order of the step")
    it.holds(vectors > 4e-3 if inertia == 1e-2 else vectors < 1e-4,
             "rotations as vectors differ by rotary inertia only")


def main():
    it = failure.Failure("turning", pathlib.Path(sys.argv[1]).resolve(),
                         pathlib.Path.cwd())
    it.write("scene.yaml", SCENE)
    compare(it, 1e-2)
    compare(it, 1e-6)
    # Consistent mass without cells: products of inertia are not in M.
    write(it, *held_beams())
    it.notes(sweep(it, 0.01), "'b': turning terms are approximate: mode ")


main()
