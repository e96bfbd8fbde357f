#!/bin/sh
# Time responses as a user asks for them. Usage: simulate.sh FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

import_body stator -q --port bearing=1 --port scan=5 --input torque=1:6 \
    --output-at gyro=5:6 --output-at rate=5:6/vel --output-at shake=5:6/acc \
    -o stator.h5
ritz-basis -q macneal-rubin --modes 4 stator.h5 -o basis.h5
ritz-reduce -q stator.h5 basis.h5 -o reduced.h5

# --- runs --------------------------------------------------------------------

expect 0 'Time response to inputs' ritz-simulate --help
expect 0 '[ChungHulbert1993]' ritz-simulate --list
expect 0 'energies       balance to' ritz-simulate --seconds 2 --step 0.01 \
    --input torque=step --damping 'modal 0.01' reduced.h5 -o modal.h5
expect 0 '201 times to 2 s' ritz-info modal.h5
ritz-simulate -q --seconds 2 --step 0.01 --input torque=step \
    --damping 'modal 0.01' reduced.h5 -o modal2.h5
for name in trapezoidal generalised-alpha central-difference; do
    expect 0 "$name, step" ritz-simulate --method "$name" --seconds 0.5 \
        --step 0.001 --input torque=sine:3 --damping 'rayleigh 1 1e-5' \
        reduced.h5 -o "$name.h5"
done
json 0 ritz-simulate --seconds 2 --accuracy 1e-2 --method trapezoidal \
    --initial mode:7 --damping 'modal 0.01' reduced.h5 -o halved.h5
holds '  halves its step until it is accurate' \
    'j["error"] <= 1e-2 and j["step"] < 0.04 and j["imbalance"] < 1e-9
     and j["method"] == "trapezoidal" and len(j["peaks"]) == 3'

# A component by an implicit integrator and by all its modes: alike.
for how in '--method trapezoidal --step 1e-4' '--up-to-hz 1e4 --step 5e-4'; do
    # shellcheck disable=SC2086
    json 0 ritz-simulate $how --seconds 0.5 --input torque=sine:3 \
        --damping 'rayleigh 1 1e-5' stator.h5 -o full.h5
    [ -s peak ] || /usr/bin/python3 -s -c \
        'import json; print(json.load(open("log.json"))["peaks"][0])' >peak
    # a sine that is linear over 5e-4 s: (w h)^2 / 12 of it is 8e-6
    holds "  peaks alike ($how)" \
        "abs(j['peaks'][0] / $(cat peak) - 1) < 1e-4"
done

# A file of times and values, held; and as text again.
printf '# s\tN m\n0\t0\n0.1\t1\n0.2\t0\n' >pulse.tsv
expect 0 'inputs held to order zero' ritz-simulate --seconds 0.4 --step 0.05 \
    --hold zero --input torque=pulse.tsv --damping 'modal 0.01' reduced.h5 \
    -o pulse.h5
expect 0 'pulse.tsv' ritz-info pulse.h5
expect 0 '9 times, 3 outputs, 1 inputs' ritz-export --to tsv pulse.h5 \
    -o pulse.out
works 'a table is interpolated' awk -F '\t' \
    'NR == 4 { found = $1 * 100 " " $2 * 100 }
     END { exit found != "10 100" }' pulse.out
expect 0 '3 times to 0.4 s' ritz-simulate --seconds 0.4 --step 0.05 --every 4 \
    --input torque=impulse reduced.h5 -o few.h5

# A scene gives the response of the system that ritz-assemble writes.
printf 'scene: one\ncomponents:\n  body: {model: reduced.h5}\n%s\n%s\n' \
    'inputs: [{name: torque, at: body/bearing, component: 6}]' \
    'outputs: [{name: gyro, at: body/scan, component: 6}]' >scene.yaml
ritz-assemble -q scene.yaml -o system.h5
for file in scene.yaml system.h5; do
    ritz-simulate -q --seconds 1 --step 0.01 --input torque=sine:3 "$file" \
        -o run.h5 && ritz-export -q --to tsv run.h5 -o "$file.tsv"
done
works 'a scene has the response of its system' cmp scene.yaml.tsv system.h5.tsv

# Springs of 1e9 N/m: static responses are columns of about 1e-9, and their
# entries of M are 1e-18 where those of modes are 1. Such an M is not singular.
awk 'BEGIN {
    n = 8; k = 1e9
    head = "%%MatrixMarket matrix coordinate real symmetric"
    print head >"K.mtx"; print n, n, 2 * n - 1 >"K.mtx"
    print head >"M.mtx"; print n, n, n >"M.mtx"
    for (i = 1; i <= n; i++) {
        print i, i, i == 1 || i == n ? k : 2 * k >"K.mtx"
        if (i > 1)
            print i, i - 1, -k >"K.mtx"
        print i, i, 1 >"M.mtx"
    }
}'
ritz-import -q --stiffness K.mtx --mass M.mtx --rows 0 --port end=8 \
    --input push=1:0 --output-at tip=8:0,1:0*-1 -o stiff.h5
