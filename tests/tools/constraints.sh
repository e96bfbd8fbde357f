#!/bin/sh
# Constraint elements and ports of grids that are made for them, as a user meets
# them: a brick of solid elements on a hinge.
# Usage: constraints.sh FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"

# --- a solid: eight-node bricks, 2 x 2 x 6 of them, E = 70e9, nu = 0.3 ---------

/usr/bin/python3 -s - <<'END'
import itertools

nx, ny, nz = 2, 2, 6
size = (0.2, 0.2, 1.2)
E, nu, rho = 70e9, 0.3, 2700.0
grid = lambda i, j, k: 1 + i + (nx + 1) * (j + (ny + 1) * k)
place = {grid(i, j, k): (size[0] * i / nx, size[1] * j / ny, size[2] * k / nz)
         for i in range(nx + 1) for j in range(ny + 1) for k in range(nz + 1)}
h = [size[0] / nx, size[1] / ny, size[2] / nz]
corners = list(itertools.product((0, 1), repeat=3))
lam, mu = E * nu / (1 + nu) / (1 - 2 * nu), E / 2 / (1 + nu)

def element():
    K = [[0.0] * 24 for _ in range(24)]
    M = [[0.0] * 24 for _ in range(24)]
    w = h[0] * h[1] * h[2] / 8
    for p in itertools.product((-1 / 3 ** 0.5, 1 / 3 ** 0.5), repeat=3):
        s = [(1 + x) / 2 for x in p]
        f = lambda c, a: s[a] if c[a] else 1 - s[a]
        N = [f(c, 0) * f(c, 1) * f(c, 2) for c in corners]
        dN = [[(1 if c[a] else -1) / h[a] * f(c, (a + 1) % 3) *
               f(c, (a + 2) % 3) for a in range(3)] for c in corners]
        for i in range(8):
            for j in range(8):
                dot = sum(dN[i][a] * dN[j][a] for a in range(3))
                for a in range(3):
                    M[3 * i + a][3 * j + a] += rho * N[i] * N[j] * w
                    for b in range(3):
                        K[3 * i + a][3 * j + b] += w * (
                            lam * dN[i][a] * dN[j][b] + mu * dN[i][b] *
                            dN[j][a] + (mu * dot if a == b else 0.0))
    return K, M

Ke, Me = element()
K, M = {}, {}
for i, j, k in itertools.product(range(nx), range(ny), range(nz)):
    dof = [3 * (grid(i + c[0], j + c[1], k + c[2]) - 1) + a
           for c in corners for a in range(3)]
    for A, Ae in ((K, Ke), (M, Me)):
        for r in range(24):
            for c in range(24):
                if dof[r] >= dof[c]:
                    at = dof[r], dof[c]
                    A[at] = A.get(at, 0.0) + Ae[r][c]

def write(name, A, row, n):
    with open(name, "w") as f:
        f.write("%%%%MatrixMarket matrix coordinate real symmetric\n"
                "%d %d %d\n" % (n, n, len(A)))
        for (r, c), v in sorted(A.items()):
            f.write("%d %d %.17g\n" % (row(r), row(c), v))

