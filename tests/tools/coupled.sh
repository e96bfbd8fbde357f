#!/bin/sh
# Ranking and COMPARE where damping couples modes: caged joints, a vehicle on
# dampers, poles at 0. SciPy computes the same values from the matrices in the
# containers.
# Usage: coupled.sh FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

# hankel.py MODEL AT RATIO: compute the values of the ranking in log.json in
# another way. Poles at 0 are removed by an ordered Schur form. Square roots of
# a product's eigenvalues lose half of the digits.
cat >hankel.py <<'END'
import json, sys
import h5py, numpy as np, scipy.linalg as sl

def text(a):
    return a.decode() if isinstance(a, bytes) else a

def hankel(A, B, C, slowest):
    T, Z, k = sl.schur(A, sort=lambda re, im=0: re < -1e-7 * slowest)
    if k < len(A):
        assert abs(np.linalg.eigvals(T[k:, k:])).max() < 1e-7 * slowest
        R = sl.solve_sylvester(T[:k, :k], -T[k:, k:], -T[:k, k:])
        A, B, C = (T[:k, :k], np.hstack([np.eye(k), -R]) @ Z.T @ B,
                   C @ Z[:, :k])
    P = sl.solve_continuous_lyapunov(A, -B @ B.T)
    Q = sl.solve_continuous_lyapunov(A.T, -C.T @ C)
    return np.sqrt(abs(np.sort(np.linalg.eigvals(P @ Q).real)[::-1]))

path, at, ratio = sys.argv[1], sys.argv[2], float(sys.argv[3])
rank = json.load(open("log.json"))
g = h5py.File(path)
if at != "-":
    g = next(c for c in g["configurations"].values()
             if text(c.attrs["at"]) == at)
lam, Phi = sl.eigh(g["K"][()], g["M"][()])
lam[lam < 1e-6] = 0.0
r = int((lam == 0).sum())
Delta = Phi.T @ g["D"][()] @ Phi + np.diag(2 * ratio * np.sqrt(lam))
Delta[abs(Delta) < 1e-12 * abs(Delta).max()] = 0.0
limit = g["outputs/limits"][()][:, None]
limit[np.isnan(limit)] = 1.0
C, Cv, Ca = (g["outputs/" + c][()] @ Phi / limit for c in ("C", "Cv", "Ca"))
B = Phi.T @ g["inputs/B"][()]

def values(modes):
    w = np.sqrt(np.where(lam[modes] > 0, lam[modes], 1.0))
    n, own = len(modes), Delta[np.ix_(modes, modes)]
    A = np.block([[np.zeros((n, n)), np.diag(w)],
                  [-np.diag(lam[modes] / w), -own]])
    return hankel(A, np.vstack([np.zeros((n, B.shape[1])), B[modes]]),
                  np.hstack([(C[:, modes] - Ca[:, modes] * lam[modes]) / w,
                             Cv[:, modes] - Ca[:, modes] @ own]),
                  np.sqrt(lam[r]))

own = np.sqrt(np.outer(np.diag(Delta), np.diag(Delta)))
near = abs(Delta) > 0.1 * own
near[:r], near[:, :r] = False, False
whole = values(np.arange(0 if abs(Delta[:r, r:]).any() else r, len(lam)))
exact = np.array(rank["system_values"])
assert len(exact) == len(whole), (len(exact), len(whole))
gap = abs(exact - whole).max() / whole[0]
assert gap < 1e-7, gap
label = np.arange(len(lam))
for i, j in zip(*np.nonzero(near)):
    label[label == label[j]] = label[i]
worst = 0.0
for one in set(label[r:]):
    modes = np.nonzero(label == one)[0]
    value = values(modes)[0]
    for k in modes[modes >= r] - r:
        assert rank["clusters"][k] - 1 == modes[modes >= r][0] - r
        if value > 1e-9 * whole[0]:
            worst = max(worst, abs(rank["values"][k] / value - 1))
print("largest difference of values", worst, "of exact ones", gap)
assert worst < 1e-9, worst
END

# --- a vehicle of five dofs on dampers ------------------------------------------
# Seat, body (heave and pitch) and two axles, in pounds, inches and seconds. A
# spring and a damper carry the seat 10 ahead of the body's centre; the axles
# are 40 ahead and 80 behind; tyres have k = 1500 and c = 5. The second vehicle
# has tyres without springs: only dampers hold it to the ground, and two poles
# are 0.

/usr/bin/python3 -s - <<'END'
import numpy as np, scipy.io
legs = [({0: 1, 1: -1, 2: -10}, 100, 10), ({1: 1, 2: 40, 3: -1}, 300, 25),
        ({1: 1, 2: -80, 4: -1}, 300, 25), ({3: 1}, 1500, 5), ({4: 1}, 1500, 5)]
def add(weights):
    A = np.zeros((5, 5))
    for (ends, _, _), weight in zip(legs, weights):
        b = np.array([ends.get(k, 0) for k in range(5)])
        A += weight * np.outer(b, b)
    return A
