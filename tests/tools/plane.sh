#!/bin/sh
# A plane two-link arm, from matrices of beams to responses at several angles of
# its elbow, compared with an assembly in Python.
# Usage: plane.sh FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"

if ! /usr/bin/python3 -s -c 'import scipy, h5py' 2>/dev/null; then
    echo 'ok 1 - plane models # skip SciPy, meshio or h5py is missing'
    exit 0
fi

# Euler-Bernoulli beams along x with T1, T2 and R3. The upper arm turns about
# its root, where a hub is; the fore arm carries a payload.
cat >arm.py <<'END'
import numpy as np, scipy.io, scipy.sparse, scipy.linalg, json, sys

N, links = 6, {"upper": (1.2, 0.8, 60.0), "fore": (0.9, 0.5, 20.0)}
hub, payload, turning = 0.4, 0.7, 0.02

def beam(length, mass, EI, EA=1e5):
    h, n = length / N, 3 * (N + 1)
    K, M = np.zeros((n, n)), np.zeros((n, n))
    kb = EI / h**3 * np.array([[12, 6*h, -12, 6*h], [6*h, 4*h*h, -6*h, 2*h*h],
                               [-12, -6*h, 12, -6*h], [6*h, 2*h*h, -6*h, 4*h*h]])
    mb = mass * h / 420 * np.array(
        [[156, 22*h, 54, -13*h], [22*h, 4*h*h, 13*h, -3*h*h],
         [54, 13*h, 156, -22*h], [-13*h, -3*h*h, -22*h, 4*h*h]])
    for e in range(N):
        b, a = [3*e + i for i in (1, 2, 4, 5)], [3*e, 3*e + 3]
        K[np.ix_(b, b)] += kb
        M[np.ix_(b, b)] += mb
        K[np.ix_(a, a)] += EA / h * np.array([[1, -1], [-1, 1]])
        M[np.ix_(a, a)] += mass * h / 6 * np.array([[2, 1], [1, 2]])
    return K, M

def arm():
    K, M = zip(*(beam(*links[x]) for x in ("upper", "fore")))
    M[0][2, 2] += hub
    for i, m in zip((-3, -2, -1), (payload, payload, turning)):
        M[1][i, i] += m
    return K, M

def rows(name):
    return [(g, c) for g in range(1, N + 2) for c in (1, 2, 6)
            if name != "upper" or g > 1 or c == 6]

def write():
    for name, K, M in zip(links, *arm()):
        keep = [3*(g - 1) + (1, 2, 6).index(c) for g, c in rows(name)]
        for word, A in ("k", K), ("m", M):
            scipy.io.mmwrite(f"{name}.{word}.mtx",
                             scipy.sparse.coo_matrix(A[np.ix_(keep, keep)]),
                             symmetry="symmetric", precision=17)
        with open(f"{name}.dofs", "w") as f:
            f.writelines(f"{g} {c}\n" for g, c in rows(name))
        with open(f"{name}.bdf", "w") as f:
            f.writelines(f"GRID,{g},,{(g - 1) * links[name][0] / N:.12g},0.,0.\n"
                         for g in range(1, N + 2))

# The fore arm's matrices are turned by the angle of the elbow; its first two
# dofs are the upper arm's translations at the elbow, where a spring k acts.
def whole(degrees, k=0.0):
    (Ku, Kf), (Mu, Mf) = arm()
    n, a = len(Ku), np.radians(degrees)
    R = np.kron(np.eye(N + 1), [[np.cos(a), -np.sin(a), 0],
                                [np.sin(a), np.cos(a), 0], [0, 0, 1]])
    at = [n - 3, n - 2] + list(range(n, 2*n - 2))
    K, M = np.zeros((2*n - 2,) * 2), np.zeros((2*n - 2,) * 2)
    for A, u, f in (K, Ku, Kf), (M, Mu, Mf):
        A[:n, :n] += u
        A[np.ix_(at, at)] += R @ f @ R.T
    s = np.zeros(2*n - 2)
    s[n - 1], s[n] = -1, 1      # rotations: fore arm less upper arm
    K += k * np.outer(s, s)
    return K[2:, 2:], M[2:, 2:]

