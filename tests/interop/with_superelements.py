#!/usr/bin/python3 -s
"""with_superelements.py PROGRAMS - external superelements that ritz-export
writes are read by pyNastran and pyYeti: matrices to the bit, rows, grids and
frames; pyYeti's cbcheck passes."""
import io
import re
import shlex
import sys
import tempfile

from common import DATA, Block, Tap, Tools, skip

try:
    import h5py
    import numpy
    import pyNastran.op4.op4
    import scipy.io
    import scipy.sparse
    from pyNastran.bdf.bdf import BDF
    from pyyeti import cb
    from pyyeti.nastran import bulk, op4
except ImportError as missing:
    skip(missing)

ASSEMBLY = """$ pyNastran: is_superelements=True
ASSIGN INPUTT4='part.op4' UNIT=101
SOL 103
CEND
METHOD = 1
BEGIN BULK
EIGRL          1                      10
INCLUDE 'part.asm'
INCLUDE 'part.pch'
ENDDATA
"""


def dense(matrix):
    return numpy.asarray(matrix.todense() if hasattr(matrix, "todense")
                         else matrix)


def by_pynastran(path):
    found = pyNastran.op4.op4.read_op4(path, debug=None)
    return {name.upper(): dense(m.data) for name, m in found.items()}


def by_pyyeti(path):
    found = op4.read(path, into="dct", sparse=None)
    return {name.upper(): dense(m) for name, m in found.items()}


def read_reduced(path):
    """K, M and T with coordinates in the order of EXTRN, their dofs, the dofs
    of the component."""
    with h5py.File(path) as f:
        names = list(zip(map(int, f["dofs/grid"]),
                         map(int, f["dofs/component"])))
        column = f["columns/dof"][:]
        place, point = [], 1000
        for row in column:
            point += row < 0
            place.append(names[row] if row >= 0 else (point, 0))
        at = sorted(range(len(place)), key=place.__getitem__)
        K, M, T = (f[name][:] for name in "KMT")
    # an asymmetry of rounding is averaged away
    K, M = ((A + A.T)[numpy.ix_(at, at)] / 2.0 for A in (K, M))
    return K, M, T[:, at], [place[j] for j in at], names


def expected_outputs(T, names, ports):
    """Six rows for each grid; a direction that it has not is zero."""
    rows = []
    for grid in sorted(ports):
        for component in range(1, 7):
            at = (grid, component)
            rows.append(T[names.index(at)] if at in names
                        else numpy.zeros(T.shape[1]))
    return numpy.array(rows)


def check_matrices(tap, tools, title, ports):
    K, M, T, place, names = read_reduced(tools.path("reduced.h5"))
    due = {"KAA": K, "MAA": M, "VA": numpy.ones((len(K), 1)),
           "MUG1": expected_outputs(T, names, ports)}
    for options in [], ["--text"], ["--dense"], ["--text", "--dense"]:
        tools("ritz-export", "-q", "--to", "superelement", "--force", *options,
              "reduced.h5", "-o", "part.op4")
        style = " ".join(o.strip("-") for o in options) or "binary"
        for reader, read in (("pyNastran", by_pynastran),
                             ("pyYeti", by_pyyeti)):
            found = read(tools.path("part.op4"))
            tap.check(len(found) == 23
                      and list(found)[:4] == ["KAA", "MAA", "BAA", "K4XX"],
                      f"{title}, {style}: {reader} finds 23 members in order")
            same = all(
                found[name].shape == matrix.shape
                and (found[name] + 0.0).tobytes() == (matrix + 0.0).tobytes()
                for name, matrix in due.items())
            tap.check(same, f"{title}, {style}: {reader} reads them to the bit")
            tap.check(all(found[name].shape == (1, 1) and not found[name].any()
                          for name in found
                              if name not in (*due, "MES1", "MEF1")),
                      f"{title}, {style}: {reader} reads the others as a zero")
    return place


