#!/usr/bin/python3 -s
"""spellings.py PROGRAMS - one clamped block of solid as CalculiX, Abaqus, ANSYS
and NASTRAN would spell it gives one component: the same matrices, names of rows,
places of grids and elements.

The script writes the files from the published layouts that docs/import.md names,
without any code of Ritz. Values have ten digits, which every spelling carries, so
that components are equal in every bit; then seventeen, of which each format keeps
its own number. Substructures are guyan if they are condensed, as Abaqus would do
it and as CalculiX 2.23 has done it (data/substructure)."""
import struct
import sys
import tempfile

from common import DATA, Block, Tap, Tools, skip

try:
    import h5py
    import numpy
    import scipy.sparse
except ImportError as missing:
    skip(missing)


EPSILON = numpy.finfo(float).eps


class Part:
    """K and M of all nodes, and of those that are free."""

    def __init__(self, digits):
        self.bricks = (3, 2, 1)
        block = Block(self.bricks)
        count = numpy.array(self.bricks) + 1
        self.index = numpy.arange(count.prod()).reshape(count)
        self.node = 7 + 3 * numpy.arange(count.prod())  # not 1, 2, ...
        self.at = numpy.round(block.position, 6)
        self.K, self.M = (self.rounded(A, digits) for A in (block.K, block.M))
        self.held = self.index[0].ravel()
        free = numpy.setdiff1d(numpy.arange(len(self.node)), self.held)
        self.rows = numpy.add.outer(3 * free, range(3)).ravel()
        # of every row: node and direction
        self.dof = [(self.node[r // 3], r % 3 + 1) for r in range(len(self.K))]

    @staticmethod
    def rounded(A, digits):
        return numpy.array([[float(f"{x:.{digits - 1}e}") for x in row]
                            for row in (A + A.T) / 2.0])

    def elements(self):
        """Nodes of each brick, in the order of C3D8 and CHEXA."""
        for i, j, k in numpy.ndindex(*self.bricks):
            yield [self.node[self.index[i + a, j + b, k + c]] for a, b, c in
                   [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0),
                    (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]]

    def free(self, A):
        return A[numpy.ix_(self.rows, self.rows)]

    def entries(self, A):
        """Row, column and value of what is not zero, or on the diagonal."""
        for j in range(len(A)):
            for i in range(len(A)):
                if A[i, j] != 0.0 or i == j:
                    yield i, j, A[i, j]


def write(tools, name, lines):
    with open(tools.path(name), "w") as file:
        file.writelines(line + "\n" for line in lines)


# ---- decks --------------------------------------------------------------------

def inp(part, step):
    """Abaqus and CalculiX: nodes, elements, supports and a step."""
    lines = ["*NODE"]
    lines += [f"{n}, {x}, {y}, {z}"
              for n, (x, y, z) in zip(part.node, part.at)]
    lines.append("*ELEMENT, TYPE=C3D8, ELSET=ALL")
    lines += [", ".join(map(str, [e + 1] + nodes))
              for e, nodes in enumerate(part.elements())]
    lines += ["*NSET, NSET=WALL",
              ", ".join(str(part.node[k]) for k in part.held)]
    return lines + ["*BOUNDARY", "WALL, 1, 3"] + ["*STEP"] + step + ["*END STEP"]


def bulk(part):
    """NASTRAN: GRID in large fields, CHEXA, SPC1."""
    lines = ["SOL 103", "CEND", "SPC = 4", "BEGIN BULK"]
    for n, at in zip(part.node, part.at):
        x, y, z = (f"{v:16.9f}" for v in at)
        lines += [f"{'GRID*':8s}{n:16d}{'':16s}{x}{y}", f"{'*':8s}{z}"]
    for e, nodes in enumerate(part.elements()):
        lines += ["CHEXA   " + "".join(f"{v:8d}"
                                       for v in [e + 1, 1] + nodes[:6]),
                  "        " + "".join(f"{v:8d}" for v in nodes[6:])]
    lines += [f"SPC1    {4:8d}{123456:8d}{part.node[k]:8d}"
              for k in part.held]
    return lines + ["ENDDATA"]


def cdb(part):
    """ANSYS: nodes and SOLID185 in blocks, supports [Ansys2024]."""
    lines = ["/COM,ANSYS RELEASE 2024 R1", "/PREP7", "ET,1,185",
             f"NBLOCK,6,SOLID,{part.node[-1]:10d},{len(part.node):10d}",
             "(3i9,6e21.13e3)"]
    for n, at in zip(part.node, part.at):
        words = [f"{v:.13E}".split("E") for v in at]
        lines.append(f"{n:9d}{0:9d}{0:9d}" + "".join(
            f"{m}E{int(e):+04d}".rjust(21) for m, e in words))
    elements = list(part.elements())
    lines += ["N,R5.3,LOC,       -1,",
              f"EBLOCK,19,SOLID,{len(elements):10d},{len(elements):10d}",
              "(19i9)"]
    lines += ["".join(f"{v:9d}" for v in
                      [1, 1, 1, 1, 0, 0, 0, 0, 8, 0, e + 1] + nodes)
              for e, nodes in enumerate(elements)] + [f"{-1:9d}"]
    lines += [f"D,{part.node[k]:9d},U{axis}  , 0.000000000    , 0.000000000"
              for k in part.held for axis in "XYZ"]
    return lines + ["FINISH"]


# ---- spellings ------------------------------------------------------------------

def calculix(part, tools):
    """One triangle by columns without a header, names as node.direction; rows
    of fixed nodes are not there [Dhondt2022]."""
    for ending, A in ("sti", part.K), ("mas", part.M):
        write(tools, "c." + ending, [
            f"{i + 1} {j + 1} {value:20.13e}"
            for i, j, value in part.entries(part.free(A)) if i >= j])
    write(tools, "c.dof", ["{}.{}".format(*part.dof[r]) for r in part.rows])
    write(tools, "c.inp", inp(part, ["*FREQUENCY, SOLVER=MATRIXSTORAGE", "10"]))
    return "c.sti", "c.mas", "--dofs", "c.dof", "--bulk", "c.inp"


def abaqus_coordinate(part, tools):
    """Both triangles of all nodes, whose rows the deck names; supports hold
    the component alone [Abaqus2016]."""
    for name, A in ("STIF", part.K), ("MASS", part.M):
        write(tools, f"a_{name}1.mtx", [
            f"{i + 1} {j + 1} {value:23.15e}"
            for i, j, value in part.entries(A)])
    write(tools, "a.inp", inp(part, [
        "*MATRIX GENERATE, STIFFNESS, MASS",
        "*MATRIX OUTPUT, STIFFNESS, MASS, FORMAT=COORDINATE"]))
    return "a_STIF1.mtx", "a_MASS1.mtx", "--bulk", "a.inp"


def abaqus_input(part, tools):
    """Each entry of one triangle names its rows [Abaqus2016]."""
    for name, A in ("STIF", part.K), ("MASS", part.M):
        write(tools, f"m_{name}1.mtx", [
            "{},{},{},{},{:23.15e}".format(*part.dof[i], *part.dof[j], value)
            for i, j, value in part.entries(A) if i <= j])
    write(tools, "m.inp", inp(part, [
        "*MATRIX GENERATE, STIFFNESS, MASS",
        "*MATRIX OUTPUT, STIFFNESS, MASS, FORMAT=MATRIX INPUT"]))
    return "m_STIF1.mtx", "m_MASS1.mtx", "--bulk", "m.inp"


def user_element(nodes, K, M):
    """A substructure with three directions of each node: lower triangles by
    rows, four numbers to a line [Abaqus2016]."""
    lines = [f"*USER ELEMENT, NODES={len(nodes)}, LINEAR", "** ELEMENT NODES"]
    lines += ["** " + ", ".join(map(str, nodes[k:k + 8]))
              for k in range(0, len(nodes), 8)] + ["1, 2, 3"]
    for name, A in ("STIFFNESS", K), ("MASS", M):
        lines.append("*MATRIX, TYPE=" + name)
        for i, row in enumerate(A):
            words = [f"{value:.15e}" for value in row[:i + 1]]
            lines += [", ".join(words[k:k + 4])
                      for k in range(0, len(words), 4)]
    return lines


def substructure(part, tools):
    """A user element of all free nodes, which condenses nothing."""
    nodes = [n for k, n in enumerate(part.node) if k not in part.held]
    write(tools, "u.mtx", user_element(nodes, part.free(part.K),
                                       part.free(part.M)))
    write(tools, "u.inp", inp(part, ["*SUBSTRUCTURE GENERATE, TYPE=Z1"]))
    return "u.mtx:STIFFNESS", "u.mtx:MASS", "--bulk", "u.inp"


def boeing(title, A):
    """RSA: pointers, rows and values of the lower triangle by columns
    [DuffGrimesLewis1989]."""
    L = scipy.sparse.csc_matrix(numpy.tril(A))
    L.sort_indices()

    def fields(values, form, count):
        words = [form.format(v) for v in values]
        return ["".join(words[k:k + count])
                for k in range(0, len(words), count)]

    parts = [fields(L.indptr + 1, "{:8d}", 10),
             fields(L.indices + 1, "{:8d}", 10),
             fields(L.data, "{:25.16E}", 3)]
    counts = [len(p) for p in parts]
    return [f"{title:72s}{'RITZ':8s}",
            "".join(f"{v:14d}" for v in [sum(counts)] + counts + [0]),
            f"{'RSA':14s}" + "".join(f"{v:14d}" for v in
                                     (len(A), len(A), L.nnz, 0)),
            f"{'(10I8)':16s}{'(10I8)':16s}{'(3E25.16)':20s}"] + sum(parts, [])


def ansys(part, tools):
    """HBMAT of the free rows, a mapping file, a database [AnsysHbmat2024]."""
    write(tools, "stiff.matrix", boeing("STIFFNESS", part.free(part.K)))
    write(tools, "mass.matrix", boeing("MASS", part.free(part.M)))
    write(tools, "stiff.mapping", ["Matrix Eqn     Node   DOF"] + [
        f"{k + 1:10d}{part.dof[r][0]:10d}   U{'XYZ'[part.dof[r][1] - 1]}"
        for k, r in enumerate(part.rows)])
    write(tools, "part.cdb", cdb(part))
    return ("stiff.matrix", "mass.matrix", "--dofs", "stiff.mapping", "--bulk",
            "part.cdb")


def ansys_market(part, tools):
    """*EXPORT, MMF: Matrix Market, and names by a file."""
    for name, A in ("K", part.K), ("M", part.M):
        rows = [(i, j, v) for i, j, v in part.entries(part.free(A)) if i >= j]
        write(tools, f"e{name}.mtx", [
            "%%MatrixMarket matrix coordinate real symmetric",
            f"{len(part.rows)} {len(part.rows)} {len(rows)}"]
            + [f"{i + 1} {j + 1} {v:.16e}" for i, j, v in rows])
    write(tools, "e.map", ["{} {}".format(*part.dof[r]) for r in part.rows])
    write(tools, "e.cdb", cdb(part))
    return "eK.mtx", "eM.mtx", "--dofs", "e.map", "--bulk", "e.cdb"


def record(data):
    return struct.pack("<i", len(data)) + data + struct.pack("<i", len(data))


def nastran_output4(part, tools):
    """Binary OUTPUT4, dense, six rows a grid, of which the deck holds those of
    the wall; rotations have no stiffness [Nastran1986]."""
    six = [6 * (r // 3) + r % 3 for r in range(len(part.K))]
    n = 6 * len(part.node)
    data = b""
    for name, A in (b"KGG     ", part.K), (b"MGG     ", part.M):
        full = numpy.zeros((n, n))
        full[numpy.ix_(six, six)] = A
        data += record(struct.pack("<4i", n, n, 6, 2) + name)
        for j in six:
            filled = numpy.flatnonzero(full[:, j])
            first, last = filled[0], filled[-1] + 1
            data += record(struct.pack("<3i", j + 1, first + 1,
                                       2 * (last - first))
                           + full[first:last, j].astype("<f8").tobytes())
        data += record(struct.pack("<3id", n + 1, 1, 2, 1.0))
    with open(tools.path("n.op4"), "wb") as file:
        file.write(data)
    write(tools, "n.bdf", bulk(part))
    return "n.op4:KGG", "n.op4:MGG", "--bulk", "n.bdf"


def real(value):
    """A number in a field of 16, without the letter of its exponent."""
    for digits in range(15, 0, -1):
        mantissa, exponent = f"{value:.{digits}e}".split("e")
        mantissa = mantissa.rstrip("0")
        text = mantissa + (f"{int(exponent):+d}" if int(exponent) else "")
        if len(text) <= 16:
            return text
    raise ValueError(value)


def nastran_dmig(part, tools):
    """One triangle in large fields [Nastran1986]."""
    lines = ["BEGIN BULK"]
    for name, A in ("KAAX", part.K), ("MAAX", part.M):
        lines.append(f"DMIG    {name:8s}{0:8d}{6:8d}{2:8d}{0:8d}")
        free = part.free(A)
        for j in range(len(free)):
            node, direction = part.dof[part.rows[j]]
            lines.append(f"DMIG*   {name:16s}{node:16d}{direction:16d}")
            for i in range(j, len(free)):
                node, direction = part.dof[part.rows[i]]
                if free[i, j] != 0.0 or i == j:
                    lines.append(f"*       {node:16d}{direction:16d}"
                                 f"{real(free[i, j]):>16s}")
    write(tools, "d.pch", lines)
    write(tools, "d.bdf", bulk(part))
    return "d.pch:KAAX", "d.pch:MAAX", "--bulk", "d.bdf"


# a writer, and half a unit of the last digit of 1.0 that it writes
SPELLINGS = [
    (nastran_output4, 0.0), (nastran_dmig, 5e-12), (calculix, 5e-14),
    (abaqus_coordinate, 5e-16), (abaqus_input, 5e-16), (substructure, 5e-16),
    (ansys, 0.0), (ansys_market, 0.0)]


def sparse(group):
    return scipy.sparse.csc_matrix(
        (group["data"][:], group["indices"][:], group["indptr"][:]),
        group.attrs["shape"]).toarray()


def read(path):
    """Matrices, dofs, grids and elements of a component, by their names."""
    with h5py.File(path) as f:
        found = {"K": sparse(f["K"]), "M": sparse(f["M"])}
        for name in ("dofs/grid", "dofs/component", "grids/id",
                     "grids/position", "elements/kind", "elements/first",
                     "elements/grids"):
            found[name] = f[name][:]
    return found


def compare(tap, title, first, found, rounding):
    for name, expected in first.items():
        if name in "KM":
            # entries are compared one by one; a zero is a zero in all
            error = numpy.abs(found[name] - expected)
            tap.check(found[name].shape == expected.shape
                      and (error <= rounding * 10.0 * numpy.abs(expected))
                      .all(),
                      f"{title}: {name}"
                      + ("" if rounding else " in every bit"))
        else:
            tap.check(numpy.array_equal(found[name], expected),
                      f"{title}: {name}")


def reduced(tools, name):
    """K and M of the component NAME.h5 after Guyan's reduction to its port."""
    tools("ritz-basis", "guyan", name + ".h5", "-o", "basis.h5")
    tools("ritz-reduce", name + ".h5", "basis.h5", "-o", "reduced.h5")
    with h5py.File(tools.path("reduced.h5")) as f:
        return f["K"][:], f["M"][:]


class Condensed:
    """T'KT and T'MT with T = [I; -K_ii^-1 K_ik] for the kept rows, and what
    rounding by e may change: e |T|'|K||T| for K, whose first variation with T
    is zero, and for M that of T too."""

    def __init__(self, K, M, kept, e):
        T = numpy.eye(len(K))[:, kept]
        inverse = numpy.linalg.inv(K[numpy.ix_(~kept, ~kept)])
        T[~kept] = -inverse @ K[numpy.ix_(~kept, kept)]
        self.K, self.M = T.T @ K @ T, T.T @ M @ T
        error = numpy.zeros_like(T)
        error[~kept] = abs(inverse) @ (abs(K) @ abs(T))[~kept] * e
        self.K_error = e * (abs(T.T) @ abs(K) @ abs(T)).max()
        self.M_error = (abs(T.T) @ abs(M) @ (e * abs(T) + 2 * error)).max()


def check_condensed(tap):
    """The substructure that Abaqus would write of two nodes of the free end,
    STIFFNESS and MASS condensed, is guyan."""
    part = Part(17)
    nodes = part.node[part.index[-1].ravel()[[0, -1]]]
    K, M = part.free(part.K), part.free(part.M)
    exact = Condensed(K, M, numpy.isin([part.dof[r][0] for r in part.rows],
                                       nodes), len(K) * EPSILON)
    with tempfile.TemporaryDirectory() as folder:
        tools = Tools(sys.argv[1], folder)
        K, M, *options = substructure(part, tools)
        tools("ritz-import", "--stiffness", K, "--mass", M, *options,
              "--port", "kept=" + ",".join(map(str, nodes)), "-o", "whole.h5")
        write(tools, "k.mtx", user_element(nodes, exact.K, exact.M))
        tools("ritz-import", "--stiffness", "k.mtx:STIFFNESS", "--mass",
              "k.mtx:MASS", *options, "-o", "kept.h5")
        with h5py.File(tools.path("kept.h5")) as f:
            found = {name: sparse(f[name]) for name in "KM"}
            rows = list(zip(f["dofs/grid"][:], f["dofs/component"][:]))
        K, M = reduced(tools, "whole")
    tap.check(rows == [(n, d) for n in nodes for d in (1, 2, 3)],
              "a condensed substructure has rows of kept nodes")
    for name, A, error in ("K", K, exact.K_error), ("M", M, exact.M_error):
        # and half a unit of the sixteenth digit of 1.0
        tap.near(found[name], A, error / abs(A).max() + 5.1e-16,
                 f"a condensed substructure is guyan: {name}")


def check_calculix(tap):
    """The substructure of data/substructure, which CalculiX 2.23 condensed, is
    guyan of the matrices that it stored, with 14 digits."""
    folder = DATA / "substructure"
    with tempfile.TemporaryDirectory() as scratch:
        tools = Tools(sys.argv[1], scratch)
        tools("ritz-import", "--stiffness", folder / "store.sti", "--mass",
              folder / "store.mas", "--dofs", folder / "store.dof", "--bulk",
              folder / "store.inp", "--port", "kept=13,16", "-o", "whole.h5")
        with h5py.File(tools.path("whole.h5")) as f:
            whole = Condensed(sparse(f["K"]), sparse(f["M"]),
                              numpy.isin(f["dofs/grid"][:], [13, 16]), 5e-14)
        write(tools, "unit.mtx", [f"{n},{d},{n},{d},1." for n in (13, 16)
                                  for d in (1, 2, 3)])
        tools("ritz-import", "--stiffness", folder / "part.mtx", "--mass",
              "unit.mtx", "--bulk", folder / "part.inp", "-o", "kept.h5")
        with h5py.File(tools.path("kept.h5")) as f:
            found = sparse(f["K"])
        K, _ = reduced(tools, "whole")
    # and half a unit of the thirteenth digit of 0.1
    tap.near(found, K, whole.K_error / abs(K).max() + 5.1e-13,
             "a substructure of CalculiX 2.23 is guyan")


def main():
    tap = Tap()
    for digits in 10, 17:
        first, part = None, Part(digits)
        for spelling, rounding in SPELLINGS:
            with tempfile.TemporaryDirectory() as folder:
                tools = Tools(sys.argv[1], folder)
                K, M, *options = spelling(part, tools)
                tools("ritz-import", "--stiffness", K, "--mass", M, *options,
                      "-o", "part.h5")
                found = read(tools.path("part.h5"))
            if first is None:
                first = found
                tap.check(numpy.array_equal(found["K"], part.free(part.K))
                          and numpy.array_equal(found["M"],
                                                part.free(part.M)),
                          f"{digits} digits: matrices are those written")
            else:
                compare(tap, f"{digits} digits, {spelling.__name__}", first,
                        found, rounding if digits > 10 else 0.0)
    check_condensed(tap)
    check_calculix(tap)
    tap.finish()


if len(sys.argv) != 2:
    sys.exit(__doc__)
main()
