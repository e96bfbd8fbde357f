"""Makes the corpus of the fuzzer: a few small sound inputs for each target.

Usage: corpus.py FOLDER. FOLDER/TARGET/NAME is written; binary files are made
here, so that the repository holds none.
"""
import pathlib
import struct
import sys
import zlib

# --- matrices -------------------------------------------------------------------

OUTPUT4 = """\
       2       2       2       2KGG     1P,3E23.16
       1       1       2
 1.0000000000000000E+00-1.0000000000000000E+00
       2       1       2
-1.0000000000000000E+00 2.0000000000000000E+00
       3       1       1
 1.0000000000000000E+00
"""
OUTPUT4_SPARSE = """\
       2       2       2       2KGG     1P,3E23.16
       1       0       3
   65537
 1.0000000000000000E+00
       2       0       5
  131073
-1.0000000000000000E+00 2.0000000000000000E+00
       3       1       1
 1.0000000000000000E+00
"""
OUTPUT4_BIG = """\
       2      -2       6       1MGG     1P,5E16.9
       1       0       3
       2       1
 1.000000000E+00
       2       0       4
       3       1
 2.000000000E+00 0.000000000E+00
       3       1       1
 1.000000000E+00
"""


def output4_binary(swapped=False, complex_=False):
    order = ">" if swapped else "<"
    width = 2 if complex_ else 1

    def record(*parts):
        body = b"".join(parts)
        mark = struct.pack(order + "i", len(body))
        return mark + body + mark
    out = record(struct.pack(order + "4i", 2, 2, 2, 4 if complex_ else 2),
                 b"KGG     ")
    for column in (1, 2):
        values = [1.0 * column] * (2 * width)
        out += record(struct.pack(order + "3i", column, 1, 4 * width),
                      struct.pack(f"{order}{2 * width}d", *values))
    return out + record(struct.pack(order + "3i", 3, 1, 2),
                        struct.pack(order + "d", 1.0))


MARKET = {
    "symmetric": "%%MatrixMarket matrix coordinate real symmetric\n"
                 "% masses\n3 3 4\n1 1 2.5\n2 1 -1\n2 2 1e3\n3 3 4D0\n",
    "general": "%%MatrixMarket matrix coordinate integer general\n"
               "2 3 2\n1 3 7\n2 1 -1\n",
    "skew": "%%MatrixMarket matrix coordinate real skew-symmetric\n"
            "2 2 1\n2 1 3\n",
    "hermitian": "%%MatrixMarket matrix coordinate complex hermitian\n"
                 "2 2 2\n1 1 1 0\n2 1 1 -2\n",
    "pattern": "%%MatrixMarket matrix coordinate pattern general\n"
               "2 2 1\n2 2\n",
    "array": "%%MatrixMarket matrix array real general\n2 2\n1\n2\n3\n4\n",
    "lower": "%%MatrixMarket matrix array real symmetric\n2 2\n1\n2\n4\n",
}
COORDINATES = {
    "calculix": "1 1  8.1311303948298e+08\n1 2  0.0000000000000e+00\n"
                "2 2  1.2079857288409e+09\n1 3 -3.3714557439089e+00\n"
                "3 3  6.1462414988168e+08\n",
    "abaqus": "1 1  3.582994033916093e+10\n1 2  7.850217128178634e+09\n"
              "2 1  7.850217128178634e+09\n2 2  3.582994033916093e+10\n",
    "other": "\n 3 3 1.5D+3\r\n1 1 .5\n\n2 2\t-1\n",
}
DMIG = {
    "small": "DMIG,KAAX,0,6,2,0\n"
             "DMIG    KAAX           7       1               7       1    1.5\n"
             "DMIG    KAAX           7       2               7       1   -1.\n"
             "               7       2    2.5+3\n",
    "large": "DMIG    KAAX           0       6       2       0\n"
             "DMIG*   KAAX                           8               1\n"
             "*                      8               1         1.0D+03\n",
    "complex": "DMIG,B2PP,0,1,3,0\nDMIG,B2PP,1,1,,1,1,2.0,-1.0\n",
    "rectangular": "BEGIN BULK\nDMIG,PIN,0,9,1,0,,,2\nDMIG,PIN,1,,,3,1,1.0\n"
                   "DMIG,PIN,2,,,3,2,-1.0,,+A\n+A,4,1,2.0\nENDDATA\n",
}

