#!/bin/sh
# Charts of several channels and of systems: singular values, decibels,
# likeness by masses and by inputs and outputs.
# Usage: chart_systems.sh FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"
. "$here/svg.sh"
command -v gnuplot >/dev/null || {
    echo 'ok 1 - charts are drawn # SKIP gnuplot is not installed'
    echo '1..1'
    exit 0
}

# --- several channels: singular values and decibels ---------------------------

# stator NAME MORE...: the same with ports and channels
stator() {
    name=$1
    shift
    expect 0 '' import_body stator -q --port bearing=1 --port scan=5 "$@" \
        -o "$name"
}
stator two.h5 --input torque=1:6 --input push=1:1 --output-at turn=5:6 \
    --output-at slide=5:1
stator one.h5 --input torque=1:6 --output-at turn=5:6 --output-at slide=5:1
expect 0 '' ritz-basis -q craig-bampton --modes 8 --attach bearing one.h5 \
    -o basis.h5
expect 0 '' ritz-frf -q --from-hz 6 --to-hz 9 --points 40 one.h5 --damping \
    'modal 0.001' -o full.h5
expect 0 '' ritz-reduce -q two.h5 basis.h5 -o two-reduced.h5
expect 0 '' ritz-frf -q --from-hz 6 --to-hz 9 --points 40 --no-refine \
    --singular-values two.h5 --damping 'modal 0.001' -o two-full.h5
expect 0 '' ritz-frf -q --points-of two-full.h5 --singular-values \
    two-reduced.h5 --damping 'modal 0.001' -o two-small.h5
expect 0 '' ritz-frf -q --points-of two-full.h5 --singular-values one.h5 \
    --damping 'modal 0.001' -o one-full.h5
expect 0 '' ritz-chart response two-full.h5 two-small.h5 --channel \
    singular-values --channel turn/torque --error both -o singular.svg
well singular.svg
for words in 'thin: all but the largest' 'peak between points' \
    'singular values: error at most' 'difference, dB' 'largest of all'; do
    expect 0 "$words" cat singular.svg
done
cat >singular.py <<'END'
import h5py, numpy as np
f = [h5py.File(name, "r") for name in ("two-full.h5", "two-small.h5")]
H = [g["H/real"][:] + 1j * g["H/imag"][:] for g in f]
s = [np.linalg.svd(h, compute_uv=False) for h in H]
rows = [r.split("\t") for r in open("singular.svg.tsv").read().splitlines()]
rows = [r for r in rows[1:] if len(r) == 9]
def line(*which):
    return np.array([[float(v) for v in r[3:8]] for r in rows
                     if [int(v) for v in r[:3]] == list(which)])
def near(a, b):  # nine digits are written
    assert len(a) == len(b) and np.allclose(a, b, rtol=1e-7, atol=1e-10)
for v in 0, 1:
    near(line(0, 0, v)[:, 1], s[0][:, v])
    got = line(0, 1, v)
    near(got[:, 1], s[1][:, v])
    near(got[:, 3], abs(s[1] - s[0])[:, v] / s[0].max())
    near(got[:, 4], abs(20 * np.log10(s[1] / s[0]))[:, v])
got, h = line(1, 1, 0), [x[:, 0, 0] for x in H]
near(got[:, 3], abs(h[1] - h[0]) / abs(h[0]).max())
near(got[:, 4], abs(20 * np.log10(abs(h[1]) / abs(h[0]))))
for w in 0, 1:  # the true peak lies between points, and above them
    peak = f[w].attrs["singular_peak"]
    near(line(0, -2, w)[0, :2], peak)
    assert peak[1] > 1.001 * s[w].max() and peak[0] not in f[w]["hertz"][:]
END
expect 0 '' /usr/bin/python3 -s singular.py
expect 0 '' /usr/bin/python3 -s - <<'END'
import h5py, shutil
shutil.copy("two-small.h5", "zero.h5")
with h5py.File("zero.h5", "r+") as f:
    for part in f["H/real"], f["H/imag"]:
        part[7, 0, 0] = 0.0
        del part.attrs["checksum"]
    f.attrs["singular_peak"] = [7.0, float("inf")]