n = 3 * len(place)
write("k.mtx", K, lambda r: r + 1, n)
write("m.mtx", M, lambda r: r + 1, n)
# the same with six rows a grid, and a grid 64 amid the foot for an RBE2
six = lambda r: 6 * (r // 3) + r % 3 + 1
write("k6.mtx", K, six, 2 * n + 6)
write("m6.mtx", M, six, 2 * n + 6)
with open("brick.bdf", "w") as f:
    for g in sorted(place):
        f.write("GRID,%d,,%.17g,%.17g,%.17g\n" % ((g,) + place[g]))
with open("rbe2.bdf", "w") as f:
    f.write("INCLUDE 'brick.bdf'\nGRID,64,,.1,.1,0.\n"
            "RBE2,1,64,123,1,2,3,4,5\n,6,7,8,9\n")
with open("dofs", "w") as f:
    for g in sorted(place):
        for c in (1, 2, 3):
            f.write("%d %d\n" % (g, c))
END
solid='--stiffness k.mtx --mass m.mtx --bulk brick.bdf --dofs dofs'

# --- elements of the deck -------------------------------------------------------

expect 0 '18 rows eliminated, of dofs that depend on others: RBE2 101, RBE3 102, RBE2 103, MPC 9' \
    ritz-import --stiffness "$data/tied/kgg.mtx" --mass "$data/tied/mgg.mtx" \
    --bulk "$data/tied/tied.bdf" --port hub=10 --output-at head=11:1 -o tied.h5
expect 0 'recovered      18 dofs that follow from the others: grid 11 123456, grid 12 123456, grid 13 123456' \
    ritz-info tied.h5
json 0 ritz-info tied.h5
holds '  lists what is recovered' 'j["recovered"] == 18 and j["dofs"] == 24 and
    j["recovered_dofs"][0] == "grid 11 123456"'
expect 0 'the matrices are without what depends by RBE2 101' \
    ritz-import --stiffness "$data/tied/kaa.mtx" --mass "$data/tied/maa.mtx" \
    --bulk "$data/tied/tied.bdf" -o done.h5
expect 1 "'grid 13 T1' depends on RBE2 103 (" \
    ritz-import --stiffness "$data/tied/kgg.mtx" --mass "$data/tied/mgg.mtx" \
    --bulk "$data/tied/tied.bdf" --port arm=13:1 -o x.h5
expect 1 'attach what it follows, grid 4' \
    ritz-import --stiffness "$data/tied/kgg.mtx" --mass "$data/tied/mgg.mtx" \
    --bulk "$data/tied/tied.bdf" --port arm=13:1 -o x.h5
{ cat "$data/tied/tied.bdf" | sed '/ENDDATA/d'; echo 'RSPLINE,77,,4,13'; } \
    >spline.bdf
expect 1 'RSPLINE 77 is not understood: MPC, RBAR, RBE1, RBE2, RBE3 and RTRPLT are' \
    ritz-import --stiffness "$data/tied/kgg.mtx" --mass "$data/tied/mgg.mtx" \
    --bulk spline.bdf -o x.h5

# --- supports of the deck ---------------------------------------------------------

{ cat brick.bdf; printf 'SPC1,4,123,%d\n' 1 2 3; } >held.bdf
held=$(echo "$solid" | sed 's/brick/held/')
expect 0 '9 rows that the deck fixes removed: grid 1 T1, grid 1 T2, grid 1 T3, grid 2 T1, grid 2 T2, grid 2 T3, grid 3 T1, grid 3 T2, ...' \
    ritz-import $held -o held.h5
json 0 ritz-import $held -o held.h5
holds '  all of them in JSON' 'len(j["fixed"]) == 9 and
    j["fixed"][8] == "grid 3 T3" and j["removed"] == []'

# --- ports of a solid ------------------------------------------------------------

expect 0 "port 'foot' is the new grid 64, tied to 27 dofs" \
    ritz-import $solid --rigid-port foot=1-9 --input turn=64:3 \
    --output-at foot=64:3 --output-at top=63:1 -o rigid.h5
expect 0 'RBE2 1' ritz-import --stiffness k6.mtx --mass m6.mtx --bulk rbe2.bdf \
    --port foot=64 --input turn=64:3 --output-at foot=64:3 \
    --output-at top=63:1 -o rbe2.h5
json 0 ritz-info rigid.h5
cp log.json rigid.json
json 0 ritz-info rbe2.h5
holds '  a rigid port is the same as an RBE2, to the last bit' \
    'j["dofs"] == 168 and
     j["checksums"] == json.load(open("rigid.json"))["checksums"]'
expect 0 "port 'head' is the new grid 64, tied to 27 dofs" \
    ritz-import $solid --averaged-port head=55-63 -o averaged.h5
expect 0 'recovered      6 dofs' ritz-info averaged.h5
expect 1 'line=1-3: its dofs leave 1 of six motions open (do its grids lie on a line?): name more of them' \
    ritz-import $solid --averaged-port line=1-3 -o x.h5
expect 0 '0 fail' ritz-check averaged.h5

# free-free modes: as without a port, and above them with a rigid one
expect 0 'plain.h5' ritz-import $solid -o plain.h5
for body in averaged rigid plain; do
    json 0 ritz-basis macneal-rubin --modes 6 $body.h5 -o $body.b.h5
    cp log.json $body.json
done
# averaged and plain are the same pencil in other coordinates: 1e-9, measured
# 1e-13; a rigid foot adds 1.1e-4 to the first bending, measured
holds '  an averaged port stiffens nothing, a rigid one does' \
    '(lambda free, averaged, rigid: len(free) == 6 and
        near(averaged, free, 1e-9) and
        all(1.00005 * f < r < 1.001 * f for f, r in zip(free[:2], rigid)))(*(
        [x for x in m["frequencies_hz"] if x > 1][:6] for m in
        (j, json.load(open("averaged.json")), json.load(open("rigid.json")))))'