MATRIX_INPUT = {
    "lower": "** nodes, directions, value\n101,1, 101,1,  9.89e+01\n"
             "101,2, 101,1,  3.57e+01\n101,2, 101,2,  9.89e+01\n",
    "both": "1,1,1,1,2.\n2,3,1,1,-1.\n1,1,2,3,-1.\n2,3,2,3,1.\n",
    "calculix": "         7,    3,         7,    3, 0.1000000000000E+03\n",
    "named": "*MATRIX INPUT, NAME=K, TYPE=SYMMETRIC, SCALE FACTOR=2.\n"
             "1,1,1,1,4.\n*MATRIX INPUT, NAME=D, TYPE=UNSYMMETRIC\n"
             "1,1,1,2,4.\n",
}
USER_ELEMENT = {
    "abaqus": "**\n*USER ELEMENT, NODES= 2, LINEAR\n** ELEMENT NODES\n"
              "** 7, 3\n1, 2\n2, 6\n*MATRIX,TYPE=STIFFNESS\n9.,\n-3., 8.\n"
              "1., 2., 7.\n*MATRIX,TYPE=MASS\n1.,\n0., 1.\n0., 0., 1.\n",
    "calculix": "** GENERATION OF SUBSTRUCTURE\n"
                "*USER ELEMENT,NODES=          2,LINEAR\n** ELEMENT NODES\n"
                "**         4,         4,\n         1\n         2,         3\n"
                "*MATRIX,TYPE=STIFFNESS\n 0.1000000000000E+03,\n"
                "-0.1000000000000E+02, 0.1000000000000E+03,\n",
    "wide": "*USER ELEMENT,LINEAR,NODES=1\n** ELEMENT NODES\n** 1\n"
            "1,2,3,4,5,6\n*MATRIX,TYPE=MASS\n1.\n0.,1.\n0.,0.,1.\n"
            "0.,0.,0.,1.\n0.,0.,0.,0.\n1.\n0.,0.,0.,0.\n0.,1.\n",
}


def mat_tag(kind, body):
    return struct.pack("<II", kind, len(body)) + body + b"\0" * (-len(body) % 8)


def mat_array(name, kind, dims, *parts, complex_=False, nzmax=0):
    flags = struct.pack("<II", kind | (0x800 if complex_ else 0), nzmax)
    return mat_tag(14, mat_tag(6, flags) +
                   mat_tag(5, struct.pack(f"<{len(dims)}i", *dims)) +
                   mat_tag(1, name) + b"".join(parts))


def mat_doubles(*values):
    return mat_tag(9, struct.pack(f"<{len(values)}d", *values))


def mat_wholes(*values):
    return mat_tag(5, struct.pack(f"<{len(values)}i", *values))


def mat_files():
    head = b"MATLAB 5.0 MAT-file".ljust(116) + b"\0" * 8 + b"\0\1IM"
    full = mat_array(b"A", 6, (2, 2), mat_doubles(1, 2, 3, 4))
    sparse = mat_array(b"S", 5, (3, 3), mat_wholes(0, 2, 1),
                       mat_wholes(0, 1, 2, 3), mat_doubles(1, 2, 3), nzmax=3)
    complex_ = mat_array(b"Z", 6, (1, 2), mat_doubles(1, 2),
                         mat_doubles(3, 4), complex_=True)
    small = mat_array(b"I", 8, (1, 2), mat_tag(1, b"\1\2"))
    names = mat_tag(5, struct.pack("<i", 8)) + mat_tag(1, b"A".ljust(8, b"\0"))
    struct_ = mat_array(b"sys", 2, (1, 1), names,
                        mat_array(b"", 6, (1, 1), mat_doubles(5)))
    text = mat_array(b"note", 4, (1, 2), mat_tag(16, b"hi"))
    return {
        "full": head + full,
        "sparse": head + sparse,
        "all": head + full + sparse + complex_ + small + struct_ + text,
        "packed": head + mat_tag(15, zlib.compress(full))[:8 + len(
            zlib.compress(full))] + sparse,
        "packed-struct": head + struct.pack("<II", 15, len(
            zlib.compress(struct_))) + zlib.compress(struct_),
    }


BOEING_HEAD = ("title".ljust(72) + "key     \n" +
               "             3             1             1             1\n"
               "%sA                        2             2             3\n"
               "(4I4)           (4I4)           (%s)\n"
               "   1   3   4\n   1   2   2\n")
BOEING = {
    "real": BOEING_HEAD % ("RS", "3E9.1") + "  1.0E+00  3.0D+00 -2.5+000\n",
    "complex": BOEING_HEAD % ("ch", "6F4.1") + " 1.0 0.0 3.0 4.0 2.0 0.0\n",
    "integer": BOEING_HEAD % ("iu", "3I2") + " 1 3-2\n",
}

FOREIGN = {
    "abaqus": "*HEADING\n*NODE\n1, 0., 0., 0.\n*ELEMENT, TYPE=B31\n1, 1, 2\n",
    "numpy": "\x93NUMPY\x01\x00v\x00{'descr': '<f8'}\n",
    "market": "%MatrixMarket matrix coordinate real general\n1 1 1\n1 1 1\n",
    "html": "<!DOCTYPE html>\n<html></html>\n",
    "ansys": "/PREP7\nN,1,0,0,0\nET,1,BEAM188\n",
}

# --- decks ------------------------------------------------------------------------

