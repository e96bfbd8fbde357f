#!/bin/sh
# Other tools take what ritz-compare and ritz-assemble write: a system at a
# configuration is reduced for a controller, exported, read by SciPy, checked
# and measured.
# Usage: systems.sh FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

if ! /usr/bin/python3 -s -c 'import scipy, meshio, h5py' 2>/dev/null; then
    echo 'ok 1 - systems go on # skip SciPy, meshio or h5py is missing'
    exit 0
fi

import_spacecraft --port boom=33
spacecraft scene 'inputs:' \
    '  - {name: motor, at: rotor/bearing, component: 6, against: stator/bearing}' \
    '  - {name: thruster, at: rotor/boom, component: 3}' 'outputs:' \
    '  - {name: gyro, at: platform/scan, component: 6, limit: 0.5}' \
    '  - {name: tip, at: rotor/boom, component: 3, quantity: velocity}' \
    '  - {name: shake, at: rotor/boom, component: 1, quantity: acceleration}' \
    'band_hz: [0, 4]' 'select: {by: band}' 'augment: system'
expect 0 '' ritz-compare scene.yaml --components small- -o system.h5
expect 0 '' ritz-frf --at clock=90 --to-hz 4 --points 50 --no-refine system.h5 \
    -o frf.h5

# --- which tools take a system, and what help and refusals say ----------------

for tool in basis reduce export check verify rank frf poles simulate; do
    expect 0 'configuration of a system' "ritz-$tool" --help
done
expect 0 'a system at a configuration (--at)' ritz-basis --list
expect 0 'also a system at a configuration (--at)' ritz-export --list
expect 1 'name one with --at' ritz-export --to matlab system.h5 -o none.mat
expect 1 'name one with --at' ritz-basis balanced --modes 4 system.h5 -o x.h5
expect 1 'no configuration is at' ritz-check --at clock=33 system.h5
expect 1 'is no system, --at has nothing to choose from' ritz-export \
    --to matlab --at clock=90 small-rotor.h5 -o none.mat
expect 2 '--states is not for it' ritz-export --to exudyn --states \
    --at clock=90 system.h5 -o none.h5
expect 1 'neither a reduced component nor a system: --damping is not for it' \
    ritz-export --to tsv --damping 'modal 0.1' frf.h5 -o none.tsv

# --- check -----------------------------------------------------------------------------

expect 0 'poles' ritz-check --at clock=90 system.h5

# --- export, and back by SciPy --------------------------------------------------------

export_at() {
    to=$1 out=$2
    shift 2
    expect 0 '' ritz-export -q --to "$to" --at clock=90 "$@" system.h5 -o "$out"
}
expect 0 'of stage two against stage one' ritz-export --to matlab --states \
    --at clock=90 system.h5 -o states.mat
export_at matlab modes.mat
export_at matrix-market 's-%.mtx' --states
export_at matrix-market 'm-%.mtx' --matrix K,M,D,B,C,Cv,Ca
export_at output4 modes.op4
expect 0 "damping 'modal 0.002' is in D" ritz-export --to output4 \
    --at clock=90 system.h5 -o again.op4
expect 0 "damping 'modal 0.002' is left out: D has it" ritz-export \
    --to matrix-market --at clock=90 system.h5 -o k.mtx
export_at container reduced.h5
export_at container states.h5 --states
cat >respond.py <<'END'
import h5py, numpy as np, scipy.io, sys
f = h5py.File("frf.h5")
hertz = f["hertz"][:]
H = f["H/real"][:] + 1j * f["H/imag"][:]
zeta = 0.002

def by_states(A, B, C, D):
    one = np.eye(len(A))
    return np.array([C @ np.linalg.solve(2j * np.pi * x * one - A, B) + D
                     for x in hertz])

def by_modes(K, M, B, C, Cv, Ca, D=None):
    if D is None: # the model states a ratio, not D
        D = 2 * zeta * np.diag(np.sqrt(np.diag(K).clip(0)))
    assert abs(K - np.diag(np.diag(K))).max() == 0
    assert abs(M - np.eye(len(M))).max() == 0
    out = []
    for x in hertz:
        w = 2 * np.pi * x
        out.append((C + 1j * w * Cv - w * w * Ca) @ np.linalg.solve(
            K + 1j * w * D - w * w * M, B))
    return np.array(out)

def off(G):
    # a free body has no response at 0 Hz
    keep = hertz > 0
    return (abs(G - H)[keep].max(axis=0) / abs(H)[keep].max(axis=0)).max()

m = scipy.io.loadmat("states.mat")
s = scipy.io.loadmat("modes.mat")
r = scipy.io.mmread
worst = {
    "MATLAB states": off(by_states(m["A"], m["B"], m["C"], m["D"])),
    "MATLAB": off(by_modes(*(s[k] for k in ("K", "M", "B", "C", "Cv", "Ca")))),
    "Matrix Market states": off(by_states(*(r(f"s-{k}.mtx") for k in "ABCD"))),
    "Matrix Market": off(by_modes(
        *(r(f"m-{k}.mtx") for k in ("K", "M", "B", "C", "Cv", "Ca", "D")))),
}
g = h5py.File("states.h5")
worst["container"] = off(by_states(*(g[k][:] for k in "ABCD")))
print(worst)
assert [str(x[0][0]) for x in m["input_names"]] == ["motor", "thruster"]
# 60 modes; A has entries up to w^2 of the highest: n eps times a condition of
# some 1e3 at the resonances; 1e-11 was measured
sys.exit(0 if max(worst.values()) < 1e-9 else "responses differ")
END
works 'SciPy computes the response of ritz-frf from each file' \
    /usr/bin/python3 -s respond.py
