"""Shared by the scripts of this folder: TAP lines, tools, a block of solid."""
import os
import pathlib
import subprocess
import sys


def skip(reason):
    """Ends the script as one that could not be run."""
    print("skipped:", reason, flush=True)
    sys.exit(77)


try:
    import numpy
    import scipy.io
    import scipy.sparse
except ImportError as missing:
    skip(missing)

DATA = pathlib.Path(__file__).resolve().parents[2] / "data"
EXTERNAL = pathlib.Path(os.environ.get(
    "RITZ_EXTERNAL_DATA", DATA.parent / "../shared/data")).resolve()


class Tap:
    """Prints one line for each sentence that holds or does not."""

    def __init__(self):
        self.count = self.failed = 0

    def check(self, holds, sentence, figures=""):
        self.count += 1
        self.failed += not holds
        print("ok" if holds else "not ok", self.count, "-", sentence,
              f"# {figures}" if figures else "", flush=True)

    def near(self, found, expected, allowed, sentence):
        """Relative to the largest entry that is expected."""
        found, expected = numpy.asarray(found), numpy.asarray(expected)
        if found.shape != expected.shape:
            self.check(False, sentence, f"{found.shape} {expected.shape}")
            return
        scale = max(numpy.abs(expected).max(initial=0.0), 1e-300)
        error = numpy.abs(found - expected).max(initial=0.0) / scale
        self.check(error <= allowed, sentence, f"{error:.1e} <= {allowed:.1e}")

    def finish(self):
        print(f"1..{self.count}")
        print(f"# {self.count - self.failed} passed, {self.failed} failed")
        sys.exit(1 if self.failed or not self.count else 0)


class Tools:
    """The tools, run in a folder."""

    def __init__(self, programs, folder):
        self.programs = pathlib.Path(programs).resolve()
        self.folder = pathlib.Path(folder)

    def __call__(self, tool, *arguments):
        """Run a tool, which must succeed, and return its standard output."""
        done = subprocess.run(
            [self.programs / tool, *map(str, arguments)], cwd=self.folder,
            text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        if done.returncode != 0:
            sys.exit(f"{tool} {' '.join(map(str, arguments))}: {done.stderr}")
        return done.stdout

    def path(self, name):
        return str(self.folder / name)


def turn(axis, angle):
    """Rotation matrix; its rows serve as displacement axes."""
    x, y, z = numpy.asarray(axis) / numpy.linalg.norm(axis)
    W = numpy.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return (numpy.eye(3) + numpy.sin(angle) * W
            + (1.0 - numpy.cos(angle)) * W @ W)


def hexahedron(size, E, nu, rho):
    """K and consistent M of a rectangular 8-node brick, 2 x 2 x 2 points."""
    corner = numpy.array([[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1],
                          [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]])
    lame, G = E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))
    C = numpy.zeros((6, 6))
    C[:3, :3] = lame
    C += numpy.diag([2 * G] * 3 + [G] * 3)
    volume = numpy.prod(size) / 8.0
    K, M = numpy.zeros((24, 24)), numpy.zeros((24, 24))
    for point in corner / numpy.sqrt(3.0):
        f = 1.0 + corner * point
        N = f.prod(axis=1) / 8.0
        d = numpy.array([corner[:, a] * f[:, (a + 1) % 3] * f[:, (a + 2) % 3]
                         / 8.0 * 2.0 / size[a] for a in range(3)])
        B = numpy.zeros((6, 24))
        for a in range(3):
            B[a, a::3] = d[a]
        for row, (a, b) in enumerate([(0, 1), (1, 2), (2, 0)]):
            B[3 + row, a::3] = d[b]
            B[3 + row, b::3] = d[a]
        K += volume * B.T @ C @ B
        M += volume * rho * numpy.kron(numpy.outer(N, N), numpy.eye(3))
    return K, M


class Block:
    """A rectangular solid of bricks, away from the origin; some grids may
    have displacement axes of their own."""

    size, E, nu, rho = (2.0, 0.4, 0.3), 1.0e7, 0.3, 1000.0
    corner = numpy.array([0.7, -0.5, 0.2])
    axes = turn([1, 2, 3], 0.7)

    def __init__(self, bricks, turned=False, clamped=False):
        nx, ny, nz = bricks
        count = (nx + 1, ny + 1, nz + 1)
        step = numpy.array(self.size) / bricks
        index = numpy.arange(numpy.prod(count)).reshape(count)
        self.position = (self.corner
                         + step * numpy.argwhere(index >= 0))
        self.n = 3 * index.size
        # a port on the face x = 0, or opposite if that one is held
        self.port = index[-1 if clamped else 0].ravel() + 1
        # every third grid, if any
        self.turned = numpy.arange(index.size) % 3 == (1 if turned else 7)
        K_e, M_e = hexahedron(step, self.E, self.nu, self.rho)
        K = numpy.zeros((self.n, self.n))
        M = numpy.zeros_like(K)
        for i, j, k in numpy.ndindex(*bricks):
            node = [index[i + a, j + b, k + c] for a, b, c in
                    [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0),
                     (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]]
            at = numpy.add.outer(3 * numpy.array(node), range(3)).ravel()
            K[numpy.ix_(at, at)] += K_e
            M[numpy.ix_(at, at)] += M_e
        self.K, self.M = K, M  # along basic axes
        # u_basic = A' u of each grid
        self.to_basic = scipy.sparse.block_diag(
            [self.axes.T if t else numpy.eye(3) for t in self.turned], "csr")
        self.id = index.ravel() + 1
        if clamped:
            self.drop(index[0].ravel())

    def drop(self, held):
        """Without these grids, which do not move."""
        free = numpy.setdiff1d(numpy.arange(len(self.id)), held)
        rows = numpy.add.outer(3 * free, range(3)).ravel()
        self.K = self.K[numpy.ix_(rows, rows)]
        self.M = self.M[numpy.ix_(rows, rows)]
        self.to_basic = self.to_basic[rows][:, rows]
        self.position, self.id = self.position[free], self.id[free]
        self.turned = self.turned[free]

    def write(self, tools, *options):
        """Matrices, deck and row names in the tools' folder; block.h5."""
        A = self.to_basic
        for name, matrix in ("K", self.K), ("M", self.M):
            local = A.T @ scipy.sparse.csr_matrix(matrix) @ A
            scipy.io.mmwrite(tools.path(name + ".mtx"),
                             scipy.sparse.coo_matrix((local + local.T) / 2),
                             precision=17, symmetry="symmetric")
        z, x = self.axes[2], self.axes[0] + self.axes[2]
        with open(tools.path("block.bdf"), "w") as deck:
            deck.write("BEGIN BULK\n")
            deck.write("CORD2R*,5,0,0.,0.\n*,0.,"
                       + ",".join(f"{v:.15g}" for v in z) + "\n*,"
                       + ",".join(f"{v:.15g}" for v in x) + "\n")
            for k, at in enumerate(self.position):
                place = ",".join(f"{float(v)!r}" for v in at)
                deck.write(f"GRID,{self.id[k]},,{place}"
                           f"{',5' if self.turned[k] else ''}\n")
            deck.write("ENDDATA\n")
        with open(tools.path("block.dofs"), "w") as rows:
            for grid in self.id:
                for component in 1, 2, 3:
                    rows.write(f"{grid} {component}\n")
        tools("ritz-import", "--stiffness", "K.mtx", "--mass", "M.mtx",
              "--bulk", "block.bdf", "--dofs", "block.dofs",
              "--port", f"face={self.port[0]}-{self.port[-1]}",
              *options, "-o", "block.h5")