DECK = {
    "grids": "SOL 103\nCEND\nSPC = 7\nMPC = 8\nBEGIN BULK\n"
             "GRDSET,,,,,,,6\n"
             "CORD2R,1,0,0.,0.,0.,0.,0.,1.,+\n+,1.,0.,0.\n"
             "CORD2C,2,1,0.,0.,0.,0.,0.,1.,+C\n+C,1.,0.,0.\n"
             "GRID,1,,0.,0.,0.\nGRID,2,2,1.,30.,0.,1\n"
             "GRID*                  3               1             2.5\n"
             "*                    0.0\n"
             "SPOINT,11,12\nSPOINT,20,THRU,22\n"
             "SPC1,7,123,1\nSPC,7,2,4,0.0\nSPCADD,9,7\n"
             "ASET1,126,2,THRU,3\nQSET1,0,11,12\nENDDATA\n",
    "external": "BEGIN SUPER      102\n"
                "EXTRN          3  123456      11  123456\n"
                "            1001       0    1002       0\n"
                "EXTRN,20,THRU,22,2\nGRID,3\nGRID,11\nGRID,21\n"
                "ASET1,123456,3,11\nQSET1,0,1001,THRU,1002\n"
                "SPOINT      1001    THRU    1002\n",
    "constraints": "BEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\n"
                   "GRID,3,,0.,1.,0.\nGRID,4,,0.,0.,1.\n"
                   "RBE2,10,1,123456,2\n"
                   "RBE3,11,,4,123456,1.0,123,1,2,+\n+,3\n"
                   "RBAR,12,1,3,123456,,,123456\n"
                   "MPC,8,2,1,1.0,3,1,-1.0\nMPCADD,5,8\n"
                   "RBE1,13,1,123456,,,,,+\n+,UM,3,123\n"
                   "RROD,14,1,4,1\nENDDATA\n",
    "elements": "BEGIN BULK\nGRID,1\nGRID,2,,1.\nGRID,3,,1.,1.\n"
                "CBAR,1,1,1,2,0.,1.,0.\nCQUAD4,2,1,1,2,3,3\n"
                "CELAS2,3,10.,1,1,2,1\nCTRIA3,4,1,1,2,3\n"
                "CONM2,5,1,0,2.0\nCHEXA,6,1,1,2,3,1,2,3,+\n+,1,2\nENDDATA\n",
    "frames": "BEGIN BULK\nCORD1R,1,1,2,3\nCORD1S,4,3,2,1\n"
              "CORD2S,5,4,1.,0.,0.,0.,1.,0.,+\n+,0.,0.,1.\n"
              "GRID,1,,0.,0.,0.\nGRID,2,,0.,0.,1.\nGRID,3,,1.,0.,0.\n"
              "GRID,4,1,1.,1.,1.,5\nINCLUDE 'more.bdf'\nENDDATA\n",
    "inp": "** a comment\n*HEADING\ntext\n*NODE, NSET=ALL\n1, 0., 0., 0.\n"
           "2, 1.5\n3, 1., 1.\n4, , , 1.0D0\n"
           "*ELEMENT, TYPE=C3D4, ELSET=E\n1, 1, 2,\n 3, 4\n"
           "*NSET, NSET=EVEN, GENERATE\n2, 4, 2\n*NSET, NSET=BOTH\n1, EVEN\n"
           "*EQUATION\n2\n2, 1, 1., 3, 1, -0.5\n*BOUNDARY\nBOTH, 1, 2\n"
           "1, PINNED\n*INCLUDE, INPUT=more.inp\n*STEP\n"
           "*FREQUENCY, SOLVER=MATRIXSTORAGE\n2\n*END STEP\n",
    "cdb": "/COM,ANSYS\n/PREP7\nET,1,185\nET,2,21\nKEYOP,2,3,2\n"
           "NBLOCK,6,SOLID\n(3i5,6e9.2)\n"
           "    1    0    0 0.00E+00 1.00E+00 0.00E+00 3.00E+01\n"
           "    2    0    0 1.00E+00\n    3    0    0\n"
           "N,R5.3,LOC,-1,\nEBLOCK,19,SOLID\n(19i4)\n"
           "   1   1   1   1   0   0   0   0   8   0   1"
           "   1   2   3   3   1   2   3   3\n  -1\n"
           "TYPE,2\nEBLOCK,10\n(15i3)\n  2  1  1  1  0  2\n -1\n"
           "N,R5.3,LOC,4,1,2,3\nN,R5.3,ANG,4,90,0,0\n"
           "D,1,UX,0.0\nD,2,ALL,0.\nCE,R5.0,DEFI,1\nFINISH\n",
    "inp-part": "*Part, name=P\n*End Part\n*Assembly, name=A\n"
                "*Instance, name=P-1, part=P\n0., 0., 5.\n*Node\n1, 1., 2.\n"
                "7, 3., 4.\n8, 5.\n*Element, type=B32\n1, 1, 7, 8\n"
                "*Element, type=X9\n2, 1,\n7\n*Nset, nset=\"s, t\"\n7\n"
                "*End Instance\n*Nset, nset=R, instance=P-1\n1\n*TIE\na, b\n"
                "*End Assembly\n*Boundary\nP-1.1, 1, 3, 0.1\n"
                "P-1.\"s, t\", ENCASTRE\n"
                "*Step\n*MATRIX GENERATE, STIFFNESS,\nMASS\n*End Step\n",
}

# --- options of ritz-import, and their files ------------------------------------