for name in normal-modes macneal macneal-rubin; do
    ritz-basis -q "$name" --modes 4 stiff.h5 -o basis.h5
    ritz-reduce -q stiff.h5 basis.h5 -o soft.h5
    expect 0 'trapezoidal, step' ritz-simulate --method trapezoidal \
        --seconds 0.01 --input push=step soft.h5 -o soft-run.h5
done

# --- loops -------------------------------------------------------------------

# The rate is fed back to the torque through a lag, also sampled with a delay.
for what in A=-20 B=1 C=2e4; do
    printf '%%%%MatrixMarket matrix coordinate real general\n1 1 1\n1 1 %s\n' \
        "${what#*=}" >"lag.${what%%=*}.mtx"
done
ritz-import -q --state-space A=lag.A.mtx,B=lag.B.mtx,C=lag.C.mtx -o lag.h5
run_loop() {
    ritz-simulate --seconds 1 --input torque=step --damping 'rayleigh 1 1e-5' \
        --controller lag.h5 --connect rate=u1 --connect y1=torque "$@" \
        reduced.h5
}
expect 0 's, the least found of those tried from' \
    run_loop --step 1e-3 -o split.h5
expect 0 'modal, closed loop, step' run_loop --step 1e-3 --loop exact -o exact.h5
expect 0 'a step of 0.002 s, of which sample and delay' run_loop --step 3e-3 \
    --sample 0.01 --delay 0.004 -o sampled.h5
expect 0 'controller-work' ritz-info sampled.h5
# reports STABILITY OPTION...: so says the report of the run
reports() {
    says=$1
    shift
    json "${status:-0}" run_loop --step 1e-3 "$@" -o said.h5
    holds "  and is $says" "j['stability'] == '$says'"
}
reports marginal # a free body, whose rate is controlled
reports marginal --loop exact
reports marginal --sample 0.01 --delay 0.004
reports unknown --delay 0.004
reports unstable --force --feedback positive
status=1 reports unstable --sample 0.01 --feedback positive
expect 1 'the loop is unstable, pole at' run_loop --step 1e-3 \
    --feedback positive -o none.h5
expect 1 'makes the loop unstable' run_loop --step 0.5 -o none.h5
expect 0 'it grows by' run_loop --step 0.5 --any-step -o any.h5
expect 1 '--controller needs --step' run_loop -o none.h5
expect 0 's is used for the 0.004000002 s given: 2 steps' run_loop \
    --step 3e-3 --sample 0.01 --delay 0.004000002 -o late.h5
printf '0 1 0\n10 1 0\n' >lag.tsv
expect 1 'lag.tsv: a measured response has no states for a run in time' \
    ritz-simulate --seconds 1 --step 1e-3 --input torque=step \
    --controller lag.tsv reduced.h5 -o none.h5

# --- what it costs -----------------------------------------------------------

json 0 ritz-simulate --cost --band-hz 0,10 --damping 'modal 0.01' \
    --record runs.jsonl reduced.h5
holds '  no loop is among them' '"loops" not in j'
holds '  every integrator has a step, a cost and an error' \
    'len(j["integrators"]) == 4 and j["integrators"][0]["error"] == 0
     and all(i["seconds_per_second"] > 0 and i["error"] < 0.05
             for i in j["integrators"])
     and abs((2 * math.pi * 10 * j["cost"]["step_accurate"]) ** 2 / 12 - 1e-3)
         < 1e-12
     and j["cost"]["step_explicit"] < 1 / (math.pi * j["cost"]["highest_hz"])'
cp runs.jsonl log.json
holds '  and the record says so' \
    'j["cost"]["integrator"] == "trapezoidal" and j["order"] > 4
     and j["cost"]["seconds_per_second"] > 0
     and j["method"] == "macneal-rubin"'
loop='--controller lag.h5 --connect rate=u1 --connect y1=torque'
# shellcheck disable=SC2086 # $loop is words
json 0 ritz-simulate --cost --band-hz 0,10 $loop reduced.h5
holds '  a loop is measured, not run' \
    '[w["name"] for w in j["loops"]] == ["loop, split", "loop, exact"] and
     all(w["seconds_per_second"] > 0 for w in j["loops"]) and
     not j["output"]'
# shellcheck disable=SC2086 # $loop is words
json 0 ritz-simulate --cost --step 0.01 --sample 0.05 $loop reduced.h5
holds '  a sampled one has its own cost, at the step that is given' \
    '[(w["name"], w["step"]) for w in j["loops"]] == [("loop, sampled", 0.01)]'
# shellcheck disable=SC2086 # $loop is words
expect 1 'one exponential needs a continuous controller without a delay' \
    ritz-simulate --cost --loop exact --sample 0.05 $loop reduced.h5
expect 2 '--switched is for a run that -o writes, not for --cost' \
    ritz-simulate --cost --switched modes --switch-interval 1 reduced.h5
expect 0 'explicit steps are stable up to' ritz-simulate --cost --switched modes \
    --switch-interval 0.1 --seconds 1 --step 0.01 --input torque=step \
    reduced.h5 -o switched.h5
