#!/bin/sh
# loop.sh FOLDER-OF-THE-TOOLS - closed loops, singular values, zeros, and how
# many columns of a nested file are taken.
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

import_chain --input tip=10:1 --output-at tip=10:1 --output-at root=1:1 -o chain.h5
ritz-basis full chain.h5 -q -o full.h5
ritz-reduce chain.h5 full.h5 -q -o whole.h5

# Displacement fed back through g s / (1 + s / 10), either way.
/usr/bin/python3 -s - <<'END'
import numpy, scipy.io
for name, g in ("damp", 0.3), ("drive", -0.3):
    scipy.io.savemat(name + ".mat", {
        "A": numpy.array([[-10.0]]), "B": numpy.array([[1.0]]),
        "C": numpy.array([[-100.0 * g]]), "D": numpy.array([[10.0 * g]])})
END
ritz-import -q --state-space damp.mat -o damp.h5
ritz-import -q --state-space drive.mat -o drive.h5

# --- zeros -------------------------------------------------------------------

json 0 ritz-frf whole.h5 --to-hz 0.5 --zeros --singular-values -o open.h5
holds '  at the tip they are the poles of the chain whose tip is held' '
    near([z["hz"] for z in j["zeros"][0]["zeros"] if z["im"] > 0],
         [math.sin(n * math.pi / 20) / math.pi for n in range(1, 10)], 1e-10)'
holds '  in pairs' '[z["im"] for z in j["zeros"][0]["zeros"]][1::2] ==
    [-z["im"] for z in j["zeros"][0]["zeros"]][::2]'
holds '  the largest singular value is of both outputs' '
    j["measures"][-1]["name"] == "largest singular value" and
    j["measures"][-1]["value"] ** 2 >= sum(m["value"] ** 2
        for m in j["measures"][:2]) * (1 - 1e-12)'
expect 0 'singular' ritz-frf chain.h5 --to-hz 0.5 --singular-values \
    --input-size tip=2 -o scaled.h5
expect 1 "there is no input 'top'" ritz-frf chain.h5 --to-hz 0.5 \
    --singular-values --input-size top=2 -o none.h5
expect 1 'no output of the model has a limit' ritz-frf chain.h5 --to-hz 0.5 \
    --singular-values --over-limits -o none.h5
expect 0 '530 frequencies' ritz-export --to tsv open.h5 -o open.tsv
expect 0 'sigma1' head -1 open.tsv

# --- loops -------------------------------------------------------------------

expect 0 'the loop is stable: pole at -0.020189' ritz-frf whole.h5 --to-hz 0.5 \
    --controller damp.h5 --connect tip=u1 --connect y1=tip --singular-values \
    --closed-loop states.h5 -o closed.h5
expect 0 'closed loop response' ritz-frf whole.h5 --to-hz 0.5 \
    --points-of closed.h5 --controller damp.h5 --connect tip=u1 \
    --connect y1=tip -o again.h5
expect 0 'states response' ritz-frf states.h5 --to-hz 0.5 --points-of closed.h5 \
    -o by-states.h5
works 'a loop closed in frequency, in states and by hand is one' \
    /usr/bin/python3 -s - <<'END'
import h5py, numpy
def H(name):
    with h5py.File(name) as f:
        return f["H/real"][:] + 1j * f["H/imag"][:]
# plant and controller by hand, from the matrices
with h5py.File("closed.h5") as f, h5py.File("whole.h5") as m:
    s = 2j * numpy.pi * f["hertz"][:]
    K, M, D = m["K"][:], m["M"][:], m["D"][:]
    B, C = m["inputs/B"][:], m["outputs/C"][:]
    sigma = f["singular_values"][:]
due = []
for z in s:
    G = C @ numpy.linalg.solve(K + z * D + z * z * M, B)
    F = 0.3 * z / (1 + z / 10)
    due.append(G / (1 + F * G[0, 0]))
due = numpy.array(due)
for name in "closed.h5", "again.h5", "by-states.h5":
    off = abs(H(name) - due).max() / abs(due).max()
    print(name, off)
    assert off < 1e-10, name
