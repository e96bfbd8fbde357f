#!/bin/sh
# Joints of a scene that are held by forces over time instead of elimination.
# Usage: constrained.sh FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

if ! /usr/bin/python3 -s -c 'import h5py, numpy' 2>/dev/null; then
    echo 'ok 1 - constraints in time # skip h5py or numpy is missing'
    exit 0
fi

import_spacecraft --port boom=33
spacecraft scene 'inputs:' \
    '  - {name: motor, at: rotor/bearing, component: 6, against: stator/bearing}' \
    'outputs:' \
    '  - {name: gyro, at: platform/scan, component: 6}' \
    '  - {name: tip, at: rotor/boom, component: 3, quantity: velocity}' \
    '  - {name: shake, at: rotor/boom, component: 1, quantity: acceleration}'
run="scene.yaml --at clock=90,cone=0 --seconds 0.5 --input motor=sine:3"

# differ A B: largest difference of outputs, relative to the largest of each.
differ() {
    /usr/bin/python3 -s - "$@" <<'END'
import h5py, numpy, sys
a, b = (h5py.File(name)["y"][:] for name in sys.argv[1:3])
off = (abs(a - b).max(axis=0) / abs(b).max(axis=0)).max()
print(off)
sys.exit(not off < float(sys.argv[3]))
END
}

# --- against the eliminated system, by the same integrator --------------------

expect 0 '' ritz-simulate $run --step 1e-3 --method trapezoidal -q -o same.h5
for method in none baumgarte sliding-mode projection; do
    expect 0 '10 rows of rank 10' ritz-simulate $run --step 1e-3 \
        --constraints $method -o $method.h5
    # rounding in frequencies that are up to 1e3 times those of the output
    works '  gives the response of the eliminated system' \
        differ $method.h5 same.h5 1e-9
done
expect 0 '' ritz-simulate $run --step 1e-4 --every 10 -q -o exact.h5
expect 0 'highest' ritz-simulate $run --step 1e-4 --every 10 \
    --constraints index-2 -o index-2.h5
works '  index-2 differs by the error of its order' \
    differ index-2.h5 exact.h5 2e-2
expect 0 'hz             800 Hz' ritz-simulate $run --step 1e-4 --every 10 \
    --constraints penalty:hz=800 -o penalty.h5
expect 0 'violation' ritz-info penalty.h5
expect 0 '' ritz-export --to tsv penalty.h5 -o penalty.tsv
expect 0 'violation-rate' head -1 penalty.tsv
json 0 ritz-simulate $run --step 1e-4 --constraints hybrid:hz=200 -o hybrid.h5
holds '  the highest frequency is reported' '
    j["constraints"]["hz"] == 200 and j["constraints"]["redundant"] == [] and
    j["constraints"]["highest_hz"] > j["constraints"]["joined_hz"] > 200'

# --- penalties of any stiffness -----------------------------------------------

for stiff in hz=1e9 hz=300,inertia=1e14; do
    expect 0 '' ritz-simulate $run --step 1e-3 --constraints penalty:$stiff \
        -q -o stiff.h5
    works '  gives the response of the eliminated system' \
        differ stiff.h5 same.h5 1e-9
done
expect 0 'of the forces in the joints are rounding' ritz-simulate $run \
    --step 1e-3 --constraints penalty:hz=1e9 -o stiff.h5
expect 1 'they are accurate to a thousandth up to 6.76e+08 Hz' ritz-simulate \
    $run --step 1e-3 --constraints penalty:hz=1e11 -o x.h5
expect 1 "'alpha' of baumgarte is given twice" ritz-simulate $run --step 1e-3 \
    --constraints baumgarte:alpha=1,alpha=2 -o x.h5

# --- a start of few digits ----------------------------------------------------

# A bending mode whose values are rounded to two digits.
start="scene.yaml --at clock=90,cone=0 --seconds 20 --step 2e-3 --every 100
    --initial mode:10*0.01 --start-digits 2"
for method in none baumgarte:alpha=5,beta=5 projection; do
    expect 0 '' ritz-simulate $start --constraints $method -q -o drift.h5
    mv drift.h5 "drift-${method%%:*}.h5"
done
works '  the violation stays, decays or is projected' /usr/bin/python3 -s - <<'END'
import h5py, sys
def violation(name):
    with h5py.File(f"drift-{name}.h5") as f:
        return f["diagnostics/values"][:, 0]
none, faded, held = map(violation, ("none", "baumgarte", "projection"))
print(none, faded, held)
sys.exit(not (none[0] > 1e-10 and abs(none[-1] / none[0] - 1) < 1e-6
              and faded[0] == none[0] and faded[-1] < 1e-7 * none[0]
              and max(held) < 1e-7 * none[0]))
END
lacks() { ! grep -qF "$1" "$2"; }
near="scene.yaml --at clock=90,cone=0 --seconds 0.1 --step 2e-3
    --constraints projection"
expect 0 'the start violates the constraints: displacements were moved by' \
    ritz-simulate $near --initial mode:7 --start-digits 1 -o near.h5
expect 0 'moved into the constraints: displacements by' \
    ritz-simulate $near --initial mode:10 --start-digits 4 -o near.h5
ritz-simulate $near --initial mode:10 -o near.h5 >log 2>&1
works '  and a start that satisfies them is not' lacks 'moved into' log
expect 0 'energies       at most' ritz-simulate $near --initial mode:1 -o near.h5

expect 0 '' ritz-chart diagnostics drift-none.h5 drift-baumgarte.h5 \
    drift-projection.h5 -o drift.svg
expect 0 'violation-rate' cat drift.svg
expect 1 "'same.h5' has no diagnostic over time" ritz-chart diagnostics same.h5 \
    -o none.svg

# --- limits -------------------------------------------------------------------

expect 1 'raises the highest frequency from' ritz-simulate $run --step 1e-3 \
    --method central-difference --constraints baumgarte:beta=2500 -o x.h5
expect 1 'with this step, constraints have room up to' ritz-simulate $run \
    --step 1e-3 --method central-difference --constraints penalty:hz=400 -o x.h5
expect 1 'has left all bounds' ritz-simulate $run --step 1e-3 --any-step \
    --seconds 5 --method central-difference --constraints penalty:hz=400 -o x.h5
expect 1 '--constraints needs --step' ritz-simulate $run --constraints none \
    -o x.h5
expect 1 "no stabilisation is called 'glue'" ritz-simulate $run --step 1e-3 \
    --constraints glue -o x.h5
expect 1 'is no scene' ritz-simulate rotor.h5 --step 1e-3 --seconds 1 \
    --initial mode:7 --constraints none -o x.h5
expect 1 'index-2 is generalised-alpha: --method trapezoidal is not for it' \
    ritz-simulate $run --step 1e-3 --method trapezoidal --constraints index-2 \
    -o x.h5
expect 1 '--method modal is not for bodies that forces join' ritz-simulate \
    $run --step 1e-3 --method modal --constraints projection -o x.h5
expect 1 '--rho is for --method generalised-alpha and index-2, not for trap' \
    ritz-simulate $run --step 1e-3 --rho 0.5 --constraints projection -o x.h5
expect 0 'index-2 generalised-alpha' ritz-simulate $run --step 1e-3 --rho 0.5 \
    --method generalised-alpha --constraints index-2 -o rho.h5
expect 2 '--start-digits rounds initial values' ritz-simulate $run --step 1e-3 \
    --start-digits 3 --constraints none -o x.h5
expect 0 '--constraints, of scenes' ritz-simulate --list
works '  nothing is written where a run is refused' test ! -e x.h5
printf '1..%d\n' "$count"