expect 1 'is of reduced components and systems' ritz-simulate --cost stator.h5

# --- options of another kind of run ------------------------------------------

# other OPTION BELONGS KIND WORDS: OPTION is for BELONGS, and not for KIND, which
# is requested by WORDS.
other() {
    name=${1%% *} belongs=$2 kind=$3
    set -- $1 $4
    expect 2 "$name is for $belongs, not for $kind" ritz-simulate --seconds 1 \
        --step 0.01 --input torque=step "$@" reduced.h5 -o none.h5
}
linear='a run of one linear model'
loop='--controller loop.h5'
for option in '--connect a=b' '--feedback negative' '--loop split' \
    '--sample 1' '--delay 0' --discrete --force; do
    other "$option" --controller "$linear" ''
done
other --any-step '--constraints or --controller' "$linear" ''
other --any-step '--constraints or --controller' --sweep '--sweep a=0:1:1'
other '--start-digits 4' --constraints "$linear" '--initial mode:1'
other '--start-digits 4' --constraints --switched '--switched modes'
other '--sweep-modes 4' --sweep "$linear" ''
other '--sweep-basis switched' --sweep --constraints '--constraints none'
other '--sweep-against full' --sweep --controller "$loop"
other '--indicator 0.5' --switched --controller "$loop"
other '--up-to-hz 5' "$linear, --controller or --sweep" --constraints \
    '--constraints none'
other '--rho 0.5' "$linear, --constraints or --controller" --switched \
    '--switched modes'
other '--damper a=1' "$linear, --switched, --controller, a rate of spin that \
changes or --cost" --constraints '--constraints none'
other '--rho 0.8' '--method generalised-alpha' modal ''
other '--rho 0.8' '--method generalised-alpha' trapezoidal \
    '--method trapezoidal'
expect 2 '--accuracy is for a run of one linear model, not for --constraints' \
    ritz-simulate --seconds 1 --accuracy 0.01 --constraints none \
    --input torque=step reduced.h5 -o none.h5
expect 2 '--up-to-hz is for --method modal, not for trapezoidal' ritz-simulate \
    --seconds 1 --step 0.01 --method trapezoidal --up-to-hz 5 \
    --input torque=step stator.h5 -o none.h5
expect 1 '--up-to-hz is for components, whose modes are computed' \
    ritz-simulate --seconds 1 --step 0.01 --up-to-hz 5 --input torque=step \
    reduced.h5 -o none.h5
expect 2 '--every is for --step' ritz-simulate --seconds 1 --every 2 \
    --input torque=step reduced.h5 -o none.h5
expect 2 '--band-hz is for --cost and --record' ritz-simulate --seconds 1 \
    --band-hz 0,1 --input torque=step reduced.h5 -o none.h5
expect 2 '--step is for a run that -o writes, not for --cost' ritz-simulate \
    --cost --step 0.01 reduced.h5
expect 2 '--constraints is for a run that -o writes, not for --cost' \
    ritz-simulate --cost --constraints none reduced.h5

# --- what is asked in vain ---------------------------------------------------

expect 2 "no integrator 'trapezoid'" ritz-simulate --method trapezoid \
    --seconds 1 reduced.h5 -o none.h5
expect 0 'needs --up-to-hz' ritz-simulate --list
expect 2 'how long? give --seconds' ritz-simulate reduced.h5 -o none.h5
expect 2 'nothing to do' ritz-simulate reduced.h5
expect 2 "takes 'first' or 'zero', not 'second'" ritz-simulate --hold second --seconds 1 \
    reduced.h5 -o none.h5
expect 2 'one of them' ritz-simulate --step 1 --accuracy 0.1 --seconds 1 \
    reduced.h5 -o none.h5
expect 1 'nothing moves it' ritz-simulate --seconds 1 reduced.h5 -o none.h5
expect 1 "unknown input 'torqe', is 'torque' meant?" ritz-simulate --seconds 1 \
    --input torqe=step reduced.h5 -o none.h5
expect 1 'is given twice' ritz-simulate --seconds 1 --input torque=step \
    --input torque=step reduced.h5 -o none.h5
expect 1 'Hz, limits it to' ritz-simulate --seconds 1 --step 0.1 \
    --method central-difference --input torque=step reduced.h5 -o none.h5
expect 1 'up to which modes are to be found: --up-to-hz' ritz-simulate --seconds 1 \
    --input torque=step stator.h5 -o none.h5
expect 1 'damping ratios are of modes' ritz-simulate --seconds 1 \
    --method trapezoidal --damping 'modal 0.01' --input torque=step stator.h5 \
    -o none.h5
expect 1 'modes, not 999' ritz-simulate --seconds 1 --initial mode:999 \
    reduced.h5 -o none.h5
expect 1 'rows for' ritz-simulate --seconds 1 --initial pulse.tsv reduced.h5 \
    -o none.h5
expect 1 'holds a time response, not' ritz-simulate --seconds 1 modal.h5 \
    -o none.h5
works 'nothing is written where it fails' test ! -e none.h5

echo "1..$count"
