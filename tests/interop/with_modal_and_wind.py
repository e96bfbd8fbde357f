#!/usr/bin/python3 -s
"""with_modal_and_wind.py PROGRAMS - modes as a universal file are read by pyuff
to six digits, and a superelement for OpenFAST by openfast-io to the bit."""
import sys
import tempfile

import h5py
import numpy
import pyuff
import scipy.linalg
from openfast_io.FAST_reader import InputReader_OpenFAST

from common import Block, Tap, Tools


def check_modes(tap, tools, block):
    said = tools("ritz-export", "--to", "uff", "--modes", "7-10", "block.h5",
                 "-o", "block.uff")
    tap.check("six digits" in said, "uff: ritz-export says what is lost")
    sets = pyuff.UFF(tools.path("block.uff")).read_sets()
    nodes = [s for s in sets if s["type"] == 15]
    modes = [s for s in sets if s["type"] == 55]
    units = [s for s in sets if s["type"] == 164]
    tap.check(len(nodes) == 1 and len(modes) == 4 and len(units) == 1,
              "uff: pyuff finds units, nodes and four modes")
    tap.check(units[0]["units_code"] == 1 and units[0]["length"] == 1.0,
              "uff: pyuff reads SI units")
    tap.near(numpy.array([nodes[0][a] for a in "xyz"]).T, block.position,
             5.1e-6, "uff: pyuff reads the positions")
    w2, Phi = scipy.linalg.eigh(block.K, block.M)
    hertz = numpy.sqrt(w2[6:10]) / (2.0 * numpy.pi)
    tap.near([s["freq"] for s in modes], hertz, 5.1e-6,
             "uff: pyuff reads the frequencies of eigh")
    for k, s in enumerate(modes):
        u = numpy.array([s["r1"], s["r2"], s["r3"]]).T.ravel()
        phi = Phi[:, 6 + k] * numpy.sign(Phi[:, 6 + k] @ u)
        tap.near(u, phi, 1e-5, f"uff: pyuff reads the shape of mode {7 + k}")
        tap.check(s["mode_n"] == 7 + k and s["modal_m"] == 1.0,
                  "uff: with its number and modal mass")


def write_pillar(tools):
    """A chain of four grids with six springs between them."""
    rng, n = numpy.random.default_rng(3), 24
    K, M = numpy.zeros((n, n)), numpy.diag(rng.uniform(1.0, 2.0, n))
    for k in range(3):
        G = numpy.hstack([-numpy.eye(6), numpy.eye(6)])
        G[1, 5], G[2, 4] = -1.0, 1.0  # rotations of the first end
        at = numpy.arange(6 * k, 6 * k + 12)
        K[numpy.ix_(at, at)] += 1e3 * G.T @ G
    for name, A in ("K", K), ("M", M):
        with open(tools.path(f"p{name}.mtx"), "w") as f:
            f.write("%%MatrixMarket matrix array real general\n24 24\n")
            f.writelines(f"{v!r}\n" for v in A.T.ravel().tolist())
    with open(tools.path("pillar.bdf"), "w") as f:
        f.write("BEGIN BULK\n" + "".join(
            f"GRID,{k + 1},,{float(k)},0.,0.\n" for k in range(4))
            + "ENDDATA\n")
    with open(tools.path("pillar.dofs"), "w") as f:
        f.writelines(f"{k // 6 + 1} {k % 6 + 1}\n" for k in range(n))


def check_superelement(tap, tools):
    write_pillar(tools)
    tools("ritz-import", "--stiffness", "pK.mtx", "--mass", "pM.mtx", "--bulk",
          "pillar.bdf", "--dofs", "pillar.dofs", "--port", "top=4", "--units",
          "kg m s", "-o", "pillar.h5")
    tools("ritz-basis", "craig-bampton", "--modes", 5, "pillar.h5", "-o",
          "pbasis.h5")
    tools("ritz-reduce", "pillar.h5", "pbasis.h5", "-o", "preduced.h5")
    tools("ritz-export", "--force", "--to", "openfast", "preduced.h5", "-o",
          "pillar.dat")
    reader = InputReader_OpenFAST()
    reader.fst_vt["ExtPtfm"]["FlexASCII"] = {}
    reader.read_Superelement(tools.path("pillar.dat"))
    found = reader.fst_vt["ExtPtfm"]["FlexASCII"]
    with h5py.File(tools.path("preduced.h5")) as f:
        for name, key in ("M", "MassMatrix"), ("K", "StiffnessMatrix"):
            tap.check(numpy.array_equal(found[key], f[name][:]),
                      f"openfast-io reads {name} to the bit")
    tap.check(found["nDOF"] == 11 and not found["DampingMatrix"].any()
              and not found["WeightConstant"].any()
              and not found["WeightStiffness"].any(),
              "openfast-io reads 11 dofs, no damping and no weight")


def main():
    tap = Tap()
    with tempfile.TemporaryDirectory() as folder:
        tools = Tools(sys.argv[1], folder)
        block = Block((4, 2, 2))
        block.write(tools, "--units", "kg m s")
        check_modes(tap, tools, block)
        check_superelement(tap, tools)
    tap.finish()


if len(sys.argv) != 2:
    sys.exit(__doc__)
main()