def hertz(degrees, k=0.0):
    w2 = scipy.linalg.eigh(*whole(degrees, k), eigvals_only=True)
    return np.sqrt(np.abs(w2)) / 2 / np.pi

# Rotations of the hub and of the payload due to a torque at the hub and one at
# the elbow, with `modal 0.01`.
def response(degrees, at):
    K, M = whole(degrees)
    w2, V = scipy.linalg.eigh(K, M)
    w2[:2] = 0
    n = 3 * (N + 1)
    B, C = np.zeros((len(K), 2)), np.zeros((2, len(K)))
    B[0, 0] = 1                          # hub: R3 of grid 1
    B[n - 3, 1], B[n - 2, 1] = -1, 1     # elbow
    C[0, 0] = 1
    C[1, -1] = 1
    out = []
    for x in at:
        w = 2 * np.pi * x
        q = (V.T @ B) / (w2 + 2j * 0.01 * np.sqrt(w2) * w - w*w)[:, None]
        out.append(C @ V @ q)
    return np.array(out)
END
/usr/bin/python3 -s -c 'import arm; arm.write()'
expect 0 '19 dofs' ritz-import --stiffness upper.k.mtx --mass upper.m.mtx \
    --dofs upper.dofs --bulk upper.bdf --port hub=1 --port tip=7 -o upper.h5
for link in fore; do
    expect 0 '21 dofs' ritz-import --stiffness $link.k.mtx --mass $link.m.mtx \
        --dofs $link.dofs --bulk $link.bdf --port root=1 --port tip=7 -o $link.h5
done

# scene NAME BASIS ELBOW KEY...: write NAME.yaml; ELBOW has keys of the elbow.
scene() {
    file=$1.yaml basis=$2 elbow=$3
    shift 3
    cat >"$file" <<END
scene: plane two-link arm
plane: xy
components:
  upper: {model: upper.h5, $basis}
  fore: {model: fore.h5, $basis}
joints:
  - {name: elbow, between: [upper/tip, fore/root], type: hinge, axis: [0, 0, 1], angles_deg: [0, 45, 110], $elbow}
inputs:
  - {name: shoulder, at: upper/hub, component: 6}
  - {name: motor, at: fore/root, component: 6, against: upper/tip}
outputs:
  - {name: hub, at: upper/hub, component: 6}
  - {name: hand, at: fore/tip, component: 6}
band_hz: [0, 40]
damping: {modal: 0.01}
END
    for key in "$@"; do echo "$key" >>"$file"; done
}

# near SENTENCE K COUNT TOLERANCE: at all angles, the lowest COUNT frequencies
# in log.json are those of Python with the stiffness K at the elbow.
near() {
    cat >near.py <<'END'
import arm, json, numpy as np, sys
k, most, tolerance = (float(x) for x in sys.argv[1:])
worst = 0.0
for c in json.load(open("log.json"))["configurations"]:
    degrees = float(c["at"].split("=")[1])
    got, due = np.array(c["frequencies_hz"]), arm.hertz(degrees, k)
    rigid = 1 if k else 2
    assert (got[:rigid] == 0).all() and (got[rigid:] > 0).all(), got
    n = int(min(most, len(got)))
    worst = max(worst, (abs(got - due[:len(got)]) / due.clip(due[rigid])[
        :len(got)])[rigid:n].max())
print(worst)
sys.exit(0 if worst < tolerance else f"off by {worst}")
END
    works "$1" /usr/bin/python3 -s near.py "$2" "$3" "$4"
}

scene free 'basis: full' 'state: free'
json 0 ritz-assemble free.yaml -o free.h5
# 38 dofs: an eigenvalue is off by n eps lambda_max / lambda_1, a frequency by
# half as much; 1e-11 was measured
near 'frequencies at every angle are those of the arm in Python' 0 40 1e-8
scene caged 'basis: full' 'state: caged, stiffness: 35'
json 0 ritz-assemble caged.yaml -o caged.h5
near '  and with a spring at the elbow' 35 40 1e-8
scene small 'basis: craig-bampton, modes: 4' 'state: free'
json 0 ritz-assemble small.yaml -o small.h5
near '  and of bodies of four modes within a percent' 0 6 1e-2