K = MARKET["symmetric"]
IMPORT = {
    "calculix": "stiffness K\nmass K\ndofs D\nport tip=12:1\n"
                f">K\n{COORDINATES['calculix']}>D\n7.1\n7.2\n12.1\n",
    "dofs": "stiffness K\nmass K\ndofs D\nport tip=3:1\nport foot=1,2\n"
            "input u=3:1,2:1*-0.5\noutput y=3:1*2/vel@1e-3\n"
            "damper strut=1:1,3:1*4*0.5\nunits N/mm\n"
            f">K\n{K}>D\n# grid, direction\n1 1\n2 1\n3 1\n",
    "rows": f"stiffness K\nrows 1\ninput u=1:1\n>K\n{K}",
    "deck": "stiffness K\nmass K\nbulk B\ndofs D\nport tip=3\n"
            "averaged-port mean=1-2\nrigid-port hub=2,3\n"
            f">K\n{K}>D\n1 1\n2 1\n3 1\n>B\nBEGIN BULK\nGRID,1,,0.,0.,0.\n"
            "GRID,2,,1.,0.,0.\nGRID,3,,0.,1.,1.\nSPC1,1,1,1\nENDDATA\n",
    "external": f"stiffness K\nmass K\nbulk B\nport tip=9\n>K\n{K}"
                ">B\nBEGIN SUPER       7\nEXTRN,9,3,1001,THRU,1002,0\n"
                "GRID,9,,0.,2.,0.\nSPOINT,1001,THRU,1002\n",
    "complex": "stiffness P:K\nmass P:M\n>P\nDMIG,K,0,6,4,0\n"
               "DMIG,K,1,1,,1,1,3.,4.\nDMIG,M,0,6,2,0\nDMIG,M,1,1,,1,1,3.\n",
    "tied": f"stiffness K\ndofs D\nbulk B\n>K\n{K}>D\n1 1\n2 1\n3 1\n"
            ">B\nSOL 103\nCEND\nMPC=8\nBEGIN BULK\nGRID,1\nGRID,2,,1.\n"
            "GRID,3,,2.\nMPC,8,2,1,1.0,3,1,-1.0\nENDDATA\n",
    "recovery": f"stiffness K\nmass K\nrows 0\nrecovery stress=S,other\n"
                f"recovery-rows stress=N\n>K\n{K}"
                ">S\n%%MatrixMarket matrix array real general\n1 3\n1\n0\n2\n"
                ">N\n12 sx # first\n",
    "modal": "frequencies F\nratios R\ninput u=1:0*0.3,2:0*-1.2\n"
             "output-matrix C\noutput-names tip@1e-3\n"
             ">F\n%%MatrixMarket matrix array real general\n2 1\n0\n1.5\n"
             ">R\n%%MatrixMarket matrix array real general\n2 1\n0\n0.02\n"
             ">C\n%%MatrixMarket matrix array real general\n1 2\n1\n-1\n",
    "ratio": "frequencies F\nratios 0.02\n"
             ">F\n%%MatrixMarket matrix array real general\n1 3\n1\n2\n3\n",
    "matrices": f"stiffness K\nmass K\nrows 0\ninput-matrix B\n"
                "input-names a,b\noutput-matrix C\nvelocity-matrix C\n"
                f">K\n{K}>B\n%%MatrixMarket matrix array real general\n3 2\n"
                "1\n0\n0\n0\n1\n-1\n"
                ">C\n%%MatrixMarket matrix array real general\n1 3\n1\n1\n1\n",
    "named": f"stiffness P:KAAX\nport tip=7:12\n>P\n{DMIG['small']}",
}
STATE_SPACE = {
    "five": "matrices A=A,B=B,C=C,D=D,E=A\ninputs u\noutputs y@0.1\nunits m\n"
            ">A\n%%MatrixMarket matrix array real general\n2 2\n0\n-1\n1\n-2\n"
            ">B\n%%MatrixMarket matrix array real general\n2 1\n0\n1\n"
            ">C\n%%MatrixMarket matrix array real general\n1 2\n1\n0\n"
            ">D\n%%MatrixMarket matrix array real general\n1 1\n0\n",
    "output4": f"matrices A=P:KGG,B=P:KGG,C=P:KGG\n>P\n{OUTPUT4}",
}

# --- scenes, signals, options -----------------------------------------------------