for file in reduced states; do
    expect 0 '' ritz-frf --points-of frf.h5 $file.h5 -o again.h5
    works "the $file of the container respond as the system" \
        /usr/bin/python3 -s - <<'END'
import h5py, numpy as np, sys
a, b = (h5py.File(x) for x in ("frf.h5", "again.h5"))
A, B = (x["H/real"][:] + 1j * x["H/imag"][:] for x in (a, b))
keep = a["hertz"][:] > 0
off = (abs(A - B)[keep].max(axis=0) / abs(A)[keep].max(axis=0)).max()
sys.exit(0 if off < 1e-9 else f"off by {off}")
END
done

expect 0 '3 matrices' ritz-info modes.op4
# a body has full M and K: its D includes the ratio as well
expect 0 "damping 'modal 0.01' is in D" ritz-export --to output4 --force \
    --damping 'modal 0.01' small-rotor.h5 -o rotor.op4
works '  and gives its poles this ratio' sh -c '
    n=$(ritz-info rotor.op4 --json | grep -o "\"rows\": [0-9]*" | head -n 1)
    n=${n##* }
    seq "$n" | sed "s/$/ 0/" >rotor.dofs
    ritz-import -q --stiffness rotor.op4:K --mass rotor.op4:M \
        --damping rotor.op4:D --dofs rotor.dofs -o rotor-d.h5
    ritz-poles --json rotor-d.h5 >log.json'
holds '  to rounding' \
    'len(j["poles"]) > 9 and all(abs(p["zeta"] - 0.01) < 1e-7 for p in j["poles"])'
expect 1 'wants a body with its grids' ritz-export --to exudyn --at clock=90 \
    system.h5 -o none.hdf5

# --- shapes, at the grids of the bodies ------------------------------------------------

shapes() {
    ritz-export --to vtu --at clock=90 --modes 9-12 system.h5 -o shapes.vtu "$@"
}
expect 1 'name the reduced component of '\''rotor'\'' with --component rotor=FILE' \
    shapes
expect 1 "of 'stator' with --component stator=FILE" shapes \
    --component rotor=small-rotor.h5
expect 1 "'rotor' has" shapes --component rotor=small-stator.h5 \
    --component stator=small-rotor.h5 --component platform=small-platform.h5
expect 1 '4 bodies are named by --component, there are 3' shapes \
    --component rotor=small-rotor.h5 --component stator=small-stator.h5 \
    --component platform=small-platform.h5 --component ship=small-rotor.h5
expect 0 '4 shapes at 52 points' shapes --component rotor=small-rotor.h5 \
    --component stator=small-stator.h5 --component platform=small-platform.h5
cat >shapes.py <<'END'
import h5py, meshio, numpy as np, sys
m = meshio.read("shapes.vtu")
grid = list(m.point_data["grid"].ravel())
f = h5py.File("system.h5")
k = [c for c in f["configurations"].values()
     if c.attrs["at"].decode().startswith("clock=90")][0]
names = [x.decode() for x in k["outputs/names"][:]]
assert sorted(set(grid)) == sorted(grid), "numbers of grids are not distinct"
keys = [x for x in m.point_data if x.startswith("mode") and x.endswith("Hz")]
bearing, axle, scan, plate, boom = (grid.index(n) for n in (1, 101, 105, 201, 33))
def near(a, b):
    assert np.abs(a - b).max() < 1e-9, (a, b)
near(m.points[bearing], m.points[axle])
near(m.points[scan], m.points[plate])
for j, key in enumerate(keys):
    u, turn = m.point_data[key], m.point_data[key + ", rotations"]
    near(u[bearing], u[axle])
    near(u[scan], u[plate])
    near(turn[bearing][:2], turn[axle][:2])       # the clock turns about z
    near(turn[scan][1:], turn[plate][1:])         # the cone about -x at 90 deg
    due = [k["outputs/Cv"][names.index("tip"), 8 + j],
           k["outputs/C"][names.index("gyro"), 8 + j]]
    near(np.abs(due), np.abs([u[boom][2], turn[plate][2]]))
    near(np.prod(due), u[boom][2] * turn[plate][2])
assert abs(turn[scan][0] - turn[plate][0]) > 1e-6
END
works 'joints hold and outputs measure what the shapes show' \
    /usr/bin/python3 -s shapes.py

# Bodies of an assembled system, which --components writes too.
expect 2 'there are none to write by --components' ritz-assemble --full \
    --components none- scene.yaml -o none.h5
expect 1 "'no/where-rotor.h5" ritz-assemble --components no/where- scene.yaml \
    -o none.h5
expect 0 '' ritz-assemble --components one- scene.yaml -o system1.h5
expect 1 'make its full model with ritz-assemble --full --at clock=0,cone=0' \
    ritz-export --to output4 --at clock=0 system1.h5 -o none.op4
json 0 ritz-assemble --components one- scene.yaml -o system1.h5
holds '  and named' 'j["component_files"] == ["one-rotor.h5", "one-stator.h5",
    "one-platform.h5"]'