stiff = [k for _, k, _ in legs]
M = np.diag([290 / 386, 4500 / 386, 41000, 96.6 / 386, 96.6 / 386])
for name, A in (("M", M), ("K", add(stiff)), ("Kfree", add(stiff[:3] + [0, 0])),
                ("D", add([c for _, _, c in legs]))):
    scipy.io.mmwrite(name + ".mtx", A, precision=17)
END
for k in K Kfree; do
    expect 0 '' ritz-import -q --stiffness $k.mtx --mass M.mtx --damping D.mtx \
        --rows 0 --input front=4:0 --input rear=5:0 --output-at seat=1:0 \
        --output-at jolt=1:0/acc --output-at pitch=3:0@0.1 -o $k.h5
    expect 0 '' ritz-basis -q normal-modes --modes 5 --attach '' $k.h5 -o b.h5
    expect 0 '' ritz-reduce -q $k.h5 b.h5 -o $k.modes.h5
    json 0 ritz-rank $k.h5 -o values.h5
    cp log.json component.json
    json 0 ritz-rank $k.modes.h5 -o $k.ranking.h5
    holds '  has the exact values of the component, poles at 0 apart' 'near(
        [v / j["system_values"][0] for v in j["system_values"]],
        [v / j["system_values"][0]
         for v in json.load(open("component.json"))["system_values"]], 1e-11)'
    works '  and SciPy the same values' /usr/bin/python3 -s hankel.py \
        $k.modes.h5 - 0
done
holds '  dampers hold it: three flexible modes, eight states that decay' '
    len(j["values"]) == 3 and len(j["system_values"]) == 8'
json 0 ritz-rank K.modes.h5
holds '  a cluster has one value, and no pair of exact ones' '
    j["joined"] == 2 and j["difference"] is None and
    j["clusters"] == [1, 2, 3, 1, 2] and j["values"][0] == j["values"][3]'
expect 0 'damping joins 2 modes to others' ritz-rank K.modes.h5
expect 0 ' 1,4 ' ritz-info K.ranking.h5
expect 0 'by gregory' ritz-rank K.modes.h5 --by gregory,modal-cost,h2
expect 1 'over a band it must be mode by mode' ritz-rank K.modes.h5 \
    --by hankel-band --band-hz 0,5
expect 0 'response of the others is not bounded, since damping couples modes' \
    ritz-basis modal-balanced --modes 3 K.h5 -o b.h5
expect 1 '2 modes at 0.859208 Hz, and others that damping joins, are one cluster' \
    ritz-basis modal-balanced --modes 1 K.h5 -o b.h5

# --- both bearings caged at 0.25 Hz and 70 % [Sirlin1992] -----------------------

mkdir build
cp "$data/dualspin/caged.yaml" .
for name in rotor stator; do
    expect 0 '' import_body $name -q --port bearing=1 --port scan=5 \
        --units 'kg m s' -o build/$name.h5
done
expect 0 '' import_body platform -q --port scan=1 --units 'kg m s' \
    -o build/platform.h5
expect 0 '' ritz-assemble -q caged.yaml -o stage1.h5
for at in 0 60 120 180 240 300; do
    json 0 ritz-poles stage1.h5 --at clock=$at
    holds '  has two poles at 0.25 Hz and 70 %' '
        sum(abs(p["hertz"] - 0.25) < 0.005 and abs(p["zeta"] - 0.70) < 0.005
            for p in j["poles"]) == 2'
done
for at in 0 240; do
    json 0 ritz-rank stage1.h5 --at clock=$at
    works '  SciPy has the same values' /usr/bin/python3 -s hankel.py \
        stage1.h5 clock=$at,cone=0 0.002
done
json 0 ritz-compare caged.yaml -o caged.h5
holds '  keeps what damping joins, exact at all angles' 'j["joined"] > 30 and
    all(c["errors"]["frequency"] <= c["errors"]["frequency_allowed"] and
        c["errors"]["response"] < 1e-9
        for c in j["configurations"] if c["listed"])'
sed '/^damping/d' caged.yaml >bare.yaml
expect 1 'has no damping: every flexible mode needs a positive ratio' \
    ritz-compare bare.yaml -o bare.h5
sed 's/stiffness: 974, //' caged.yaml >drag.yaml
json 0 ritz-compare drag.yaml -o drag.h5
holds '  a bearing with a damper and no spring is no reason to refuse' 'all(
    c["rigid"] == 7 and c["errors"]["response"] < 1e-9
    for c in j["configurations"] if c["listed"])'
sed 's/by: hankel/by: modal-cost/' caged.yaml >cost.yaml
json 0 ritz-compare cost.yaml -o cost.h5
holds '  costs are mode by mode, and a smaller system has the response' '
    j["joined"] == 0 and sum(c["dofs"] for c in j["components"]) < 45 and
    all(c["errors"]["response"] < 1e-3 for c in j["configurations"])'

echo "1..$count"
