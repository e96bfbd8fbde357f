#!/bin/sh
# Two-stage reduction as its user meets it: what stage two is made from, what it
# is augmented by, what becomes of extraneous modes, tracks, tolerances.
# Usage: compare.sh FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

# --- the spacecraft, at few angles so as to be quick ---------------------------

import_spacecraft --port boom=33

# scene NAME KEY...: one of these, with inputs and outputs.
scene() {
    name=$1
    shift
    spacecraft "$name" 'inputs:' \
        '  - {name: motor, at: rotor/bearing, component: 6, against: stator/bearing}' \
        '  - {name: thruster, at: rotor/boom, component: [1, 3]}' 'outputs:' \
        '  - {name: gyro, at: platform/scan, component: 6}' \
        '  - {name: tip, at: rotor/boom, component: 3}' 'band_hz: [0, 2]' "$@"
}

# --- what stage two is made from ------------------------------------------------

scene list 'select: {modes: [1, 2, 4]}'
expect 0 'modes by a list of 3' ritz-compare list.yaml -o list.h5
json 0 ritz-compare list.yaml -o list.h5
holds '  keeps those modes, exact at both angles' \
    'j["kept"] == [[1, 2, 4], [1, 2, 4]] and all(
         c["errors"]["frequency"] <= c["errors"]["frequency_allowed"]
         for c in j["configurations"] if c["listed"])'
holds '  lists modes that stand for none of them' \
    'all(c["extraneous"] and not any(e["removed"] for e in c["extraneous"])
         for c in j["configurations"])'
scene band 'select: {by: band}'
expect 0 'modes in the band' ritz-compare band.yaml -o band.h5
scene krylov 'select: {by: krylov, vectors: 8, start: both}'
expect 0 'up to 8 Krylov vectors from inputs and outputs at each' \
    ritz-compare krylov.yaml -o krylov.h5
json 0 ritz-compare krylov.yaml -o krylov.h5
holds '  keeps four moments, and no mode' \
    'all(c["moments"] == 4 and c["errors"]["moments"] < 1e-8 and
         c["errors"]["frequency"] is None for c in j["configurations"]
         if c["listed"]) and j["kept"] == [[], []]'
scene far 'select: {modes: [1, 99]}'
expect 1 'selection: mode 99 is listed, and there are' \
    ritz-compare far.yaml -o far.h5
scene no 'select: {modes: [1], by: band}'
expect 1 'no.yaml:17:26: modes are chosen by a list or by something, not both' \
    ritz-compare no.yaml -o no.h5

# --- static corrections ----------------------------------------------------------

scene component 'select: {by: band}' 'augment: component'
expect 0 '> inputs, interface' ritz-compare component.yaml -o component.h5
json 0 ritz-compare component.yaml -o component.h5
holds '  is exact at every angle with all attached, and with fewer is not' \
    '[max(c["gain_listed"], c["gain_between"]) < 1e-8
      for c in j["candidates"]] == [False, False, False, True, True]'
scene auto 'select: {by: band}' \
    'augment: {level: component, attached: auto, tolerance: 1e-3}'
json 0 ritz-compare auto.yaml -o auto.h5
holds '  chooses the smallest set that is near enough by both singular values' \
    'min((sum(c["orders"]), c["attached"]) for c in j["candidates"]
         if max(c["singular_value"], c["smallest_singular_value"]) <= 1e-3)[0]
     == [sum(c["orders"]) for c in j["candidates"] if c["chosen"]][0]'
holds '  shows each force alone, and how many smaller sets are excluded' \
    'sum(c["forces"] == 1 for c in j["candidates"]) ==
         j["attached_search"]["pool"] > 20 and
     j["attached_search"]["none_up_to"] >= 1 and
     all(max(c["singular_value"], c["smallest_singular_value"]) > 1e-3
         for c in j["candidates"]
         if c["forces"] <= j["attached_search"]["none_up_to"]) and
     [c["forces"] - j["attached_search"]["none_up_to"] - 1
      for c in j["candidates"] if c["chosen"]] == [j["attached_search"]["gap"]]'
scene few 'select: {by: band}' \
    'augment: {level: system, attached: auto, among: [outputs, rotor/boom:3]}'
json 0 ritz-compare few.yaml -o few.h5
holds '  may choose from what the scene names' \
    'j["attached_search"]["pool"] == 2 and
     {c["attached"] for c in j["candidates"] if c["forces"] == 1} ==
         {"gyro", "tip"}'
scene named 'select: {modes: [1]}' \
    'augment: {level: component, attached: [motor, tip, rotor/boom, stator/5:2]}'