expect 0 'rigid.red.h5' ritz-reduce rigid.h5 rigid.b.h5 -o rigid.red.h5
expect 0 'at 64 nodes' ritz-export --to exudyn --force rigid.red.h5 -o rigid.hdf5
expect 0 'reference tangent' ritz-export --to exudyn --force --frame 64 \
    --reference tangent rigid.red.h5 -o rigid.hdf5
expect 0 'frame at the centre of mass' ritz-export --to exudyn --force \
    --frame centre --reference mean-axis rigid.red.h5 -o rigid.hdf5
expect 1 'grid 63 does not say how it turns' ritz-export --to exudyn --force \
    --frame 63 --reference tangent rigid.red.h5 -o rigid.hdf5
expect 1 'there is no such grid' ritz-export --to exudyn --force --frame 99 \
    rigid.red.h5 -o rigid.hdf5

# --- on a hinge --------------------------------------------------------------------

expect 0 "port 'tip' is the new grid 65" ritz-import $solid \
    --rigid-port root=1-9 --averaged-port tip=55-63 --input drive=64:4 \
    -o link.h5
cat >scene.yaml <<'END'
scene: two bricks
components:
  upper: {model: link.h5, basis: craig-bampton, modes: 30}
  lower: {model: link.h5, basis: craig-bampton, modes: 30}
joints:
  - {name: elbow, between: [upper/tip, lower/root], type: hinge, axis: [1, 0, 0], angles_deg: [0, 90]}
inputs: [{name: drive, at: upper/root, component: 4}]
outputs: [{name: angle, at: lower/root, component: 4}]
band_hz: [0, 3000]
damping: {modal: 0.01}
select: {by: hankel, tolerance: 1.0e-3}
END
json 0 ritz-assemble scene.yaml -o system.h5
cp log.json reduced.json
expect 0 'full.h5' ritz-assemble scene.yaml --full --at elbow=90 -o full.h5
json 0 ritz-info full.h5
# 189 - 27 + 6 dofs a brick, less five of the hinge; 27 + 6 recovered of each
holds '  the full system keeps what is recovered' \
    'j["dofs"] == 2 * 168 - 5 and j["recovered"] == 2 * 33'
json 0 ritz-basis macneal-rubin --modes 5 full.h5 -o free.h5
# one more rigid motion than a body has, and the system's frequencies at 90
# degrees are those of its full model, from above by 5e-3 at most (measured)
holds '  the hinge turns, and frequencies are those of the full model' \
    '(lambda s, f: sum(x < 1 for x in s) == 7 and sum(x < 1 for x in f) == 7 and
        all(-1e-6 < a / b - 1 < 5e-3 for a, b in zip(s[7:12], f[7:12])) and
        len(f) == 12)(
        json.load(open("reduced.json"))["configurations"][1]["frequencies_hz"],
        j["frequencies_hz"])'

printf '1..%d\n' "$count"
