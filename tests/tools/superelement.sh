#!/bin/sh
# superelement.sh FOLDER-OF-THE-TOOLS - a body as an external superelement of
# NASTRAN, and back again as a component with the same frequencies.
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

# Rows of two bars, of which the second lacks one.
cat >rows.py <<'END'
print("%%MatrixMarket matrix array real general\n15 60")
for j in range(60): # the last three rows of the matrices are empty
    for i in range(15):
        print(repr((i + 1) / (j + 3.0) if j < 54 else 0.0))
END
for i in m1a m2a m1b m2b v1 v2 axial torque; do echo "7 cbar.$i"; done >rows
for i in m1a m2a m1b m2b v1 v2 axial; do echo "9 cbar.$i"; done >>rows
/usr/bin/python3 -s rows.py >rows.mtx
expect 0 '' import_body stator -q --port bearing=1 --port scan=5 \
    --recovery force=rows.mtx --recovery-rows force=rows \
    --units 'kg m s' -o stator.h5
ritz-basis -q craig-bampton --modes 6 stator.h5 -o basis.h5
ritz-reduce -q stator.h5 basis.h5 -o small.h5

json 0 ritz-export --to superelement --damping 'modal 0.01' --id 11 small.h5 \
    -o stator.op4
holds '  says what is where' 'all(any(w in line for line in j["said"])
    for w in ("12 dofs of interface grids", "SPOINT", "UNIT=11",
    "INCLUDE '"'stator.asm'"' in the main bulk data", "MUG1",
    "of 1 elements, are MEF1, named by TEF1",
    "MEF1 lacks rows that are not whole elements: '"'force'"' element 9 cbar.m1a"))'
works '  three files appear' test -s stator.asm -a -s stator.pch
for deck in asm pch; do
    works "  the .$deck names the errors" \
        grep -q '^\$ error, estimated: ' stator.$deck
    works '  and the digest of what it is made of' grep -qE \
        '^\$ [0-9a-f]{64}' stator.$deck
done
works '  the number is that of the superelement' grep -q \
    '^BEGIN SUPER      11$' stator.pch

# Back again: coordinates become dofs, and the grids of ports are there.
json 0 ritz-import --superelement stator.op4 --port bearing=1 --port scan=5 \
    -o again.h5
holds '  EXTRN names its rows' 'j["map"] == "EXTRN"'
holds '  other matrices are listed' '[t.split()[0] for t in j["not_taken"]]
    == ["VA"]'
holds '  rows come back by TUG1 and TEF1' '[(q["name"], q["rows"]) for q in
    j["quantities"]] == [("displacement", 12), ("force", 8)]'
json 0 ritz-import --superelement stator.op4 --recovery \
    force=stator.op4:MEF1,other -o own.h5
holds '  a quantity of the same name takes its place' '[(q["name"], q["kind"])
    for q in j["quantities"]] == [("displacement", "displacement"),
    ("force", "other")]'
ritz-basis -q full again.h5 -o all.h5
ritz-reduce -q again.h5 all.h5 -o again-small.h5
json 0 ritz-info small.h5
cp log.json before.json
json 0 ritz-info again-small.h5
holds '  has the same frequencies' 'near(j["frequencies_hz"],
    json.load(open("before.json"))["frequencies_hz"], 1e-12)'

# The .asm does without the .pch, nothing does without both.
mv stator.pch away
expect 0 'rows named by  grids ascending' ritz-import --superelement \
    stator.op4 -o asm.h5
mv stator.asm elsewhere
expect 1 'no .pch and no .asm' ritz-import --superelement stator.op4 \
    -o none.h5
expect 0 'rows named by  EXTRN' ritz-import --superelement stator.op4 \
    --bulk away -o bulk.h5
expect 2 'superelement names all matrices' ritz-import --superelement \
    stator.op4 --mass stator.op4:MAA -o none.h5
expect 1 'has no stiffness of an external superelement' ritz-import \
    --superelement "$data/dualspin/stator.op4" -o none.h5

expect 1 'does not end with .op4' ritz-export --to superelement small.h5 \
    -o none.bdf
expect 2 'output4 has no superelement to number' ritz-export --to output4 --id 5 \
    small.h5 -o none.op4
ritz-basis -q macneal-rubin --modes 6 stator.h5 -o free.h5
ritz-reduce -q stator.h5 free.h5 -o free-small.h5
expect 1 'no coordinate is its displacement' ritz-export --to superelement \
    free-small.h5 -o none.op4
mkdir none.pch
expect 1 'none.pch' ritz-export --to superelement small.h5 -o none.op4
works '  and nothing is written' test ! -e none.op4 -a ! -e none.asm -a \
    ! -e none.h5