SCENE = {
    "hinge": "# at: clock=30\n"
             "scene: rotor and stator\ncomponents:\n"
             "  stator: {model: stator.h5, basis: craig-bampton, modes: 6}\n"
             "  rotor: {model: rotor.h5, basis: rubin, up_to_hz: 30, "
             "attach: [bearing], damping: modal 0.01}\n"
             "joints:\n"
             "  - {name: clock, between: [stator/top, rotor/bearing], "
             "type: hinge, axis: [0, 0, 1], angles_deg: [0, 60, 120]}\n"
             "inputs: [{name: torque, at: rotor/bearing, component: 6, "
             "against: stator/top}]\n"
             "outputs: [{name: gyro, at: stator/top, component: 6, "
             "limit: 1.0e-3}]\n"
             "band_hz: [0, 10]\ndamping: {modal: 0.002}\n"
             "select: {by: hankel, tolerance: 1.0e-3}\n"
             "augment: {level: system, attached: [torque]}\n"
             "extraneous: out-of-band\n",
    "many": "# at: wrist=1,wrist.2=2,slide=0.5\n"
            "scene: arms\ncomponents:\n  a: {model: a.h5}\n"
            "  b: {model: b.h5, basis: rigid}\njoints:\n"
            "  - {name: wrist, between: [a/p, b/p], type: universal, "
            "axes: [[1, 0, 0], [0, 1, 0]], angles_deg: [0, 1], "
            "angles2_deg: [0, 2], state: [caged, free], stiffness: [1, 0]}\n"
            "  - {name: slide, between: [a/q, b/q], type: slider, "
            "axis: [1, 0, 0], positions: [0, 0.5]}\n"
            "  - {name: mount, between: [a/r, b/r], type: bushing, "
            "stiffness: [1, 1, 1, 1, 1, 1], damping: [0, 0, 0, 0, 0, 0]}\n"
            "  - {name: weld, between: [a/s, b/s], type: rigid, "
            "offset: [0, 0, 1]}\n"
            "configurations:\n  - {slide: 0.5, wrist: 1, wrist.2: 2}\n"
            "inputs: [{name: torque, at: a/p, component: [1, 2]}]\n"
            "outputs: [{name: tip, at: b/q, component: 3, quantity: velocity}]\n"
            "band_hz: [0, 10]\n"
            "damping: {bands: [[0, 5, 0.002], [5, 20, 0.005]]}\n"
            "select: {modes: [1, 2, 4]}\n"
            "augment: {level: component, attached: auto, "
            "among: [outputs, a/p:3], tolerance: 0.01}\n"
            "extraneous: {fate: compact, tolerance: 1.0e-3}\n"
            "composite: {tolerance: 1.0e-9, reference: "
            "[{slide: 0.5, wrist: 1, wrist.2: 2}]}\n",
    "plane": "scene: arm\nplane: xy\ncomponents: {a: {model: a.h5}, "
             "b: {model: b.h5, basis: krylov, modes: 4}}\njoints: [{name: "
             "elbow, between: [a/p, b/p], type: hinge, axis: [0, 0, 1]}]\n"
             "damping: {rayleigh_fit: [[1, 0.01], [10, 0.02]]}\n"
             "inputs: [{name: u, at: a/p, component: 6}]\n"
             "select: {by: krylov, vectors: 6, start: both}\n",
    "spin": "scene: blade\ncomponents:\n  a: {model: a.h5, stiffening: "
            "{spin_zz: z, spin_xy: c, tip: t}}\n"
            "spin: {axis: [0, 1, 2], through: [1, 0, 0], "
            "profile: [[0, 0], [1, 2.5], [3, -1]]}\nspin_model: ruthless\n",
    "ramp": "scene: s\ncomponents: {a: {model: a.h5}}\n"
            "spin: {axis: [0, 0, 1], ramp: {to: 6, seconds: 15}, "
            "negligible: 0.01}\n",
    "anchors": "scene: &x s\ncomponents: {a: {model: *x}}\n",
}
SIGNAL = {
    "step": "= step", "sine": "= sine:3*2.5", "chirp": "= chirp:0.1,20*-1",
    "table": "# t, u\n0\t0\n0.05, 1\n0.05 2\n1e0;-1\r\n",
}
RESPONSE_TABLE = {
    "bare": "0 1 0\n0.5 1 -1e-3\n",
    "polar": "# hertz\t|tip/push|\tdegrees\tsigma1\n0 1 0 1\n1;2,90 2\r\n",
    "four": "# hertz re(a/u) im(a/u) re(b/u) im(b/u) |a/v| degrees |b/v| "
            "degrees\n1 1 2 3 4 5 6 7 8\n# end\n2 1 2 3 4 5 6 7 8\n",
    "only": "# hertz magnitude degrees\n1 1 0\n2 1 -180\n",
}
TEXTS = {
    "damping": "damping modal 0.01\ndamping modes 0.01 0.02 0.005\n"
               "damping bands 0 10 0.01 10 20 0.02\ndamping rayleigh 0.1 1e-5\n"
               "damping fit 1 0.01 10 0.02\n",
    "choice": "choice shift_hz 0,5\nchoice loads inputs,outputs\n"
              "choice inner mass\nchoice interface_modes 8\n"
              "choice gramian inputs\nchoice damping modal 0.01\n"
              "choice engine low-rank\nchoice among_hz 50\n"
              "choice band_hz 0,10\nchoice remainder static\nchoice sides two\n",
    "others": "tolerance frequency=1e-3,mac=0.99,gain=1e-6\ntolerance 0.01\n"
              "weights torque=1,gyro=0.5\nchannels a,b,c@0.5\n"
              "damper strut=4*0.5\ndamper strut=1e3\nunits kg m s\nunits 126\n"
              "constraints baumgarte:alpha=1,beta=2e3\nconstraints index-2\n",
}

# --- tools ----------------------------------------------------------------------------

