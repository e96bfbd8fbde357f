#!/bin/sh
# The smallest model that meets a tolerance, as its user meets it.
# Usage: fit.sh FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

truss=$data/truss72
expect 0 '' ritz-import --stiffness "$truss/truss72.k.mtx" \
    --mass "$truss/truss72.m.mtx" --bulk "$truss/truss72.bdf" \
    --dofs "$truss/truss72.dofs" --port left=1:12 --input f=36:2 \
    --output-at y=35:2 -q -o truss.h5

# --- a component -----------------------------------------------------------------

set -- ritz-fit truss.h5 --band-hz 0,20 --damping 'modal 0.01' \
    --methods craig-bampton,normal-modes,krylov
expect 0 'Why: ' "$@" --tolerance flexible=1e-2 --record fit.jsonl -o fit.h5
json 0 "$@" --tolerance flexible=1e-2 -o fit.h5
holds '  says method, order, error, tolerance, runner-up and why' \
    'j["method"] and j["order"] > 0 and j["error"] <= 1 and
     j["tolerance"] == {"flexible-response-relative": 0.01} and
     j["runner_up"]["order"] >= j["order"] and j["why"]'
expect 0 'pass' ritz-verify truss.h5 fit.h5 --band-hz 0,20 \
    --damping 'modal 0.01' --limit-response 1e-2 -o verified.h5
expect 0 'nested' ritz-info fit.h5
expect 0 '"chosen":true' tail -n 2 fit.jsonl
expect 0 '"runner_up":true' tail -n 3 fit.jsonl
json 0 "$@" --tolerance frequency=1e-3 --all --order 9
holds '  compares all at equal order, none above' \
    'len(j["equal_order"]) == 3 and
     all(c["order"] <= 9 for c in j["equal_order"] if "refused" not in c)'

json 0 "$@" --tolerance frequency=0.3
holds '  says the worst that was asked for, and what is far worse' \
    'j["worst"]["name"] == "frequency-relative" and j["not_asked_for"] and
     all(1 - m["value"] > 10 * j["worst"]["value"] if m["name"] == "mac"
         else m["value"] > 10 * j["worst"]["value"]
         for m in j["not_asked_for"])'
expect 0 'Not asked for, and more than ten times that: ' "$@" \
    --tolerance frequency=0.3

# --- refusals ----------------------------------------------------------------------

expect 2 "there is no measure 'frequncy', is 'frequency' meant?" "$@" \
    --tolerance frequncy=1 -o no.h5
expect 2 '--tolerance says what is to hold' "$@" -o no.h5
expect 2 "there is no method 'rubn', is 'rubin' meant?" ritz-fit truss.h5 \
    --tolerance 1 --methods rubn -o no.h5
expect 1 'there is no band' ritz-fit truss.h5 --tolerance 1e-2 -o no.h5
expect 1 'no method meets the tolerance; nearest is' "$@" --tolerance flexible=1e-9 \
    --largest 6 -o no.h5
expect 1 'is a component: --components is for scenes' "$@" --tolerance 1e-2 \
    --components x- -o no.h5
works '  leave nothing behind' test ! -e no.h5

# --- a scene -------------------------------------------------------------------------

import_spacecraft
spacecraft scene 'band_hz: [0, 5]' \
    'inputs: [{name: motor, at: rotor/bearing, component: 6, against: stator/bearing}]' \
    'outputs: [{name: gyro, at: platform/scan, component: 6}]'
expect 0 'at 2 configurations, and 4 more at random' ritz-fit scene.yaml \
    --tolerance flexible=1e-1 --methods craig-bampton --components s- -o s.h5
expect 0 'nested' ritz-info s-rotor.h5
expect 0 'flexible-response-relative' ritz-info s.h5

# the second stage of COMPARE is a method of scenes, and of nothing else
json 0 ritz-fit scene.yaml --tolerance flexible=1e-1 --methods \
    macneal-rubin,compare --components k- -o k.h5
holds '  compare is the smaller of two' \
    'j["method"] == "compare" and j["order"] < j["runner_up"]["order"]'
expect 0 'compare' ritz-info k-rotor.h5
expect 1 'compare: it is made of the modes of a scene' ritz-fit truss.h5 \
    --band-hz 0,20 --damping 'modal 0.01' --tolerance 1e-2 --methods compare