def check_deck_by_pynastran(tap, tools, title, block, place, axes):
    (tools.folder / "assembly.bdf").write_text(ASSEMBLY)
    model = BDF(debug=None)
    model.read_bdf(tools.path("assembly.bdf"), xref=False)
    part, = model.superelement_models.values()
    grids = sorted({grid for grid, component in place if component})
    modes = sorted(grid for grid, component in place if not component)
    bulk_of = model.sebulk[101]
    tap.check((bulk_of.superelement_type, bulk_of.method, bulk_of.unitno)
              == ("EXTOP4", "MANUAL", 101), f"{title}: pyNastran reads SEBULK")
    connected, = model.seconct.values()
    tap.check(list(connected.nodes_a) == list(connected.nodes_b)
              == grids + modes, f"{title}: pyNastran reads SECONCT")
    for where, deck in ("main deck", model), ("BEGIN SUPER", part):
        tap.check(sorted(deck.nodes) == grids
                  and sorted(deck.spoints) == modes,
                  f"{title}: pyNastran finds grids and points, {where}",
                  f"{len(grids)} grids, {len(modes)} points")
        deck.cross_reference()
        tap.near([deck.nodes[g].get_position() for g in grids],
                 [block[g] for g in grids], 1e-15,
                 f"{title}: pyNastran finds their places, {where}")
        tap.near([deck.nodes[g].cd_ref.beta() for g in grids],
                 [axes(g) for g in grids], 4e-15,
                 f"{title}: pyNastran finds their axes, {where}")
    a_set = sorted((node, int(c)) for card in part.asets
                   for node, cs in zip(card.node_ids, card.components)
                   for c in cs)
    tap.check(a_set == [at for at in place if at[1]],
              f"{title}: pyNastran reads ASET")
    tap.check(sorted(i for card in part.qsets for i in card.node_ids) == modes,
              f"{title}: pyNastran reads QSET1")


def check_deck_by_pyyeti(tap, tools, title, block, place, ports):
    tap.check([tuple(at) for at in bulk.rdextrn(tools.path("part.pch"))]
              == place, f"{title}: pyYeti reads EXTRN as the rows")
    uset, _, interface, kept = bulk.asm2uset(tools.path("part.asm"),
                                             try_rdextrn="pv_only")
    tap.check([at for at, k in zip(uset.index, kept) if k] == place,
              f"{title}: pyYeti joins the .asm and the .pch")
    grids = sorted({grid for grid, component in place if component})
    tap.near(uset.loc[(grids, 1), "x":"z"], [block[g] for g in grids], 1e-15,
             f"{title}: pyYeti finds their places")
    rows = bulk.rddtipch(tools.path("part.pch"), "TUG1")
    tap.check([tuple(at) for at in rows]
              == [(g, c) for g in sorted(ports) for c in range(1, 7)],
              f"{title}: pyYeti reads TUG1 as the rows of MUG1")
    return uset, interface


FORCES = ("m1a", "m2a", "m1b", "m2b", "v1", "v2", "axial", "torque")
STRESSES = ("sa1", "sa2", "sa3", "sa4", "axial", "sb1", "sb2", "sb3", "sb4")
BARS = (11, 23)  # elements whose rows are recovered


def write_rows(tools, columns):
    """Rows of forces and stresses of two bars; @return options for them."""
    random = numpy.random.default_rng(16)
    options = []
    for kind, items in ("force", FORCES), ("stress", STRESSES):
        (tools.folder / f"{kind}.rows").write_text("".join(
            f"{bar} cbar.{item}\n" for bar in BARS for item in items))
        scipy.io.mmwrite(tools.path(f"{kind}.mtx"),
                         random.standard_normal((2 * len(items), columns)),
                         precision=17)
        options += ["--recovery", f"{kind}={kind}.mtx", "--recovery-rows",
                    f"{kind}={kind}.rows"]
    return options