CLAIMS = {
    "all": "source [Blevins2016] table 1\n"
           "beam b --elements 4 --clamp left --directions 26 --tip-mass 1 # b\n"
           "rows r 3 126\ntext scene.yaml\n  scene: x\n    indented\n"
           "expect frequencies_hz[0] 0.5 rel 1e-6\n"
           "expect frequencies_hz[1] as beta 1.0 2.0 abs 0.1\n"
           "expect measures[static-gain-relative].value below 1e-6\n"
           "expect ok is true\nexpect order is 12\n"
           "expect failure \"rigid-body motion\"\n",
    "skip": "source '$HERE x'\nneed $DATA/lund/k.mtx\nexpect order is 12\n"
            "try ritz-basis --list\n",
}
RECORDS = {
    "fit": '{"tool": "ritz-fit", "method": "rubin", "subject": "a", "order": 8,'
           ' "errors": {"frequency-relative": 1e-4, "missing-modes": 0},'
           ' "tolerance": {"frequency-relative": 1e-3}, "chosen": true}\n'
           '{"tool": "ritz-fit", "method": "guyan", "subject": "a", "order": 4,'
           ' "errors": {"frequency-relative": 1e-2}, "feasible": false,'
           ' "cost": {"seconds_per_second": 0.5, "integrator": "rk"}}\n',
    "verify": '{"tool": "ritz-reduce", "command": "ritz-reduce a.h5 b.h5 -o '
              'r.h5", "method": "rubin", "order": 8, "seconds": {"cpu": 0.25}}\n'
              '{"tool": "ritz-verify", "command": "ritz-verify a.h5 r.h5", '
              '"inputs": ["12  a.h5", "34  r.h5"], "method": "rubin", "order": '
              '8, "errors": {"response-relative": 1e-3}, "estimates": {}}\n\n',
}
HEAD = "track\tconfiguration\tmode\thertz\tmac\n"
TRACKS = {
    "sweep": HEAD + "1\tclock=0\t1\t0.5\tnan\n1\tclock=60\t1\t0.6\t0.99\n"
                    "2\tclock=0\t2\t1.5\tnan\n2\tclock=60\t2\t1.25\t0.5\n",
    "two": HEAD + "1\ta=0,b=1\t1\t0.5\tnan\n1\ta=1,b=2\t1\t0.6\t1\n",
}

# --- command lines: words, then files; models are samples, see fuzz_commands.c ----

ROWS = "".join(f"{k}\t{0.5 * k}\n" for k in range(40))
INITIAL = {
    "mode": "mode:3*0.1\ntorque=step*2\n",
    "file": f"F\nforce at the tip=sine:3*1e-3\n>F\n# value, rate\n{ROWS}",
    "values": "F\n>F\n" + "1.5;\r\n" * 40,
    "signal": "mode:1\ntorque=S\nforce at the tip=chirp:0.1,20\n"
              ">S\n0 0\n0.5 1\n",
}
TRACK_ROWS = "".join(
    f"{m}\tclock={60 * c},cone=0\t{m}\t{m}.5\t{'nan' if c == 0 else 0.99}\n"
    for m in (1, 2, 3) for c in (0, 1, 2))
RANK_TRACKS = {
    "all": HEAD + TRACK_ROWS,
    "missing": HEAD + TRACK_ROWS[:120],
    "other": HEAD + "1\tclock=0,cone=0\t1\t0.5\tnan\n7\tat\t9\t1\t1\n",
}


HISTORY = {
    "exudyn": "#Exudyn sensor\n0,1,2,10,20,100,200\n0.5,-1,-2,-10,-20,1e2,0\n",
    "fmpy": '"time","v[1]","q[1]","q[2]","v[2]","push"\n0,10,1,2,20,7\n'
            "0.25, 11,1.5,2.5,21, 8\n",
    "mbdyn": "       2.1 1 10 100\n       2.4 2 20 200\n       3.1 9 9 9\n"
             "       2.1 -1 -10 -100\n       2.4 -2 -20 -200\n",
    "columns": "# q: 2,4\n0 1 2 3 4\n1\t1 2 3 4\n",
    "names": "# q: x*\ntime x1 x2\n0 1 2\n",
}


ROW_TABLE = {
    "fixed": "BEGIN SUPER      102\n"
             "DTI     TES1    2\n"
             "        TYPE    ID      COMP    ROW     TYPE    ID      COMP    ROW"
             "\n        34      11      9       1       34      23      9       "
             "10\n        95      7       2       19      ENDREC\n",
    "free": "DTI,TUG1,2,,1,3,6,1\n,2,1001,6,7,ENDREC\n"
            "DTI,TEF1,2,,2,9,77,1\n,ENDREC\nDTI,TEF1,3,,2,9,ENDREC\n",
}


FRAMES = {
    "frame": '<VTKFile type="UnstructuredGrid">\n<Piece NumberOfPoints="2" '
             'NumberOfCells="1">\n<DataArray Name="displacement">\n0 0 1\n0 0 2'
             '\n</DataArray>\n<CellData>\n<DataArray Name="stress">\nnan\n'
             '</DataArray>\n</CellData>\n<DataArray Name="Points">\n'
             '0 0 0 1 0 0\n</DataArray>\n<DataArray Name="connectivity">\n0 1'
             '\n</DataArray>\n<DataArray Name="offsets">\n2\n</DataArray>\n'
             '<DataArray Name="types">\n3\n</DataArray>\n</Piece>\n',
    "list": '<VTKFile type="Collection">\n<DataSet timestep="0" part="0" '
            'file="m.frames/000000.vtu"/>\n<DataSet timestep="0.5" '
            'file="m.frames/000001.vtu"/>\n</VTKFile>\n',
}


def command(*words, **files):
    lines = [*words, *(f">{name}\n{text}" for name, text in files.items())]
    return "\n".join(lines) + "\n"


