#!/bin/sh
# balanced.sh FOLDER-OF-THE-TOOLS - bases that are balanced, and what ritz-reduce
# makes of each kind.
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

import_chain --input tip=10:1 --output-at root=1:1 -o chain.h5
import_chain --input tip=10:1 --output-at tip=10:1 -o tip.h5

# --- states: the bound is printed, noted and held -------------------------------

expect 0 '4 of 20 states kept; error at most 121.2, largest value 424.3' \
    ritz-basis balanced --modes 4 chain.h5 -o states.h5
json 0 ritz-reduce chain.h5 states.h5 -o small.h5
holds '  notes the bound' 'j["kind"] == "state-space" and j["states"] == 4 and
    j["estimates"][0]["name"] == "h-infinity-bound" and
    near([j["estimates"][0]["value"]], [121.19], 1e-3) and
    j["stability"] == "stable"'
expect 1 "'states.h5' reduces to a state space, --estimates and --recovery are for components" \
    ritz-reduce chain.h5 states.h5 -o x.h5 --estimates none
expect 0 '4 state, 16 perturbed' ritz-basis balanced --modes 4 \
    --remainder static chain.h5 -o static.h5
expect 0 '4 state' ritz-reduce chain.h5 static.h5 -o static-small.h5
json 0 ritz-verify chain.h5 static-small.h5 -o verified.h5
holds '  keeps the static gain, and the bound' '[e["value"] < limit
    for name, limit in [("static-gain-relative", 1e-12), ("h-infinity", 121.2)]
    for e in j["measures"] if e["name"] == name] == [True, True]'
for engine in dense low-rank projection; do
    expect 0 'error at most 121.2, largest value 424.3' ritz-basis balanced --modes 4 \
        --engine $engine chain.h5 -o $engine.h5
done
json 0 ritz-rank --by hankel --engine low-rank chain.h5
holds '  states the residuals of both equations' \
    'len(j["residuals"]) == 2 and 0.0 < max(j["residuals"]) <= 1e-10'
json 0 ritz-rank --by hankel --engine dense chain.h5
holds '  has none to state' '"residuals" not in j'
expect 2 "no 'band_hz'" ritz-basis balanced --modes 4 --band-hz 0,1 chain.h5 \
    -o none.h5

# The two Hankel values of a mode with damping ratio zeta have the ratio 1 - 2
# zeta; a basis with only one of the two states has a real pole.
matrix() {
    printf '%%%%MatrixMarket matrix array real general\n%s\n' "$2" >"$1"
}
matrix a.mtx '4 4
0 -100 0 0 1 -0.02 0 0 0 0 0 -900 0 0 1 -0.06'
matrix b.mtx '4 1
0 1 0 1'
matrix c.mtx '1 4
1 0 1 0'
expect 0 '' ritz-import -q --state-space A=a.mtx,B=b.mtx,C=c.mtx -o modes.h5
for order in 1 3; do
    expect 0 "of the two states of a mode are: --modes $order splits them" \
        ritz-basis balanced --modes $order modes.h5 -o split.h5
done
# Two modes of different frequencies have equal values: keeping one is
# arbitrary.
matrix K.mtx '3 3
1 0 0 0 4 0 0 0 100'
matrix M.mtx '3 3
1 0 0 0 1 0 0 0 1'
printf '1 0\n2 0\n3 0\n' >dofs
expect 0 '' ritz-import -q --stiffness K.mtx --mass M.mtx --dofs dofs \
    --input a=1:0 --input b=2:0*4 --input c=3:0 --output-at x=1:0 \
    --output-at y=2:0 --output-at z=3:0 -o twins.h5
expect 0 "warning: the modes at 0." ritz-basis modal-balanced --modes 1 \
    --damping "modal 0.01" twins.h5 -o twin.h5
expect 0 ' Hz are a pair, of values 25.25 and 25.25: keeping 1 splits them' \
    ritz-basis modal-balanced --modes 1 --damping "modal 0.01" twins.h5 \
    -o twin.h5