assert abs(sigma[:, 0] - numpy.linalg.norm(due[:, :, 0], axis=1)).max() < 1e-9
END
expect 1 'the loop is unstable, pole at +0.028934' ritz-frf whole.h5 \
    --to-hz 0.5 --controller drive.h5 --connect tip=u1 --connect y1=tip \
    -o none.h5
expect 0 'what is written is no steady response' ritz-frf whole.h5 --to-hz 0.5 \
    --controller drive.h5 --connect tip=u1 --connect y1=tip --force -o any.h5
expect 0 'the loop is stable' ritz-frf chain.h5 --to-hz 0.5 \
    --controller drive.h5 --connect tip=u1 --connect y1=tip \
    --feedback positive -o positive.h5
expect 1 "the plant has no output 'u1' for the controller" ritz-frf whole.h5 \
    --to-hz 0.5 --controller damp.h5 -o none.h5
expect 2 'give its --controller' ritz-frf whole.h5 --to-hz 0.5 --force -o none.h5
expect 2 "takes 'negative' or 'positive', not 'posotive'" ritz-frf whole.h5 \
    --to-hz 0.5 --controller damp.h5 --feedback posotive -o none.h5

# --- measured responses ----------------------------------------------------

ritz-frf whole.h5 --to-hz 0.5 --damping 'modal 0.02' -q -o open.h5
ritz-export -q --to tsv open.h5 -o open.tsv
ritz-frf damp.h5 --points-of open.h5 -q -o inner.h5
ritz-frf whole.h5 --damping 'modal 0.02' --points-of open.h5 -q \
    --controller damp.h5 --connect tip=u1 --connect y1=tip -o due.h5
for plant in open.h5 open.tsv; do
    for controller in damp.h5 inner.h5; do
        expect 0 'phase margin, degrees                          96.' ritz-frf \
            "$plant" --controller "$controller" --connect tip=u1 \
            --connect y1=tip -o "measured-$plant-$controller"
    done
done
works 'a measured loop is that of the model at its points' \
    /usr/bin/python3 -s - <<'END'
import glob, h5py
def H(name):
    with h5py.File(name) as f:
        return f["H/real"][:] + 1j * f["H/imag"][:]
due = H("due.h5")
for name in glob.glob("measured-*"): # 15 digits of the table
    assert abs(H(name) - due).max() < 1e-13 * abs(due).max(), name
END
expect 0 'a measured response has no states; its margins' ritz-frf open.tsv \
    --controller damp.h5 --connect tip=u1 --connect y1=tip -o any.h5
expect 1 'a measured response has no states to write' ritz-frf open.tsv \
    --controller damp.h5 --connect tip=u1 --connect y1=tip \
    --closed-loop no-states.h5 -o none.h5
expect 1 'measured were 0.0005 to 0.5 Hz: beyond, nothing is known' ritz-frf \
    open.tsv --to-hz 1 -o none.h5
printf '0 1 0\n0.2 1 0\n0.5 1 0\n' >gain.tsv
for refused in 'to-hz 1' 'closed-loop no-states.h5'; do
    # shellcheck disable=SC2086 # words
    expect 1 'ritz-frf: gain.tsv: ' ritz-frf whole.h5 --$refused \
        --controller gain.tsv --connect tip=u1 --connect y1=tip -o none.h5
done
expect 1 'was measured, no points can be added' ritz-frf open.tsv \
    --tolerance 1e-3 -o none.h5
expect 1 'was measured: --at, --damping' ritz-frf open.tsv --order 3 -o none.h5
printf '1 2 3\n0.5 2 3\n' >back.tsv
expect 1 'the frequency of line 2 does not ascend' ritz-frf back.tsv -o none.h5
works 'nothing is written of them' test ! -e none.h5

printf '# rad/s real imaginary\n1 2 3\n2 3 4\n' >other.tsv
expect 1 "its head begins with 'rad/s', not with hertz" ritz-frf other.tsv \
    -o none.h5
: >empty.tsv
printf '# hertz %s\n1 1 0 1 0\n2 1 0 1 0\n' \
    're(y1/u1) im(y1/u1) re(y2/u1) im(y2/u1)' >two.tsv
expect 1 'no table of a response: it is empty' ritz-frf empty.tsv -o none.h5