COMMANDS = {
    "simulate": command("ritz-simulate", "r.h5", "--seconds=10", "-o", "o",
                        "--input", "torque=step", "--damping", "modal 0.01",
                        "--damper", "strut=10*3", "--band-hz", "0,10",
                        "--hold=zero", "--every", "4"),
    "recover": command("ritz-recover", "t.h5", "--component", "r.h5",
                       "--modes=acceleration", "--to", "xdmf", "--every", "3",
                       "--maxima=m", "--table", "t", "--damping", "modal 0.01",
                       "--damper", "strut=10*3", "-o", "o"),
    "recover-table": command("ritz-recover", "F", "--component=r.h5", "--q",
                             "2-10", "--v=3-11", "--a=v*", "--f", "push",
                             "--step=0.1", "--label", "2", "--transform",
                             "modes", "--table=t", F="0 1 2 3\n"),
    "recover-system": command("ritz-recover", "t.h5", "--component=r.h5",
                              "--system", "s.h5", "--body=rotor", "--at",
                              "clock=60,cone=0", "--table=t"),
    "poles-scan": command("ritz-poles", "c.h5", "--scan",
                          "strut=0:10:0.5*1:2:1", "--mode", "3", "--tsv"),
    "poles-scan-one": command("ritz-poles", "c.h5", "--scan=strut=0:10:1",
                              "--scan=strut=*0:1e3:10"),
    "poles-tune": command("ritz-poles", "c.h5", "--tune", "each=0.1:10*1:20",
                          "--place", "2", "--among", "3", "--low-pass",
                          "10:6"),
    "poles-norm": command("ritz-poles", "s.h5", "--at", "clock=60,cone=0",
                          "--norm", "--low-pass=10:6", "--json"),
    "rank": command("ritz-rank", "s.h5", "--by=gregory,hankel", "--at",
                    "clock=120,cone=0", "--input-weights", "torque=4",
                    "--output-weights", "gyro=2,encoder=1", "--damping",
                    "modal 0.01", "--damping", "bands 0 5 0.01 5 20 0.02",
                    "--record", "R"),
    "rank-compare": command("ritz-rank", "--compare", "k.h5", "k.h5",
                            "--top", "3"),
    "frf": command("ritz-frf", "r.h5", "--to-hz", "20", "--log", "-o", "o",
                   "--singular-values", "--input-size", "torque=2",
                   "--points", "50"),
    "frf-loop": command("ritz-frf", "r.h5", "--to-hz", "20", "-o", "o",
                        "--controller", "x.h5", "--connect", "gyro=torque",
                        "--connect", "encoder=force at the tip",
                        "--feedback=positive"),
    "basis": command("ritz-basis", "loaded-interface", "c.h5",
                     "--attach", "tip,base", "--neighbour",
                     "tip=c.h5:base", "--modes", "6", "-o", "o"),
    "basis-attach": command("ritz-basis", "-oo", "rubin", "c.h5", "--attach=",
                            "--up-to-hz=30", "--loads", "inputs,outputs"),
    "export": command("ritz-export", "c.h5", "--to=vtu", "--modes", "1-6,9",
                      "-o", "o"),
    "export-matrix": command("ritz-export", "r.h5", "--to", "matrix-market",
                             "--matrix", "K,M", "-oo"),
    "export-superelement": command("ritz-export", "r.h5", "--id", "9",
                                   "--to=superelement", "--text", "--digits",
                                   "12", "-o", "o.op4", "--damping",
                                   "modal 0.01"),
    "export-dmig": command("ritz-export", "r.h5", "--to=dmig", "--numbered",
                           "--force", "-oo"),
    "export-bodies": command("ritz-export", "s.h5", "--to", "xdmf", "--at",
                             "clock=0,cone=0", "--component", "stator=r.h5",
                             "--component", "rotor=r.h5", "-oo"),
    "verify": command("ritz-verify", "c.h5", "r.h5", "-o", "o",
                      "--limit-frequency", "1e-3", "--band-hz", "0,10"),
    "reduce": command("ritz-reduce", "c.h5", "b.h5", "-qoo", "--without-basis"),
    "fit": command("ritz-fit", "F", "--tolerance",
                   "frequency=1e-3,mac=0.99", "--methods",
                   "craig-bampton,rubin,compare", "-oo", F=SCENE["hinge"]),
    "compare": command("ritz-compare", "F", "--tolerances", "1e-9,1e-6",
                       "--extraneous=out-of-band", "-oo", "--components", "p-",
                       "--report", "R", F=SCENE["hinge"]),
    "assemble": command("ritz-assemble", "F", "--at", "slide=0.5,wrist=1",
                        "-oo", F=SCENE["many"]),
    "import": command("ritz-import", "--stiffness=K", "--mass", "K", "--rows",
                      "1", "--input", "u=3:1,2:1*-0.5", "--output-at",
                      "y=3:1*2@1e-3", "--port", "tip=3:1", "--damper",
                      "strut=1:1,3:1*4*0.5", "--units", "N mm", "-oo", K=K),
    "import-superelement": command(
        "ritz-import", "--superelement", "K", "--port", "tip=7", "-oo",
        K="BEGIN SUPER 5\nEXTRN,7,12,1001,0\nGRID,7\nSPOINT,1001\n"
          + DMIG["small"] + "DMIG,MAAX,0,6,2\nDMIG,MAAX,7,1,,7,1,2.\n"),
    "info": command("ritz-info", "--json", "F", "--", "c.h5", F=OUTPUT4),
    "check": command("ritz-check", "r.h5", "--order=3"),
    "list": command("ritz-basis", "--list"),
    "help": command("ritz-frf", "--help"),
    "wrong": command("ritz-poles", "--dampr", "x"),
    "long-low-pass": command("ritz-poles", "c.h5", "--norm", "--low-pass",
                             100 * "1" + ":" + 100 * "2"),
    "long-scan": command("ritz-poles", "c.h5", "--scan",
                         "strut=1:2:3:4:5:6:7*" + 9 * "8:" + "9"),
    "long-neighbour": command("ritz-basis", "loaded-interface", "c.h5",
                              "--neighbour",
                              80 * "p" + "=c.h5:" + 80 * "q", "-oo",
                              "--modes=6"),
    "long-names": command("ritz-rank", "s.h5", "--by", 80 * "n" + ",hankel",
                          "--at", 70 * "c" + "=" + 70 * "0",
                          "--input-weights", 80 * "t" + "=1"),
    "long-loop": command("ritz-frf", "r.h5", "--to-hz", "20", "-o", "o",
                         "--controller", "x.h5", "--connect",
                         80 * "g" + "=" + 80 * "t"),
    "long-bodies": command("ritz-compare", "F", "-oo", "--components",
                           300 * "p", "--extraneous", 80 * "k",
                           F=SCENE["hinge"]),
    "long-input": command("ritz-import", "--stiffness=K", "--rows", "1",
                          "--input", 80 * "u" + "=" + "1:1*2,9999:6*-1e300",
                          "-oo", K=K),
    "short": command("ritz-poles", "c.h5", "-qhx", "--modes=1e3"),
}

