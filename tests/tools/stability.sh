#!/bin/sh
# stability.sh FOLDER-OF-THE-TOOLS - the probe before every export: what passes,
# what is refused by which check, and the same table from ritz-check.
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

# Masses 1 and 1 on springs 1 and 2 to the ground and 4 between them, a dashpot
# of 1 at the first, of c at the second.
array k.mtx '2 2' 5 -4 -4 6
array m.mtx '2 2' 1 0 0 1
printf '1 1\n2 1\n' >two.dofs
for c in 0.1 -0.1; do
    array d.mtx '2 2' 1 0 0 "$c"
    ritz-import -q --stiffness k.mtx --mass m.mtx --damping d.mtx \
        --dofs two.dofs --port tip=1:1 -o "two$c.h5"
    ritz-basis -q full "two$c.h5" -o basis.h5
    ritz-reduce -q "two$c.h5" basis.h5 -o "small$c.h5"
done
expect 0 '8 pass, 0 warn, 0 fail' ritz-check small0.1.h5
json 0 ritz-export --to output4 small0.1.h5 -o good.op4
holds '  with its probe' 'j["stability"] == "stable" and
    [c["name"] for c in j["probe"]] == ["mass-definite", "stiffness-definite",
    "damping-definite", "poles", "energy-growth", "passivity",
    "interface-locked", "interface-sprung"] and
    all(c["verdict"] == "pass" for c in j["probe"])'
expect 1 "'small-0.1.h5' is unstable: with its interface held: pole at +0.05" \
    ritz-export --to output4 small-0.1.h5 -o none.op4
expect 1 '(interface-locked); export it all the same with --force' \
    ritz-export --to output4 small-0.1.h5 -o none.op4
works '  and nothing is written' test ! -e none.op4
expect 0 "warning: 'small-0.1.h5' is unstable" ritz-export --to output4 --force \
    small-0.1.h5 -o forced.op4
expect 1 "2 of 8 checks fail, first 'interface-locked'" \
    ritz-check small-0.1.h5
json 1 ritz-check small-0.1.h5
holds '  says where energy comes out' '[c["where"] for c in j["checks"]
    if c["name"] == "passivity"][0].endswith("Hz, tip, grid 1 T1")'

# --- digits of a file are those that its reader integrates ---------------------------

# A free chain of three masses whose springs have no short decimals.
array k.mtx '3 3' 0.333333333333333333 -0.333333333333333333 0 \
    -0.333333333333333333 1.047619047619047619 -0.714285714285714286 \
    0 -0.714285714285714286 0.714285714285714286
array m.mtx '3 3' 1 0 0 0 2 0 0 0 1
printf '1 1\n2 1\n3 1\n' >three.dofs
ritz-import -q --stiffness k.mtx --mass m.mtx --dofs three.dofs \
    --port tip=1:1 -o three.h5
ritz-basis -q full three.h5 -o basis.h5
ritz-reduce -q three.h5 basis.h5 -o three-small.h5
expect 0 '0 fail' ritz-export --to output4 --text three-small.h5 -o all.op4
expect 1 'stiffness with a negative eigenvalue' ritz-export --to output4 --text \
    --digits 5 three-small.h5 -o few.op4

# --- pairs of a state space -----------------------------------------------------------

array a.mtx '2 2' 0 -1 1 -0.1
array b.mtx '2 1' 0 1
array c.mtx '1 2' 1 -0.5
ritz-import -q --state-space A=a.mtx,B=b.mtx,C=c.mtx --input-names tip \
    --output-names tip -o pair.h5
ritz-import -q --state-space A=a.mtx,B=b.mtx,C=c.mtx --input-names tip \
    --output-names root -o apart.h5
expect 1 'is unstable: with its outputs held: pole at +2 rad/s' \
    ritz-export --to matlab pair.h5 -o pair.mat
expect 0 'stable: pole at' ritz-export --to matlab apart.h5 -o apart.mat
