#!/bin/sh
# shapes.sh FOLDER-OF-THE-TOOLS - mode shapes for viewers: elements out of a
# deck, and VTU and XDMF files as meshio and h5py read them.
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"
python='/usr/bin/python3 -s' # two words: the user's own packages stay out

if ! $python -c 'import meshio, h5py, numpy' 2>/dev/null; then
    echo 'ok 1 - shapes # skip python3-meshio or python3-h5py is missing'
    exit 0
fi

# --- a deck with every kind of element -----------------------------------------------

# Twenty grids of a brick and a scalar point; K = diag(1, 2, ...), M = I: mode k
# moves dof k alone, by 1, so that a shape is an axis of a displacement frame.
cat >deck.py <<'END'
corner = [(0,0,0),(1,0,0),(1,1,0),(0,1,0),(0,0,1),(1,0,1),(1,1,1),(0,1,1)]
edge = [(0,1),(1,2),(2,3),(3,0),(0,4),(1,5),(2,6),(3,7),(4,5),(5,6),(6,7),(7,4)]
xyz = corner + [tuple((a+b)/2 for a, b in zip(corner[i], corner[j]))
                for i, j in edge]
with open("brick.bdf", "w") as f:
    f.write("BEGIN BULK\nCORD2C,5,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n")
    for k, p in enumerate(xyz):
        f.write("GRID,%d,,%g,%g,%g%s\n" % (k+1, *p, ",5" if k == 2 else ""))
    f.write("SPOINT,500\n")
    f.write("CHEXA,1,1,1,2,3,4,5,6\n,7,8,9,10,11,12,13,14\n"
            ",15,16,17,18,19,20\n")
    f.write("CHEXA,2,1,1,2,3,4,5,6\n,7,8\n")
    f.write("CTETRA,3,1,1,2,4,5\nCTETRA,4,1,1,2,3,6,9,10\n,12,14,15,16\n")
    f.write("CPENTA,5,1,1,2,4,5,6,8\n")
    f.write("CQUAD4,6,1,1,2,3,4\nCTRIA3,7,1,1,2,3\nCTRIA6,8,1,1,2,3,9,10,12\n")
    f.write("CQUAD8,9,1,1,2,3,4,9,10\n,11,12\n")
    f.write("CBAR,10,1,1,2,0.,0.,1.\nCONROD,11,2,3,1,1.\nPLOTEL,12,3,4\n")
    f.write("CELAS2,13,1.,1,1,2,1\nCELAS2,14,1.,1,1\nRBE2,15,1,123,2\n")
    f.write("CBAR,16,1,1,999,0.,0.,1.\nCQUAD4,17,1,1,2,three,4\nENDDATA\n")
n = 121
for name, scale in ("K", lambda k: (k + 1.0) ** 2), ("M", lambda k: 1.0):
    with open(name + ".mtx", "w") as f:
        f.write("%%MatrixMarket matrix coordinate real symmetric\n")
        f.write("%d %d %d\n" % (n, n, n))
        for k in range(n):
            f.write("%d %d %.17g\n" % (k + 1, k + 1, scale(k)))