END
expect 0 '' ritz-chart response two-full.h5 zero.h5 --channel turn/torque \
    --error decibels -o zero.svg
expect 0 '' /usr/bin/python3 -s - <<'END'
rows = [r.split("\t") for r in open("zero.svg.tsv").read().splitlines()]
line = [r for r in rows[1:] if r[:3] == ["0", "1", "0"]]
gaps = [k for k, r in enumerate(line) if r[7] == "NaN"]
assert gaps == [7] and line[7][4] == "0" and line[7][6] != "NaN", gaps
END
expect 0 'turn / torque: difference at most' cat zero.svg
expect 1 '' grep -F 'error / largest' zero.svg
expect 0 '' ritz-chart response two-full.h5 zero.h5 --channel \
    singular-values -o infinite.svg
expect 0 'a pole at 7 Hz is not damped' cat infinite.svg
expect 0 '' /usr/bin/python3 -s -c \
    'import h5py; h5py.File("zero.h5", "r+").attrs["singular_peak"] = [7.0, 0.0]'
expect 1 "'singular_peak' is no frequency and no value above 0" ritz-chart \
    response zero.h5 -o x.svg
expect 1 "'full.h5' holds no singular values: ritz-frf --singular-values" \
    ritz-chart response full.h5 --channel singular-values -o x.svg
expect 1 "'two-full.h5' has more inputs or outputs than 'one-full.h5'" \
    ritz-chart response one-full.h5 two-full.h5 --channel singular-values \
    -o x.svg
expect 0 '' ritz-chart report two-full.h5 two-small.h5 -o two.html
expect 0 'singular values: two-full.h5, two-small.h5' cat two.html

# --- likeness of systems: by masses, by inputs and outputs --------------------

expect 0 '' import_body platform -q --port scan=1 -o platform.h5
cat >pair.yaml <<'END'
scene: stator and platform
components:
  stator:   {model: one.h5, basis: craig-bampton, modes: 8}
  platform: {model: platform.h5, basis: rigid}
joints:
  - {name: cone, between: [stator/scan, platform/scan], type: hinge,
     axis: [0, 1, 0], angles_deg: [0, 60]}
inputs:
  - {name: torque, at: stator/bearing, component: 6}
  - {name: push, at: stator/bearing, component: 2}
outputs:
  - {name: gyro, at: platform/scan, component: 6, limit: 1.0e-3}
band_hz: [0, 15]
damping: {modal: 0.002}
END
expect 0 '' ritz-compare -q --components small- pair.yaml -o pair.h5
expect 0 '' ritz-assemble -q --full --at cone=60 pair.yaml -o pair-full.h5
expect 0 '' ritz-chart mac pair.h5 small-platform.h5 small-stator.h5 --at \
    cone=0 --at cone=60 -o turned.svg
expect 0 'cone=60, by masses' cat turned.svg
well turned.svg
expect 0 '' ritz-chart mac small-stator.h5 pair.h5 small-platform.h5 --at \
    cone=60 --at cone=60 -o alike.svg
expect 0 '' /usr/bin/python3 -s - <<'END'
import h5py, shutil
shutil.copy("small-stator.h5", "scaled.h5")
with h5py.File("scaled.h5", "r+") as f:
    M = f["M"][:] * 1.001
    del f["M"]
    f["M"] = M
END
expect 0 '' ritz-chart mac pair.h5 pair-full.h5 --at cone=60 -o seen.svg
expect 0 '3 inputs and outputs tell no more modes apart than that' cat seen.svg
expect 0 '' ritz-chart mac pair.h5 pair.h5 --at cone=0 -o twice.svg
expect 0 '' ritz-chart mac pair.h5 -o both.svg
expect 0 'cone=0 and pair.h5, cone=60, by inputs and' cat both.svg
cat >likeness.py <<'END'
import h5py, numpy as np
def cells(name):
    rows = [r.split("\t") for r in open(name).read().splitlines()][1:]
    return {(int(r[1]), int(r[0])): float(r[2]) for r in rows if len(r) == 4}