cat >respond.py <<'END'
import arm, h5py, numpy as np, sys
f = h5py.File("response.h5")
hertz = f["hertz"][:]
H = f["H/real"][:] + 1j * f["H/imag"][:]
due = arm.response(45, hertz)
off = (abs(H - due)[hertz > 0].max(axis=0) / abs(due)[hertz > 0].max(axis=0)).max()
print(off)
sys.exit(0 if off < 1e-8 else f"off by {off}")
END
expect 0 '' ritz-frf --at elbow=45 --from-hz 1 --points 60 free.h5 -o response.h5
works 'the response is that of the arm in Python' /usr/bin/python3 -s respond.py
expect 0 '38 dofs' ritz-assemble --full --at elbow=45 small.yaml -o whole.h5
expect 0 '' ritz-verify --at elbow=45 whole.h5 free.h5 --limit-frequency 1e-6 \
    --limit-response 1e-6 -o verified.h5
scene compare 'basis: macneal-rubin, modes: 5' 'state: free' \
    'select: {by: hankel, tolerance: 1.0e-3}' 'augment: system'
expect 0 '' ritz-compare compare.yaml -o compare.h5
expect 0 'mac' ritz-verify --at elbow=45 --band-hz 0,20 --limit-frequency 1e-2 \
    whole.h5 compare.h5 -o verified.h5

# --- what is checked ---------------------------------------------------------------------

sed '/^plane/d' free.yaml >space.yaml
expect 1 'holds one six-dof grid on each side, grid 7 of '\''upper/tip'\'' has no T3' \
    ritz-assemble space.yaml -o none.h5
expect 1 "are joined where the scene says 'plane: xy'" ritz-assemble space.yaml \
    -o none.h5
sed 's/^plane: xy/plane: xz/' free.yaml >wrong.yaml
expect 1 'wrong.yaml:7:71: the models lie in a plane, and the axis of a hinge must be' \
    ritz-assemble wrong.yaml -o none.h5
sed 's/axis: \[0, 0, 1\]/axis: [0, 1, 0]/' wrong.yaml >other.yaml
expect 1 "component 'upper': grid 1 R3 moves out of the plane xz" \
    ritz-assemble other.yaml -o none.h5
sed '4s/,0\.$/,0.3/' upper.bdf >bent.bdf
ritz-import -q --stiffness upper.k.mtx --mass upper.m.mtx --dofs upper.dofs \
    --bulk bent.bdf --port hub=1 --port tip=7 -o bent.h5
sed 's/upper\.h5/bent.h5/' free.yaml >bent.yaml
expect 1 'lie 0.3 apart across the plane xy' ritz-assemble bent.yaml -o none.h5

# --- inertias that a plane model does not have ------------------------------------

ritz-basis full fore.h5 -q -o basis.h5
ritz-reduce fore.h5 basis.h5 -q -o reduced.h5
expect 0 '0: not known, without translations across the axis' \
    ritz-info reduced.h5
/usr/bin/python3 -s - <<'END'
import arm, scipy.io, scipy.sparse
for word, A in zip("km", (x[1] for x in arm.arm())):
    keep = [i for i in range(len(A)) if i % 3 > 0]
    scipy.io.mmwrite(f"across.{word}.mtx", scipy.sparse.coo_matrix(
        A[keep][:, keep]), symmetry="symmetric", precision=17)
END
grep -v ' 1$' fore.dofs >across.dofs
ritz-import -q --stiffness across.k.mtx --mass across.m.mtx \
    --dofs across.dofs --bulk fore.bdf -o across.h5
ritz-basis full across.h5 -q -o basis.h5
ritz-reduce across.h5 basis.h5 -q -o reduced.h5
expect 0 '0: of a point, or not known, without translations across axes' \
    ritz-info reduced.h5