with open("brick.dofs", "w") as f:
    for k in range(120):
        f.write("%d %d\n" % (k // 6 + 1, k % 6 + 1))
    f.write("500 0\n")
END
$python deck.py
sed -i '/^RBE2/d' brick.bdf
expect 0 '13 elements for pictures; 2 left out' ritz-import --stiffness K.mtx \
    --mass M.mtx --bulk brick.bdf --dofs brick.dofs -o brick.h5

# mesh NAME FILE PYTHON: the expression is true of m, the mesh in the file.
mesh() {
    works "$1" $python - "$2" "$3" <<'END'
import sys, meshio, numpy as np
m = meshio.read(sys.argv[1])
cells = {c.type: c.data for c in m.cells}
def near(a, b):
    return np.abs(np.asarray(a) - np.asarray(b)).max() < 1e-14
sys.exit(0 if eval("(" + sys.argv[2] + ")") else
         f"{sys.argv[2]} fails: {m}\n{cells}\n{list(m.point_data)}")
END
}

expect 0 '121 shapes at 20 points, 13 elements; rotations as fields' \
    ritz-export --to vtu --modes 1-121 brick.h5 -o brick.vtu
expect 0 '1 points have no position and are left out' ritz-export --to vtu \
    brick.h5 --modes 1 -o one.vtu
mesh 'points are where the deck has them' brick.vtu 'm.points.shape == (20, 3)
    and near(m.points[6], [1, 1, 1]) and near(m.points[12], [0, 0, 0.5])
    and list(m.point_data["grid"]) == list(range(1, 21))'
mesh 'every kind of element is there' brick.vtu '
    {k: len(v) for k, v in cells.items()} == {"hexahedron20": 1,
    "hexahedron": 1, "tetra": 1, "tetra10": 1, "wedge": 1, "quad": 1,
    "triangle": 1, "triangle6": 1, "quad8": 1, "line": 4}'
mesh 'nodes between corners are on their edges' brick.vtu 'all(
    near(m.points[c[8 + k]], (m.points[c[a]] + m.points[c[b]]) / 2)
    for c in cells["hexahedron20"] for k, (a, b) in enumerate([(0,1),(1,2),
    (2,3),(3,0),(4,5),(5,6),(6,7),(7,4),(0,4),(1,5),(2,6),(3,7)]))'
mesh 'a mode moves its dof along its axis' brick.vtu 'near(
    m.point_data["mode 2, 0.3183 Hz"], np.eye(20)[:, :1] * [0, 1, 0]) and near(
    m.point_data["mode 6, 0.9549 Hz, rotations"],
    np.eye(20)[:, :1] * [0, 0, 1]) and
    near(m.point_data["mode 6, 0.9549 Hz"], 0)'
mesh 'a grid of cylindrical axes moves along its own' brick.vtu 'near(
    m.point_data["mode 13, 2.069 Hz"][2], np.array([1, 1, 0]) / 2 ** 0.5) and
    near(m.point_data["mode 17, 2.706 Hz, rotations"][2],
    np.array([-1, 1, 0]) / 2 ** 0.5)'
expect 1 'there is no mode 122, there are 121' ritz-export --to vtu \
    --modes 122 brick.h5 -o none.vtu
expect 1 "'x' is no part of a list of modes" ritz-export --to vtu --modes x \
    brick.h5 -o none.vtu
expect 2 'takes a model whole' ritz-export --to output4 --modes 1 brick.h5 -o x

# --- a universal file, by its columns --------------------------------------------------

expect 0 'six digits of each number are kept' ritz-export --to uff \
    --modes 2,13,121 brick.h5 -o brick.uff
works 'a mode is a data set of frequency and motion' $python - <<'END'
import numpy as np
parts = map(str.splitlines, open("brick.uff").read().split("    -1\n")[1::2])
sets = [(int(lines[0]), lines[1:]) for lines in parts]
assert [n for n, _ in sets if n != 82] == [15, 55, 55, 55], sets
modes = [lines for n, lines in sets if n == 55]
still, own = np.zeros((20, 6)), np.zeros((20, 6))
along = still.copy()
along[0, 1] = 1
own[2, :2] = 0.5 ** 0.5
for lines, hertz, u in zip(modes, (2, 13, 121), (along, own, still)):
    values = [float(lines[7][13 * k:13 * k + 13]) for k in range(4)]
    assert abs(values[0] - hertz / 2 / np.pi) < 5e-6 * hertz, values
    assert values[1:] == [1, 0, 0], values
    motion = np.array([[float(line[13 * k:13 * k + 13]) for k in range(6)]
                       for line in lines[9::2]])
    assert np.abs(motion - u).max() < 1e-5, motion
END
expect 0 '1 points have no position and are left out' ritz-export --to uff \
    brick.h5 --modes 1 -o one.uff

# --- XDMF: the same, by corners ------------------------------------------------------

expect 0 'numbers are in' ritz-export --to xdmf --modes 13,17 brick.h5 \
    -o 'a&b "<1>.xdmf'
mesh 'XDMF opens under a name of markup' 'a&b "<1>.xdmf' 'near(
    m.point_data["mode 13, 2.069 Hz"][2], np.array([1, 1, 0]) / 2 ** 0.5) and
    near(m.point_data["mode 17, 2.706 Hz, rotations"][2],
    np.array([-1, 1, 0]) / 2 ** 0.5) and m.points.shape == (20, 3)'
mesh 'with its cells' 'a&b "<1>.xdmf' 'sum(len(c.data) for c in m.cells) == 13
    and [list(c.data[0]) for c in m.cells if c.type == "hexahedron"][0]
    == list(range(8))'