# --- HDF5: a letter for the kind, then commands ------------------------------------

CONTAINER = {letter: letter.encode() for letter in "abcdefghABCDEFGH"}
CONTAINER.update({
    f"{letter}-{what}": letter.encode() + edits for letter in "abcdefgh"
    for what, edits in {
        "value": b"\x05\x00\x00\x01\x00\x09",
        "attribute": b"\x00\x01\x02\x01\x01\x00\x01\x0a",
        "member": b"\x04\x02\x00\x02\x03\x03\x04\x01\x02\x03\x04",
        "absent": b"\x06\x03", "other": b"\x03\x04\x07"}.items()})
MAT_HDF5 = {f"{name}-{k}": bytes([k]) + edits for k in range(5)
            for name, edits in {
    "sound": b"", "value": b"\x05\x00\x00\x01\x00\x09",
    "member": b"\x04\x02\x00\x02\x03\x03\x04\x01\x02\x03\x04",
    "attribute": b"\x02\x01\x00\x01\x09\x00\x01\x0a", "absent": b"\x03\x03",
}.items()}

# --- FMUs: the fuzzer mends the checksum ------------------------------------------

def fmu_numbers(sizes, states, numbers):
    return b"RITZFMU1" + bytes(8) + b"0" * 64 + struct.pack(
        f"<4q{len(sizes)}q{len(numbers)}d", 1, 1, states, len(sizes), *sizes,
        *numbers)


FMU = {
    "oscillator": fmu_numbers([0], 2, [4, 0.1, 0, 1, 1, 0, 0, 1, 1]),
    "dense": fmu_numbers([2], 2, [0, -4, 1, -0.1, 0, 1, 1, 0, 0, 1, 1]),
    "both": fmu_numbers([1, 0], 3, [-1, 9, 0, 2, 0, 1, 1, 1, 1, 0.5, 1, 1, 1]),
    "empty": fmu_numbers([], 0, [3]),
}

CORPUS = {
    "output4": {"dense": OUTPUT4, "sparse": OUTPUT4_SPARSE, "big": OUTPUT4_BIG,
                "two": OUTPUT4 + OUTPUT4_BIG, "binary": output4_binary(),
                "swapped": output4_binary(True),
                "complex": output4_binary(False, True)},
    "matrix-market": MARKET, "coordinates": COORDINATES, "dmig": DMIG,
    "harwell-boeing": BOEING, "matrix-input": MATRIX_INPUT,
    "user-element": USER_ELEMENT, "mat": mat_files(), "mat-hdf5": MAT_HDF5,
    "matrices": {**FOREIGN, **MARKET, **COORDINATES, **DMIG, **BOEING,
                 "output4": OUTPUT4, "matrix-input": MATRIX_INPUT["named"],
                 "user-element": USER_ELEMENT["abaqus"]},
    "deck": DECK, "fmu": FMU, "import": IMPORT, "state-space": STATE_SPACE,
    "container": CONTAINER, "scene": SCENE, "signal": SIGNAL,
    "response-table": RESPONSE_TABLE,
    "history": HISTORY, "frames": FRAMES, "texts": TEXTS,
    "row-table": ROW_TABLE,
    "claims": CLAIMS, "records": RECORDS, "tracks": TRACKS,
    "commands": COMMANDS, "initial": INITIAL, "rank-tracks": RANK_TRACKS,
}


def main():
    for target, inputs in CORPUS.items():
        folder = pathlib.Path(sys.argv[1]) / target
        folder.mkdir(parents=True, exist_ok=True)
        for name, content in inputs.items():
            if isinstance(content, str):
                content = content.encode("latin-1")
            (folder / name).write_bytes(content)


main()
