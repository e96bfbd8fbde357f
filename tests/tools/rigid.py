#!/usr/bin/python3 -s
"""rigid.py write PROGRAMS | rigid.py MODEL FORMAT FILE - a block of solid; and
the largest elastic force in FILE, of the largest, if the simulator moves the
body rigidly.

In formats with a moving frame the nodes of the file move by x -> t + r x x, as
the file places them, with every mode at zero: the stiffness of the whole MODEL
has no force for that. Nor do the file's own modes represent such a motion
about another place. In formats with interface frames the file's K has no force
for motions of these frames as one rigid body. The readers follow the published
layouts; see docs/simulators.md."""
import pathlib
import re
import sys

import h5py
import numpy
import scipy.io
import scipy.sparse

ROUNDING = 1e-12  # what the formats are held to, of the largest


def skew(x):
    """skew(x) r = x x r."""
    return numpy.array([[0, -x[2], x[1]], [x[2], 0, -x[0]], [-x[1], x[0], 0]])


def rigid(at):
    """Translations and rotations of points, for six motions of the frame."""
    return numpy.array([numpy.block([[numpy.eye(3), -skew(x)],
                                     [numpy.zeros((3, 3)), numpy.eye(3)]])
                        for x in at])


# --- files with a moving frame: grids or None, rigid motion of each node, modes,
# --- K; of shapes without rotations the last three rows are left out


def read_exudyn(path):
    with h5py.File(path) as f:
        at, shape = f["xRef"][:].reshape(-1, 3), f["modeBasis"][:]
        return None, rigid(at), shape.reshape(len(at), 3, -1), \
            f["stiffnessMatrixReduced"][:]


def read_mbdyn(path):
    groups, words = {}, []
    for line in open(path):
        if line.startswith("** RECORD GROUP "):
            words = groups.setdefault(int(line[16:].split(",")[0]), [])
        elif not line.startswith("**"):
            words += line.split()
    count, modes = int(groups[1][1]), int(groups[1][2])
    at = numpy.array([groups[k] for k in (5, 6, 7)], float).T
    shape = numpy.array(groups[8], float).reshape(modes, count, 6)
    real = [k for k, name in enumerate(groups[2]) if name.isdigit()]
    return [int(groups[2][k]) for k in real], rigid(at[real]), \
        shape[:, real].transpose(1, 2, 0), \
        numpy.array(groups[10], float).reshape(modes, modes)


ENTRY = re.compile(r" *(m[01])\(([ 0-9,]+)\) *=(.*)")


def read_sid(path):
    modes = int(open(path).readline().split()[1])
    node, part, values = None, None, {}
    for line in open(path):
        word = line.split()
        if word[:2] == ["new", "node"]:
            node = int(word[-1])
        elif len(word) == 1:
            part = word[0]
        elif word[:1] == ["end"]:
            node = None if word[1] == "node" else node
        elif ENTRY.match(line):
            name, index, number = ENTRY.match(line).groups()
            values.setdefault((node, part, name), {})[
                tuple(int(k) - 1 for k in index.split(","))] = \
                float(number.replace("D", "E"))

    def array(*key, shape):
        out = numpy.zeros(shape)
        for index, value in values.get(key, {}).items():
            out[index] = value
        return out
    grids = sorted({key[0] for key in values if key[0] is not None})
    at = [array(g, "origin", "m0", shape=(3, 1))[:, 0] for g in grids]
    shape = numpy.array([
        numpy.vstack([array(g, "phi", "m0", shape=(3, modes)),
                      array(g, "psi", "m0", shape=(3, modes))])
        for g in grids])
    moved = numpy.array([array(g, "origin", "m1", shape=(3, modes, 1))[:, :, 0]
                         for g in grids])
    assert abs(moved - shape[:, :3]).max() == 0.0  # as origin m1 is phi
    return grids, rigid(at), shape, array(None, "Ke", "m0",
                                          shape=(modes, modes))


def read_42(path):
    nodes = open(path + ".nodes").read().splitlines()[4:]
    nodes = [line.split('"') for line in nodes if '"grid ' in line]
    at = [[float(x) for x in line[0].split()] for line in nodes]
    grids = [int(line[1].split()[1]) for line in nodes]
    lines = iter(open(path).read().splitlines())
    modes, K, shape, kind = 0, None, None, ""
    for line in lines:
        if "Number of Flex Modes" in line:
            modes = int(line.split()[0])
            shape = numpy.zeros((len(at), 6, modes))
            K = numpy.zeros((modes, modes))
        elif line.startswith("***"):
            kind = line if "Elements" not in line else kind + line
        elif "[Mode] [Node] [Axis]" in line:
            mode, node, axis = map(int, line.split()[:3])
            axis += 3 if "THETA" in kind else 0
            shape[node, axis, mode] = float(line.split()[3])
        elif "Stiffness" in kind and "[" in line:
            i, j = map(int, line.split()[:2])
            K[i, j] = float(line.split()[2])
        elif "[EOF]" in line:
            break
        kind = kind[-200:]
    return grids, rigid(at), shape, K