def check_recovery(tap, tools, place):
    """MES1 and MEF1 by both readers, their tables by pyYeti and pyNastran, and
    all of it by ritz-import."""
    with h5py.File(tools.path("reduced.h5")) as f:
        column, grid = f["columns/dof"][:], f["dofs/grid"][:]
        component = f["dofs/component"][:]
        key = [(int(grid[c]), int(component[c])) if c >= 0 else (10**9 + j, 0)
               for j, c in enumerate(column)]
        at = sorted(range(len(key)), key=key.__getitem__)
        due = {kind: f[f"quantities/{kind}/S"][:][:, at]
               for kind in ("stress", "force")}
    model = BDF(debug=None)
    model.read_bdf(tools.path("assembly.bdf"), xref=False)
    part, = model.superelement_models.values()
    for name, kind, items in (("ES1", "stress", STRESSES),
                              ("EF1", "force", FORCES)):
        for reader, read in (("pyNastran", by_pynastran),
                             ("pyYeti", by_pyyeti)):
            found = read(tools.path("part.op4"))[f"M{name}"]
            tap.check(found.shape == due[kind].shape
                      and found.tobytes() == due[kind].tobytes(),
                      f"recovery: {reader} reads M{name} to the bit")
        rows = bulk.rddtipch(tools.path("part.pch"), f"T{name}")
        tap.check([tuple(row) for row in rows]
                  == [(bar, k + 1) for bar in BARS for k in range(len(items))],
                  f"recovery: pyYeti reads T{name} as the rows of M{name}")
        fields = [x for x in part.dti[f"T{name}"].fields[2]
                  if x not in (None, "TYPE", "ID", "COMP", "ROW", "ENDREC")]
        n = len(items)
        tap.check([int(x) for x in fields]
                  == [34, BARS[0], n, 1, 34, BARS[1], n, n + 1],
                  f"recovery: pyNastran reads T{name}", f"{fields}")
    tools("ritz-import", "--superelement", "part.op4", "-o", "again.h5")
    with h5py.File(tools.path("again.h5")) as f:
        for kind, items in ("stress", STRESSES), ("force", FORCES):
            q = f[f"quantities/{kind}"]
            S = scipy.sparse.csc_matrix(
                (q["S/data"][:], q["S/indices"][:], q["S/indptr"][:]),
                q["S"].attrs["shape"]).toarray()
            tap.check((S == due[kind]).all() and S.shape[1] == len(place)
                      and [x.decode() for x in q["part"][:]]
                      == 2 * [f"cbar.{item}" for item in items],
                      f"recovery: ritz-import reads rows of kind {kind}")


def check_face(tap, tools):
    """Nine grids with three directions, some of them with axes of their own;
    one port that is not attached; rows to recover."""
    block = Block((4, 2, 2), turned=True)
    block.write(tools, "--port", "end=37-45", *write_rows(tools, block.n))
    tools("ritz-basis", "craig-bampton", "--attach", "face", "--modes", 6,
          "block.h5", "-o", "basis.h5")
    tools("ritz-reduce", "block.h5", "basis.h5", "-o", "reduced.h5")
    at = dict(zip(block.id, block.position))
    axes = {i: block.axes if t else numpy.eye(3)
            for i, t in zip(block.id, block.turned)}
    ports = [*block.port, *range(37, 46)]
    place = check_matrices(tap, tools, "face", ports)
    check_deck_by_pynastran(tap, tools, "face", at, place, axes.get)
    check_deck_by_pyyeti(tap, tools, "face", at, place, ports)
    check_recovery(tap, tools, place)


