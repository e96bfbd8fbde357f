#!/bin/sh
# dmig_out.sh FOLDER-OF-THE-TOOLS - a body as DMIG cards: what is said of their
# digits, and the same frequencies from the file that was written.
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

expect 0 '' import_body stator -q --port bearing=1 --port scan=5 \
    --units 'kg m s' -o stator.h5
ritz-basis -q craig-bampton --modes 6 stator.h5 -o basis.h5
ritz-reduce -q stator.h5 basis.h5 -o small.h5

json 0 ritz-export --to dmig --damping 'modal 0.01' small.h5 -o stator.dmig
holds '  says what its digits do' 'all(any(w in line for line in j["said"])
    for w in ("12 dofs of interface grids", "SPOINT", "K2GG = KAAX",
    "B2GG = BAAX", "6 rigid motions r", "Hz change by")) and
    not any("warning" in line for line in j["said"])'
works '  and the file says so too' grep -q '^\$ 6 rigid motions r' stator.dmig
works '  with the digest of what it is made of' grep -qE \
    '^\$ [0-9a-f]{64}' stator.dmig
works '  and its errors' grep -q '^\$ error, estimated: ' stator.dmig

# Back again: all coordinates become dofs, whose modes are those of small.h5.
expect 0 '' ritz-import -q --stiffness stator.dmig:KAAX \
    --mass stator.dmig:MAAX --port bearing=1 -o again.h5
ritz-basis -q full again.h5 -o all.h5
ritz-reduce -q again.h5 all.h5 -o again-small.h5
json 0 ritz-info small.h5
cp log.json before.json
json 0 ritz-info again-small.h5
holds '  has the same frequencies' 'near(j["frequencies_hz"],
    json.load(open("before.json"))["frequencies_hz"], 1e-9)'

expect 0 '' ritz-export -q --to dmig --numbered small.h5 -o numbered.dmig
works '  and marks every continuation' grep -q '^.\{72\}\*R000001$' \
    numbered.dmig
expect 2 'has no continuations to number' ritz-export --to output4 --numbered \
    small.h5 -o none.op4

ritz-basis -q macneal-rubin --modes 6 stator.h5 -o free.h5
ritz-reduce -q stator.h5 free.h5 -o free-small.h5
expect 1 'no coordinate is its displacement' ritz-export --to dmig \
    free-small.h5 -o none.dmig
ritz-reduce -q --without-basis stator.h5 basis.h5 -o bare.h5
expect 1 'it was made --without-basis' ritz-export --to dmig bare.h5 \
    -o none.dmig
works '  and nothing is written' test ! -e none.dmig