# its path: bodies cut as a row says are as far off as it says
json 0 ritz-fit scene.yaml --tolerance frequency=1e-2 --methods macneal-rubin \
    --between 0 --components s- -o s.h5
holds '  has a path, a column less each, from the answer down' \
    '[r["columns"] for r in j["path"]] ==
         list(range(j["columns"], j["path"][-1]["columns"] - 1, -1)) and
     all(sum(r["orders"].values()) == r["columns"] for r in j["path"]) and
     near([j["path"][0]["error"]], [j["error"]], 1e-9) and
     set(j["path"][0]["orders"]) == {"rotor", "stator"}'
mv log.json path.json
expect 0 'With the first columns alone' ritz-fit scene.yaml --tolerance \
    frequency=1e-2 --methods macneal-rubin --between 0 --components t-
expect 0 'system-frequency-relative' ritz-info t-rotor.h5
/usr/bin/python3 -s - >cut.yaml <<'END'
import json
orders = json.load(open("path.json"))["path"][2]["orders"]
for line in open("scene.yaml"):
    name = line.split(":")[0].strip()
    if name in orders:
        line = f"  {name}: {{model: s-{name}.h5, order: {orders[name]}}}\n"
    print(line, end="")
END
expect 0 '' ritz-assemble cut.yaml -q -o cut.h5
for angle in 0 90; do
    expect 0 '' ritz-assemble --full --at "clock=$angle" scene.yaml -q \
        -o full.h5
    json 0 ritz-verify --at "clock=$angle" full.h5 cut.h5 --band-hz 0,5 \
        -o verified.h5
    mv log.json "verified-$angle.json"
done
cp path.json log.json
holds '  says what a scene of the cut bodies comes to' \
    'near([max(m["value"] for a in (0, 90)
                for m in json.load(open(f"verified-{a}.json"))["measures"]
                if m["name"] == "frequency-relative")],
          [j["path"][2]["errors"]["frequency-relative"]], 1e-9)'
expect 0 "errors of the scene's system, not of this body" ritz-export \
    --to output4 s-rotor.h5 -o s.op4
expect 0 'system-frequency-relative' ritz-export --to output4 s-rotor.h5 \
    --order 15 -o s.op4

expect 1 'is a scene: --damper and --attach are for components' ritz-fit \
    scene.yaml --tolerance 1e-2 --attach bearing -o s.h5
sed '/^band_hz/d' scene.yaml >bare.yaml
expect 1 'the scene has no band' ritz-fit bare.yaml --tolerance 1e-2 -o s.h5
sed '/^inputs/d' scene.yaml >still.yaml
expect 1 "a tolerance of 'response' needs inputs and outputs" ritz-fit \
    still.yaml --tolerance response=1e-2 -o s.h5
expect 1 "a tolerance of 'flexible' needs inputs and outputs" ritz-fit \
    still.yaml --tolerance 1e-2 -o s.h5
expect 1 "'frequency=X' needs none" ritz-fit still.yaml --tolerance 1e-2 -o s.h5

# --- where an answer goes is seen to before the search ---------------------------

# nothing PREFIX: no file is called so.
nothing() {
    ls "$1"* >log 2>&1 && report no "no $1*" || report yes "  leaves no $1*"
}
set -- ritz-fit scene.yaml --tolerance frequency=1e-2 --methods macneal-rubin \
    --between 0 --components left-
for end in '-o nodir/s.h5' '--report nodir/s.txt' '-o .' '--report .'; do
    # shellcheck disable=SC2086 # two words
    json 1 "$@" $end
    holds '  says where, before there is any answer' \
        '"why" not in j and "methods" not in j and (
             "nodir/s" in j["error"] or "not a regular" in j["error"])'
    nothing left-
done
expect 1 "cannot create 'nodir/s-rotor.h5'" ritz-fit scene.yaml --tolerance \
    frequency=1e-2 --components nodir/s- -o new.h5
nothing new.h5
expect 1 "cannot create 'nodir/fit.h5'" ritz-fit truss.h5 --band-hz 0,20 \
    --tolerance frequency=1e-3 -o nodir/fit.h5
expect 1 "cannot create 'nodir/x.h5'" ritz-frf truss.h5 --to-hz 20 \
    -o nodir/x.h5

echo "1..$count"