def check_hubs(tap, tools):
    """Two new grids of six directions, to which the ends are tied. cbcheck
    wants products of modes with the stiffness below 1e-12 and eigenvalues above
    1, whatever their units, so that the block is soft."""
    block = Block((4, 2, 2))
    block.K /= 3e3
    block.write(tools)
    tools("ritz-import", "--stiffness", "K.mtx", "--mass", "M.mtx", "--bulk",
          "block.bdf", "--dofs", "block.dofs", "--rigid-port", "root=1-9",
          "--rigid-port", "tip=37-45", "-o", "block.h5")
    tools("ritz-basis", "craig-bampton", "--attach", "root,tip", "--modes", 6,
          "block.h5", "-o", "basis.h5")
    tools("ritz-reduce", "block.h5", "basis.h5", "-o", "reduced.h5")
    with h5py.File(tools.path("block.h5")) as f:
        at = dict(zip(map(int, f["grids/id"]), f["grids/position"][:]))
    hubs = sorted(at)[-2:]
    place = check_matrices(tap, tools, "hubs", hubs)
    check_deck_by_pynastran(tap, tools, "hubs", at, place,
                            lambda grid: numpy.eye(3))
    uset, interface = check_deck_by_pyyeti(tap, tools, "hubs", at, place, hubs)
    found = by_pyyeti(tools.path("part.op4"))
    said = io.StringIO()
    done = cb.cbcheck(said, found["MAA"], found["KAA"], numpy.arange(12),
                      numpy.arange(6), uset[interface], uref=(0, 0, 0),
                      rb_norm=True)
    said = said.getvalue()
    lines = re.findall(r"^.*(?:Okay|CHECK!|PASS|FAIL).*$", said, re.M)
    tap.check(len(lines) > 4 and not re.search("CHECK!|FAIL|WARN|NOT", said),
              "hubs: pyYeti's cbcheck passes", f"{len(lines)} checks")
    check_other_writer(tap, tools, found, uset[interface], place)
    # motions of the grids as they are written; entries of T'KT are sums over
    # the dofs of the block, and are multiplied by distances up to 3
    rigid = numpy.zeros((len(place), 6))
    rigid[:12] = done.rbg
    K = found["KAA"]
    force = numpy.abs(K @ rigid).max() / numpy.abs(K).max()
    tap.check(force <= 3 * block.n * 2.3e-16,
              "hubs: the interface moves as a rigid body without forces",
              f"{force:.1e}")
    # T'MT is two such sums, and this product a third
    mass = done.rbg.T @ found["MAA"][:12, :12] @ done.rbg
    tap.near(numpy.diag(mass)[:3], numpy.full(3, block.M.sum() / 3.0),
             3 * block.n * 2.3e-16,
             "hubs: the mass is that of the block")


def check_other_writer(tap, tools, found, uset, place):
    """pyYeti writes the same superelement, which is imported."""
    bulk.wtextseout(tools.path("other"), se=7, bset=numpy.arange(12),
                    uset=uset, spoint1=1001, kaa=found["KAA"],
                    maa=found["MAA"], baa=found["MAA"] / 4.0)
    said = tools("ritz-import", "--superelement", "other.op4", "-o",
                 "other.h5")
    with h5py.File(tools.path("other.h5")) as f:
        dofs = list(zip(map(int, f["dofs/grid"]),
                        map(int, f["dofs/component"])))
        matrix = [scipy.sparse.csc_matrix(
            (f[name]["data"][:], f[name]["indices"][:], f[name]["indptr"][:]),
            f[name].attrs["shape"]).toarray() for name in "KMD"]
    tap.check(dofs == place and "rows named by  EXTRN" in said,
              "pyYeti's superelement: its rows are those of EXTRN")
    tap.check(all((A == due).all() for A, due in zip(
        matrix, [found["KAA"], found["MAA"], found["MAA"] / 4.0])),
              "pyYeti's superelement: K, M and D are read to the bit")


def check_page(tap, tools):
    """The commands and the deck of the page."""
    page = (DATA.parent / "docs/simulators.md").read_text(encoding="utf-8")
    page = re.search(r"^## NASTRAN\n(.*?)^## ", page, re.M | re.S)[1]
    (tools.folder / "data").symlink_to(DATA)
    for line in re.findall(r"^    (ritz-.*)$", page, re.M):
        tools(*shlex.split(line))
    deck = re.search(r"^```nastran\n(.*?)^```", page, re.M | re.S)[1]
    (tools.folder / "page.bdf").write_text(
        "$ pyNastran: is_superelements=True\n" + deck)
    model = BDF(debug=None)
    model.read_bdf(tools.path("page.bdf"), xref=True)
    part, = model.superelement_models.values()
    tap.check(sorted(model.nodes) == [1, 900] and list(model.sebulk) == [101]
              and sorted(part.nodes) == [1] and len(part.spoints) == 6
              and sorted(model.elements) == [900],
              "page: pyNastran reads the deck and what it includes")
    tap.near(model.elements[900].Length(), 2.0, 0.0,
             "page: the bar ends at the grid of the superelement")
    outputs = bulk.rddtipch(tools.path("part.pch"), "TUG1")
    tap.check({grid for grid, _ in outputs} == {1, 5},
              "page: displacements of grid 5 are there")


def main():
    tap = Tap()
    for check in check_face, check_hubs, check_page:
        with tempfile.TemporaryDirectory() as folder:
            check(tap, Tools(sys.argv[1], folder))
    tap.finish()


if len(sys.argv) != 2:
    sys.exit(__doc__)
main()