def near(name, due):
    got = cells(name)
    assert len(got) == due.size and all(
        abs(got[k] - due[k]) < 1e-5 for k in got), (name, got, due)
pair, bodies = h5py.File("pair.h5", "r"), ("stator", "platform")
M = [h5py.File(f"small-{b}.h5", "r")["M"][:] for b in bodies]
def shapes(k):
    c = pair[f"configurations/{k}"]
    rigid = int(c.attrs["num_rigid"])
    return [c["blocks"][b][:][:, rigid:] for b in bodies]
def mac(a, b):
    return sum(u.T @ m @ v for u, m, v in zip(a, M, b)) ** 2
near("turned.svg.tsv", mac(shapes(0), shapes(1)))
near("alike.svg.tsv", np.eye(len(mac(shapes(1), shapes(1)))))
assert mac(shapes(0), shapes(1)).min() < 0.5 < mac(shapes(0), shapes(1)).max()
def seen(k):
    c = pair[f"configurations/{k}"]
    rigid = int(c.attrs["num_rigid"])
    B, C = c["inputs/B"][:], c["outputs/C"][:]
    return np.vstack([B.T, C])[:, rigid:]
a, b = seen(0), seen(1)
most = np.maximum(abs(a).max(1), abs(b).max(1))[:, None]
a, b = a / most, b / most
near("both.svg.tsv", (a.T @ b) ** 2 / np.outer((a * a).sum(0), (b * b).sum(0)))
twice, full = cells("twice.svg.tsv"), cells("seen.svg.tsv")
assert all(abs(twice[k, k] - 1.0) < 1e-9 for k, j in twice if k == j)
assert all(full[k, k] > 0.99 for k in range(3))
END
expect 0 '' /usr/bin/python3 -s likeness.py
expect 1 "MAC is of two: choose two configurations of 'pair.h5' by --at" \
    ritz-chart mac pair.h5 --at cone=0 -o x.svg
expect 1 '--at is there more than twice' ritz-chart mac pair.h5 --at cone=0 \
    --at cone=0 --at cone=0 -o x.svg
expect 1 'no file is a system, --at has nothing to choose from' ritz-chart \
    mac one.h5 two-reduced.h5 --at cone=0 -o x.svg
expect 1 "('stator', 'platform') are not these: 2 bodies, 1 named" ritz-chart \
    mac pair.h5 small-stator.h5 --at cone=0 --at cone=60 -o x.svg
expect 1 "none left has 6 coordinates" ritz-chart mac \
    pair.h5 small-stator.h5 small-stator.h5 --at cone=0 --at cone=60 -o x.svg
expect 1 "their masses are not its mass" ritz-chart mac \
    pair.h5 scaled.h5 small-platform.h5 --at cone=0 --at cone=60 -o x.svg
expect 1 "'basis.h5' is no reduced component" ritz-chart mac pair.h5 basis.h5 \
    small-platform.h5 --at cone=0 --at cone=60 -o x.svg
expect 1 'basis.h5: it has no inputs and outputs, by which' ritz-chart mac \
    pair.h5 basis.h5 --at cone=0 -o x.svg
expect 1 "have but one input or output in common" ritz-chart mac pair.h5 \
    one.h5 --at cone=0 -o x.svg
expect 0 '' ritz-chart report pair.h5 --at cone=0 --at cone=60 -o pair.html
works '  a report compares a system with itself' grep -q \
    'MAC of pair.h5, .*cone=0 and pair.h5, .*cone=60' pair.html
expect 0 '' ritz-chart report one.h5 two-reduced.h5 pair.h5 two.h5 --at cone=0 \
    -o four.html
works '  and with another model, --at being for systems alone' grep -q \
    'MAC of pair.h5, .*cone=0 and two.h5, by inputs and outputs' four.html
expect 1 'choose two configurations of' ritz-chart report pair.h5 --at cone=0 \
    -o none.html
echo "1..$count"