def read_fxbody(path):
    lines = [line.rstrip("\n") for line in open(path)
             if line.strip() and line[0] not in "#$"]
    modes, _, count, turns = (int(lines[0][8 * k:8 * k + 8]) for k in range(4))
    row = 1 + -(-count // 10)
    grids = [int(line[k:k + 8]) for line in lines[1:row]
             for k in range(0, len(line), 8)]
    numbers = [line[k:k + 16] for line in lines[row:]
               for k in range(0, len(line), 16)]
    numbers = iter([float(re.sub(r"(?<=[0-9.])([+-])", r"E\1", text))
                    for text in numbers])

    def take(*shape):
        return numpy.array([next(numbers) for _ in range(
            int(numpy.prod(shape)))]).reshape(shape)
    take(10)
    points = take(15 if turns else 12, count, 6)
    shape = take(modes, count, 6).transpose(1, 2, 0)
    take(modes)
    K = numpy.diag(take(modes))
    # twelve are coordinates of points at x, y, z and at the frame itself
    frame = rigid(list(numpy.eye(3)) + [numpy.zeros(3)])[:, :3].reshape(12, 6)
    if turns:
        frame = numpy.vstack([frame, numpy.eye(6)[3:]])
    return grids, numpy.einsum("pna,pc->nac", points, frame), shape, K


# --- files with interface frames: where they are, K


def read_simscape(path):
    solid = scipy.io.loadmat(path)
    return solid["P"], solid["K"]


def read_chrono(path):
    words = iter(" ".join(line for line in open(path)
                          if line[0] != "#").split())
    assert next(words) == "frames"
    at = [[float(next(words)) for _ in range(4)][1:]
          for _ in range(int(next(words)))]
    assert next(words) == "modes"
    modes = [float(next(words)) for _ in range(int(next(words)))]
    n = 6 * len(at) + len(modes)
    matrix = {}
    for _ in "MKD":
        name = next(words)
        matrix[name] = numpy.array([[float(next(words)) for _ in range(n)]
                                    for _ in range(n)])
    return at, matrix["K"]


def read_openfast(path):
    lines = open(path).read().splitlines()
    first = next(k for k, line in enumerate(lines)
                 if line.startswith("!Stiffness Matrix")) + 1
    first += lines[first].startswith("!")  # FlexASCII repeats the dimension
    n = next(int(line.split(":")[1]) for line in lines
             if line.startswith("!Dimension:"))
    return [[0, 0, 0]], numpy.array([line.split() for line in
                                     lines[first:first + n]], float)


# --- measures


def read_model(path):
    """K, grid and component of its rows, and axes of its grids."""
    with h5py.File(path) as f:
        K = scipy.sparse.csc_matrix((
            f["K/data"][:], f["K/indices"][:], f["K/indptr"][:])).toarray()
        axes = dict(zip(map(int, f["grids/id"]), f["grids/frames"][:][
            f["grids/frame"][:]]))
        return K, f["dofs/grid"][:], f["dofs/component"][:], axes


def moving_frame(model, grids, motion, shape, K):
    whole, grid, component, axes = read_model(model)
    grids = sorted(axes) if grids is None else grids
    assert sorted(grids) == sorted(axes), "the nodes are those of the model"
    row = {g: k for k, g in enumerate(grids)}
    u = numpy.zeros((len(grid), 6))
    for r, (g, c) in enumerate(zip(grid, component - 1)):
        first = 3 * (c // 3)
        u[r] = axes[g][c % 3] @ motion[row[g]][first:first + 3]
    felt = abs(whole @ u).max() / (abs(whole).max() * abs(u).max())
    # motions about another place, in terms of those of the frame and of modes
    rows = shape.shape[1]
    other = motion @ rigid([[5.0, -3.0, 2.0]])[0]
    both = numpy.concatenate([motion[:, :rows], shape], axis=2)
    both = both.reshape(-1, both.shape[2])
    # columns of one size, as translations and modes have their own units
    size = abs(both).max(axis=0)
    eta = numpy.linalg.lstsq(both / size, other[:, :rows].reshape(-1, 6),
                             rcond=None)[0][6:] / size[6:, None]
    own = abs(K @ eta).max() / (abs(K).max() * abs(other).max()
                                / abs(shape).max())
    return max(felt, own)


def interface_frames(_, at, K):
    r = numpy.zeros((len(K), 6))
    r[:6 * len(at)] = rigid(numpy.asarray(at)).reshape(-1, 6)
    return abs(K @ r).max() / (abs(K).max() * abs(r).max())


READERS = {
    "exudyn": (read_exudyn, moving_frame),
    "mbdyn": (read_mbdyn, moving_frame),
    "sid": (read_sid, moving_frame),
    "42": (read_42, moving_frame),
    "fxbody": (read_fxbody, moving_frame),
    "simscape": (read_simscape, interface_frames),
    "chrono": (read_chrono, interface_frames),
    "openfast": (read_openfast, interface_frames),
    "openfast-4": (read_openfast, interface_frames),
}


def write(programs):
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]
                           / "interop"))
    from common import Block, Tools

    Block((4, 2, 2), turned=True).write(Tools(programs, "."))


if sys.argv[1:2] == ["write"]:
    write(sys.argv[2])
else:
    model, kind, path = sys.argv[1:]
    read, measure = READERS[kind]
    force = measure(model, *read(path))
    print(f"{force:.1e} of the largest")
    sys.exit(0 if force <= ROUNDING else 1)