expect 0 '' ritz-basis modal-balanced --modes 2 --damping "modal 0.01" \
    twins.h5 -o twin.h5
works "  two modes split nothing" test -z "$(grep splits log)"
# The same chosen by a scene: a threshold between values that differ by 1e-10
# keeps both, and a list says which pair it splits.
printf '1 1\n1 2\n1 3\n' >dofs
printf 'BEGIN BULK\nGRID,1,,0.,0.,0.\nENDDATA\n' >one.bdf
expect 0 '' ritz-import -q --stiffness K.mtx --mass M.mtx --dofs dofs \
    --bulk one.bdf --port p=1 -o one.h5
chosen() {
    cat >twins.yaml <<END
scene: twins
components:
  body: {model: one.h5, basis: normal-modes, modes: 3}
inputs:
  - {name: a, at: body/p, component: 1}
  - {name: b, at: body/p, component: 2, scale: 3.9999999996}
  - {name: c, at: body/p, component: 3}
outputs:
  - {name: x, at: body/p, component: 1}
  - {name: y, at: body/p, component: 2}
  - {name: z, at: body/p, component: 3}
band_hz: [0, 3]
damping: {modal: 0.01}
select: {$1}
END
}
chosen 'tolerance: 0.99999999999'
expect 0 "1 modes are kept in addition, as their value is that of the least" \
    ritz-compare twins.yaml -o small.h5
works "  and no pair is split" test -z "$(grep splits log)"
chosen 'modes: [1, 3]'
expect 0 "Hz are a pair, of values 25.25 and 25.25: keeping 2 splits them" \
    ritz-compare twins.yaml -o small.h5
json 0 ritz-compare twins.yaml -o small.h5
holds '  which JSON counts' 'j["cut_pairs"] == 1 and j["equal"] == 0'
chosen 'modes: [1, 2]'
expect 0 "" ritz-compare twins.yaml -o small.h5
works "  both of them split nothing" test -z "$(grep splits log)"
expect 1 "the first values are equal, and are kept whole or not at all" \
    ritz-basis balanced --modes 1 --damping "modal 0.01" twins.h5 -o twin.h5
for order in 2 4; do
    expect 0 '' ritz-basis balanced --modes $order modes.h5 -o whole.h5
    works "  $order states split nothing" test -z "$(grep splits log)"
done

# --- over a band ----------------------------------------------------------------

expect 0 'balanced-band (modes 4 band-hz 0,0.1' ritz-basis balanced-band \
    --modes 4 --band-hz 0,0.1 chain.h5 -o band.h5
json 0 ritz-reduce chain.h5 band.h5 -o band-small.h5
holds '  bounds nothing' 'all(e["name"] != "h-infinity-bound"
    for e in j["estimates"])'
expect 1 'a band is needed' ritz-basis balanced-band --modes 4 chain.h5 \
    -o none.h5

# --- second order ---------------------------------------------------------------

for half in position velocity; do
    expect 0 '3 balanced' ritz-basis balanced-$half --modes 3 chain.h5 \
        -o two.h5
    expect 0 'state space, 6 states' ritz-reduce chain.h5 two.h5 -o two-small.h5
    expect 0 '3 balanced' ritz-basis balanced-$half --modes 3 --sides one \
        chain.h5 -o one.h5
    expect 0 'reduced component, 3 coordinates' ritz-reduce chain.h5 one.h5 \
        -o one-small.h5
done
expect 0 'left and right vectors agree' ritz-basis balanced-position --modes 3 \
    tip.h5 -o own.h5
expect 0 'reduced component, 3 coordinates' ritz-reduce tip.h5 own.h5 \
    -o own-small.h5

# --- modes ----------------------------------------------------------------------

expect 0 'the best 4 of 10 modes; the response of the others together is at most 30.93' \
    ritz-basis modal-balanced --modes 4 chain.h5 -o modal.h5
expect 0 '4 normal' ritz-reduce chain.h5 modal.h5 -o modal-small.h5

echo "1..$count"
