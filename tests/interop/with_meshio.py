#!/usr/bin/python3 -s
"""with_meshio.py PROGRAMS - meshio opens shapes in VTU and XDMF files: grids,
bricks and the modes of the full matrices."""
import sys
import tempfile

import h5py  # meshio reads XDMF with it
import meshio
import numpy
import scipy.linalg

from common import Block, Tap, Tools

BRICKS = 4, 2, 2


def add_elements(tools):
    """Bricks of Block as CHEXA; grids are 1, 2, ... along z, then y, then x."""
    index = numpy.arange(numpy.prod(numpy.add(BRICKS, 1))).reshape(
        numpy.add(BRICKS, 1)) + 1
    lines, bricks = [], []
    for i, j, k in numpy.ndindex(*BRICKS):
        brick = [index[i + a, j + b, k + c] for a, b, c in
                 [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0),
                  (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]]
        bricks.append(brick)
        fields = ["CHEXA", len(bricks), 1] + brick
        lines.append(",".join(map(str, fields[:9])) + "\n,"
                     + ",".join(map(str, fields[9:])) + "\n")
    deck = tools.folder / "block.bdf"
    deck.write_text(deck.read_text().replace("ENDDATA\n",
                                             "".join(lines) + "ENDDATA\n"))
    return numpy.array(bricks)


def check(tap, tools, block, bricks, name):
    tools("ritz-export", "--to", name, "--modes", "7-9", "block.h5", "-o",
          "block." + name)
    mesh = meshio.read(tools.path("block." + name))
    tap.check(numpy.array_equal(mesh.points, block.position),
              f"{name}: points are the grids, in every bit")
    tap.check([c.type for c in mesh.cells] == ["hexahedron"]
              and numpy.array_equal(mesh.cells[0].data + 1, bricks),
              f"{name}: cells are the bricks")
    w2, Phi = scipy.linalg.eigh(block.K, block.M)
    for k in 7, 8, 9:
        field = [u for n, u in mesh.point_data.items()
                 if n.startswith(f"mode {k},")]
        tap.check(len(field) == 1, f"{name}: mode {k} has one field")
        u = numpy.array(field[0]).ravel()
        # a turned shape of a simple mode: rounding over the relative gap
        phi = Phi[:, k - 1] * numpy.sign(Phi[:, k - 1] @ u)
        tap.near(u, phi, 1e-9, f"{name}: mode {k} is that of eigh")


def main():
    tap = Tap()
    with tempfile.TemporaryDirectory() as folder:
        tools = Tools(sys.argv[1], folder)
        block = Block(BRICKS, turned=True)
        block.write(tools)
        bricks = add_elements(tools)
        tools("ritz-import", "--stiffness", "K.mtx", "--mass", "M.mtx",
              "--bulk", "block.bdf", "--dofs", "block.dofs", "-o", "block.h5")
        for name in "vtu", "xdmf":
            check(tap, tools, block, bricks, name)
    tap.finish()


if len(sys.argv) != 2:
    sys.exit(__doc__)
main()