expect 0 '> motor, tip, rotor/boom:1' ritz-compare named.yaml -o named.h5
scene astray 'select: {modes: [1]}' \
    'augment: {level: system, attached: [rotor/bom:3]}'
expect 1 "astray.yaml:18:37: attached dof 'bom:3': there is no port 'bom'" \
    ritz-compare astray.yaml -o astray.h5
scene tight 'select: {modes: [1]}' \
    'augment: {level: system, attached: auto, tolerance: 1e-9}'
expect 0 'warning: no set of attached dofs brings the largest singular value' \
    ritz-compare tight.yaml -o tight.h5
scene one 'select: {modes: [1]}' 'augment: {level: system, attached: [motor]}'
expect 0 'Composite set: 20 vectors from 2 configurations' \
    ritz-compare one.yaml -o one.h5

# --- very many configurations -------------------------------------------------

grid=$(seq -s, 0 299)
scene many
sed -e "s/angles_deg: \[0, 90\]/angles_deg: [$grid]/" \
    -e "s/angles_deg: \[0\]/angles_deg: [$grid]/" many.yaml >grid.yaml
for tool in compare assemble; do
    works "$tool says before how long 90000 configurations take" \
        /usr/bin/python3 -s - "ritz-$tool" <<'END'
import re, subprocess, sys
run = subprocess.Popen([sys.argv[1], "grid.yaml", "-o", "grid.h5"],
                       stderr=subprocess.PIPE, text=True)
line = run.stderr.readline()
run.terminate()
run.wait(60)
sys.exit(0 if re.search(r"90000 configurations: to assemble them takes about "
                        r"[\d.e+]+ (s|min|h|days) and [\d.e+-]+ GB; list those",
                        line) else line)
END
done
works 'one of them by --at is no cause to warn' sh -c \
    '! ritz-assemble grid.yaml --at clock=1,cone=2 -o grid.h5 2>&1 |
        grep "configurations: to"'

# --- extraneous modes --------------------------------------------------------------

scene remove 'select: {modes: [1, 2, 4]}' 'extraneous: remove'
expect 0 'were removed; the components still contain them' \
    ritz-compare remove.yaml --components r- -o remove.h5
json 0 ritz-info remove.h5
holds '  leaves eight rigid modes and those that were kept' \
    'all(len(c["frequencies_hz"]) == 11 for c in j["configurations"])'
expect 0 'extraneous_removed' ritz-compare list.yaml --extraneous out-of-band \
    --json -o list.h5
json 0 ritz-compare component.yaml -o component.h5
whole=$(/usr/bin/python3 -s -c 'import json
print(sum(c["dofs"] for c in json.load(open("log.json"))["components"]))')
scene compact 'select: {by: band}' 'augment: component' 'extraneous: compact'
expect 0 'vectors of components that made extraneous modes are dropped' \
    ritz-compare compact.yaml --components c- -o compact.h5
json 0 ritz-compare compact.yaml -o compact.h5
holds '  drops vectors of components and keeps modes within the tolerance' \
    'j["dropped"] > 0 and j["next_drop"] > 1e-3 and
     sum(c["dofs"] for c in j["components"]) + j["dropped"] == '"$whole"' and
     all(c["errors"]["frequency"] <= 1e-3 and c["errors"]["response"] <= 2e-3
         and c["errors"]["gain"] < 1e-8
         for c in j["configurations"] if c["listed"])'
expect 1 "--extraneous: unknown fate of extraneous modes 'drop'" \
    ritz-compare list.yaml --extraneous drop -o list.h5

# --- tracks, tolerances --------------------------------------------------------------

expect 0 'Flexible modes over 2 configurations' \
    ritz-assemble list.yaml --tracks tracks.tsv -o stage1.h5
json 0 ritz-assemble list.yaml -o stage1.h5
holds '  says which modes change places, tie, mix or are lost' \
    'set(j["tracking"]) == {"tracks", "swaps", "near_ties",
                            "avoided_crossings", "lost"}'
expect 0 'track	configuration	mode	hertz	mac' head -n 1 tracks.tsv
expect 2 '--full makes one component' \
    ritz-assemble list.yaml --full --tracks t.tsv -o full.h5
expect 0 'Composite tolerance against orders' \
    ritz-compare component.yaml --tolerances 1e-12,1e-3 \
    --tolerance-table tolerances.tsv --tracks t.tsv -o component.h5
expect 0 'tolerance	total	system	removed	frequency	gain	response	rotor' \
    head -n 1 tolerances.tsv
expect 0 '3 tolerances.tsv' wc -l tolerances.tsv
json 0 ritz-compare component.yaml --tolerances 1e-12,1e-3 -o component.h5
holds '  a looser tolerance costs exactness and never gain' \
    'j["tolerances"][0]["frequency"] < j["tolerances"][1]["frequency"] and
     all(t["gain"] < 1e-8 for t in j["tolerances"])'