expect 0 '4 shapes at 52 points' ritz-export --to vtu --at clock=0 --modes 9-12 \
    --component rotor=one-rotor.h5 --component stator=one-stator.h5 \
    --component platform=one-platform.h5 system1.h5 -o shapes.vtu
expect 1 "'rotor' has" ritz-export --to vtu --at clock=0 system1.h5 \
    --component rotor=small-rotor.h5 --component stator=one-stator.h5 \
    --component platform=one-platform.h5 -o none.vtu

# --- a low-order model for the controller -----------------------------------------------

expect 0 '' ritz-basis -q balanced --modes 12 --at clock=90 system.h5 -o basis.h5
json 0 ritz-basis balanced --modes 12 --at clock=90 system.h5 -o basis.h5
cat >hankel.py <<'END'
import json, numpy as np, scipy.io, scipy.linalg as sl, sys
s = scipy.io.loadmat("modes.mat")
K, B, C, Cv, Ca = (s[k] for k in ("K", "B", "C", "Cv", "Ca"))
w2 = np.diag(K)
flex = w2 > 1e-6 * w2.max() * 1e-6
w2, n = w2[flex], flex.sum()
D = np.diag(2 * 0.002 * np.sqrt(w2))
B, C, Cv, Ca = B[flex], C[:, flex], Cv[:, flex], Ca[:, flex]
limit = s["limits"].ravel()
scale = np.where(np.isnan(limit), 1, 1 / limit)[:, None]
A = np.block([[np.zeros((n, n)), np.eye(n)], [-np.diag(w2), -D]])
b = np.vstack([np.zeros_like(B), B])
c = scale * np.hstack([C - Ca @ np.diag(w2), Cv - Ca @ D])
Wc = sl.solve_continuous_lyapunov(A, -b @ b.T)
Wo = sl.solve_continuous_lyapunov(A.T, -c.T @ c)
due = np.sqrt(abs(np.sort(-np.real(sl.eigvals(Wc @ Wo))))[:40])
got = np.array(json.load(open("log.json"))["hankel_values"])[:40]
due = np.sort(due)[::-1]
off = abs(got - due)[:20] / due[:20]
print(got[:4], due[:4], off.max())
# an eigenvalue of the product is off by eps times the largest eigenvalue
sys.exit(0 if off.max() < 1e-6 else "Hankel values differ")
END
works 'Hankel values are those of Lyapunov equations by SciPy' \
    /usr/bin/python3 -s hankel.py
expect 0 '' ritz-reduce --at clock=90 system.h5 basis.h5 -o twelve.h5
expect 0 'balanced (modes 12, at clock=90,cone=0)' ritz-info twelve.h5
expect 0 'h-infinity-bound' ritz-verify --at clock=90 system.h5 twelve.h5 \
    -o verified.h5
expect 1 "'basis.h5' was made at clock=90,cone=0, not at clock=0,cone=0" \
    ritz-reduce --at clock=0 system.h5 basis.h5 -o none.h5
expect 0 'rank' ritz-rank --at clock=90 --by hankel system.h5
expect 0 '' ritz-basis -q normal-modes --modes 6 --at clock=90 system.h5 \
    -o modes.h5
expect 0 'frequency-relative' ritz-reduce --at clock=90 system.h5 modes.h5 \
    -o six.h5
expect 0 'mac' ritz-verify --at clock=90 system.h5 six.h5 --limit-frequency 1e-9 \
    -o verified.h5
expect 0 '' ritz-export --to matrix-market --matrix K six.h5 -o six.mtx
works '  and says what reduced it' grep -q '^% reduced component by Ritz .*: normal-modes' six.mtx

expect 0 'at clock=90,cone=0' ritz-basis full --at clock=90 system.h5 -o all.h5
expect 1 'was made at clock=90' ritz-reduce --at clock=0 system.h5 all.h5 -o x.h5

# --- a reduced component likewise ---------------------------------------------------------

expect 1 "whose ports are no dofs that craig-bampton could attach: --attach ''" \
    ritz-basis craig-bampton --modes 3 small-rotor.h5 -o none.h5
expect 0 '' ritz-basis -q normal-modes --modes 3 --attach '' small-rotor.h5 \
    -o basis.h5
expect 0 'port bearing' ritz-reduce small-rotor.h5 basis.h5 -o three.h5
expect 1 'comes from 243 dofs, the full one has' ritz-verify small-rotor.h5 \
    three.h5 -o none.h5
expect 0 '' ritz-verify --band-hz 0,1 rotor.h5 three.h5 -o verified.h5
expect 0 'shapes at' ritz-export --to vtu three.h5 -o three.vtu