# --- signals that nobody named ----------------------------------------------------

printf '0.1 1 0\n0.2 1 0\n0.5 1 0\n' >bare.tsv
for connect in '' '--connect y1=u1'; do
    # shellcheck disable=SC2086 # words
    expect 0 '  y1 -> controller u1' ritz-frf bare.tsv --controller damp.h5 \
        $connect -o bare.h5
    # shellcheck disable=SC2086 # words
    expect 0 '  controller y1 -> u1' ritz-simulate damp.h5 --seconds 1 \
        --step 0.01 --input u1=step --controller damp.h5 $connect -o bare.h5
done
expect 1 'which signals of plant and controller are joined is not known' \
    ritz-frf two.tsv --controller damp.h5 -o none.h5

# --- unreduced plants in time ---------------------------------------------------

for method in trapezoidal generalised-alpha; do
    expect 1 'the loop is unstable, pole at' ritz-simulate chain.h5 \
        --seconds 5 --step 0.1 --input tip=step --method "$method" \
        --controller drive.h5 --connect tip=u1 --connect y1=tip -o none.h5
done
works 'nothing is written of a loop that is unstable' test ! -e none.h5

# --- nested files --------------------------------------------------------------

ritz-basis normal-modes --modes 8 chain.h5 -q -o modes.h5
ritz-reduce chain.h5 modes.h5 -q -o eight.h5
expect 1 'it is not nested' ritz-poles --order 3 eight.h5
cp eight.h5 nested.h5
/usr/bin/python3 -s - <<'END'
import h5py, numpy
with h5py.File("nested.h5", "r+") as f:
    g = f.create_group("nested")
    g.attrs["smallest"] = numpy.int64(2)
    g["order"] = numpy.array([3, 5], dtype="<i8")
    g.create_group("error")
    g["error/response-relative"] = numpy.array([0.25, numpy.nan])
    g["error/frequency-relative-bound"] = numpy.array([1e-6, 1e-7])
END
json 0 ritz-info nested.h5
holds '  knows its prefixes' 'j["nested"]["smallest"] == 2 and
    j["nested"]["order"] == [3, 5] and
    j["nested"]["errors"]["response-relative"] == [0.25, None]'
expect 0 'first 2 to 9 columns (--order N)' ritz-info nested.h5
expect 0 'response-relative                  2.5e-01        -' ritz-info nested.h5
json 0 ritz-poles --order 3 nested.h5
expect 1 'no prefix of 1 columns, there are those of 2 to 9' ritz-poles \
    --order 1 nested.h5
expect 1 'no reduced component, --order has no columns' ritz-poles --order 3 \
    chain.h5
expect 0 'response-relative' ritz-export --order 3 --to matlab nested.h5 \
    -o three.mat
expect 0 'frequency-relative-bound' ritz-export --order 5 --to matlab nested.h5 \
    -o five.mat
expect 1 'carries neither estimated nor measured errors' ritz-export --order 4 --to matlab nested.h5 \
    -o four.mat
json 0 ritz-verify --order 4 chain.h5 nested.h5 -o four.h5
json 0 ritz-info four.h5
holds '  is four columns, with errors of its own' 'j["dofs"] == 4 and
    len(j["errors"]) > 0 and j["nested"]["order"] == [3]'
expect 0 'response, 4' ritz-frf --order 3 --to-hz 0.2 --no-refine nested.h5 \
    -o three.h5
expect 0 'hankel' ritz-rank --order 3 nested.h5
cat >scene.yaml <<'END'
scene: one body
components:
  chain: {model: nested.h5, order: 3}
END
expect 0 '3 coordinates' ritz-assemble scene.yaml -o system.h5
cat >scene.yaml <<'END'
scene: one body
components:
  chain: {model: chain.h5, basis: normal-modes, modes: 2, order: 3}
END
expect 1 "'order' is how much of a model that is reduced already" \
    ritz-assemble scene.yaml -o system.h5
/usr/bin/python3 -s - <<'END'
import h5py
with h5py.File("nested.h5", "r+") as f:
    f["nested/order"][1] = 3
END
expect 1 "nested: 'order' does not ascend" ritz-info nested.h5
printf '1..%d\n' "$count"