expect 2 "--tolerances takes numbers between 0 and 1, not '2'" \
    ritz-compare list.yaml --tolerances 1e-3,2 -o list.h5

# --- dampers in bodies and joints, compared with the full system --------------

mkdir damped
cd damped || exit 1
import_spacecraft --damper strut=33:3,54:3*12 --damper brace=23:1,27:1*400
# damped NAME ROTOR-KEY KEY...: a scene with dampers in the rotor and in the
# joint 'cone'.
damped() {
    name=$1 rotor=$2
    shift 2
    spacecraft "$name" 'inputs:' \
        '  - {name: motor, at: rotor/bearing, component: 6}' 'outputs:' \
        '  - {name: gyro, at: platform/scan, component: 6}' 'band_hz: [0, 5]' \
        'select: {by: band}' "$@"
    sed -e "s/modes: 12/up_to_hz: 20$rotor/" \
        -e 's/craig-bampton, modes: 4/craig-bampton, up_to_hz: 100/' \
        -e 's/angles_deg: \[0\]/&, state: caged, stiffness: 50, damping: 8/' \
        "$name.yaml" >part && mv part "$name.yaml"
}
damped with '' 'augment: system'
damped without ', loads: [attached]' \
    'augment: {level: system, attached: [inputs]}'
expect 0 'damping   1 - MAC' ritz-compare without.yaml -o without.h5
mv log said
works '  where a basis has no vectors for dampers, it says so' grep -q \
    'note  *basis of rotor: 2 damper(s) without a static vector' said
json 0 ritz-assemble without.yaml --at clock=90 -o one.h5
holds '  as ritz-assemble does' 'j["notes"][0]["component"] == "rotor" and
    "2 damper(s) without" in j["notes"][0]["note"]'
json 0 ritz-compare with.yaml -o with.h5
holds '  damping is right to 1e-4 at all angles' \
    'all(0 < c["errors"]["damping"] < 1e-4 for c in j["configurations"])'
expect 0 'stage1-damping-relative' ritz-info with.h5
ritz-assemble with.yaml --at clock=90 --full -q -o full.h5
expect 0 'damping-relative' ritz-verify full.h5 with.h5 --at clock=90,cone=0 \
    --band-hz 0,5 --limit-damping 1e-4 -o verified.h5
expect 1 'damping-relative' ritz-verify full.h5 without.h5 \
    --at clock=90,cone=0 --band-hz 0,5 --limit-damping 5e-3 -o verified.h5
json 0 ritz-compare with.yaml --tolerances 1e-12 --tolerance-table t.tsv -o w.h5
holds '  and the table of tolerances has it' \
    '0 < j["tolerances"][0]["damping"] < 1e-4'
expect 0 'platform	damping' head -n 1 t.tsv
cd ..

# --- structural damping: K4 of a body is in every system and in no ranking ----

cat >loss.py <<'END'
import h5py, shutil
shutil.copy("rotor.h5", "lossy.h5")
with h5py.File("lossy.h5", "r+") as f:
    f.copy("K", "K4")
    data = f["K4/data"][()]
    del f["K4/data"]
    f["K4/data"] = 0.02 * data
END
/usr/bin/python3 -s loss.py
scene lossy 'select: {by: band}' 'augment: system'
sed 's/rotor.h5/lossy.h5/' lossy.yaml >part && mv part lossy.yaml
json 0 ritz-compare lossy.yaml -o lossy.h5.system
holds '  losses of kept modes are right' \
    'all(0 < c["errors"]["damping"] < 1e-7 for c in j["configurations"]
         if c["listed"])'
json 0 ritz-poles lossy.h5.system --at clock=90,cone=0 --modes 3
holds '  no rigid motion among the poles, and each decays' \
    'len(j["poles"]) == 3 and all(p["hertz"] > 0.1 and p["real"] < 0
         for p in j["poles"])'
sed 's/{by: band}/{by: hankel}/' lossy.yaml >ranked.yaml
expect 0 "the structural damping of 'ranked.yaml' is left out of its ranking" \
    ritz-compare ranked.yaml -o ranked.h5

# --- an angle to add -------------------------------------------------------------------

scene wide 'select: {modes: [1, 2, 3, 4, 5]}' 'augment: system' \
    'composite: {reference: [{clock: 0}]}'
json 0 ritz-compare wide.yaml -o wide.h5
holds '  the worst error between listed angles is told' \
    'j["suggestion"]["at"] == "clock=45,cone=0" and
     j["suggestion"]["error"] >= 0'

echo "1..$count"