expect 1 "holds ':'" ritz-export --to xdmf brick.h5 -o a:b.xdmf
works '  and neither file is written' test -z "$(find . -name 'a:b.xdmf*')"
mkdir taken.xdmf
expect 1 'not a regular file' ritz-export --to xdmf brick.h5 -o taken.xdmf
works '  nor the one beside' test ! -e taken.xdmf.h5

# --- a reduced component against NumPy ------------------------------------------------

import_body rotor -q --port bearing=1 -o rotor.h5
ritz-basis -q craig-bampton --modes 6 rotor.h5 -o basis.h5
ritz-reduce -q rotor.h5 basis.h5 -o small.h5
json 0 ritz-export --to xdmf --modes 7-9 small.h5 -o small.xdmf
holds '  names its shapes' 'len(j["shapes"]) == 3 and
    j["shapes"][0].startswith("mode 7, ")'
expect 0 '12 shapes' ritz-export --to vtu small.h5 -o small.vtu
cat >compare.py <<'END'
import h5py, meshio, numpy as np, scipy.linalg as sl
f = h5py.File("small.h5")
w, V = sl.eigh(f["K"][:], f["M"][:])
T, grid, direction = f["T"][:] @ V, f["dofs/grid"][:], f["dofs/component"][:]
frames, frame = f["grids/frames"][:], f["grids/frame"][:]
ids = list(f["grids/id"][:])
worst = 0.0
for name in "small.xdmf", "small.vtu":
    m = meshio.read(name)
    for k in range(6, 9):
        key = [n for n in m.point_data if n.startswith("mode %d," % (k + 1))]
        for field, first in zip(sorted(key), (1, 4)):
            u = np.zeros((len(ids), 3))
            for row in range(len(grid)):
                d = direction[row] - first
                if 0 <= d < 3:
                    g = ids.index(grid[row])
                    u[g] += frames[frame[g]][d] * T[row, k]
            got = m.point_data[field]
            pick = [ids.index(i) for i in m.point_data["grid"].ravel()]
            u = u[pick]
            sign = np.sign((u * got).sum())
            worst = max(worst, np.abs(sign * u - got).max() / np.abs(u).max())
    elements = f["elements/kind"][:]
    assert sum(len(c.data) for c in m.cells) == len(elements), m
# a few eps over the relative gap of these modes; measured 3e-12
print("agree" if worst < 1e-9 else worst)
END
expect 0 'agree' $python compare.py
for file in small.vtu small.xdmf; do
    expect 0 'error, estimated: ' cat $file
done
ritz-reduce -q --without-basis rotor.h5 basis.h5 -o bare.h5
expect 1 'without-basis' ritz-export --to vtu bare.h5 -o none.vtu
expect 0 'column' ritz-export --to vtu --modes 1,7 --component rotor.h5 basis.h5 \
    --json -o columns.vtu
mesh 'columns are called by their kind' columns.vtu '
    any(n.startswith("column 1 constraint") for n in m.point_data)
    and any(n.startswith("column 7 normal, ") for n in m.point_data)'
expect 1 'columns of a basis are no modes' ritz-export --to uff --modes 1,7 \
    --component rotor.h5 basis.h5 -o none.uff
expect 1 'name its component with --component' ritz-export --to vtu basis.h5 \
    -o none.vtu
expect 2 'for shapes of a basis' ritz-export --to output4 --component rotor.h5 \
    small.h5 -o none.op4

# --- no elements: points ---------------------------------------------------------------

printf '1 1\n1 2\n' >two.dofs
printf '%s\n' '%%MatrixMarket matrix coordinate real symmetric' '2 2 2' \
    '1 1 1' '2 2 4' >two.mtx
printf 'GRID,1,,2.,3.,4.\n' >two.bdf
ritz-import -q --stiffness two.mtx --mass two.mtx --dofs two.dofs \
    --bulk two.bdf -o two.h5
expect 0 'no elements are known' ritz-export --to xdmf two.h5 -o two.xdmf
ritz-export -q --to vtu two.h5 -o two.vtu
for file in two.xdmf two.vtu; do
    mesh "points alone open too, $file" $file 'near(m.points, [[2, 3, 4]]) and
        [c.type for c in m.cells] == ["vertex"]'
done
