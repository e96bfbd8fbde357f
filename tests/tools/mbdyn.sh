#!/bin/sh
# mbdyn.sh FOLDER-OF-THE-TOOLS - bodies of data/dualspin for the modal joint of
# MBDyn.
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

import_body rotor -q --port bearing=1 --units 'kg m s' -o rotor.h5
ritz-basis -q craig-bampton --modes 6 rotor.h5 -o basis.h5
ritz-reduce -q rotor.h5 basis.h5 -o small.h5
ritz-verify -q rotor.h5 small.h5 --band-hz 0,5 -o verified.h5

expect 0 '6 flexible modes' ritz-export --to mbdyn --damping 'modal 0.01' \
    verified.h5 -o rotor.fem
expect 0 "takes damping of the file by 'damping from file'" ritz-export \
    --to mbdyn --damping 'modal 0.01' verified.h5 -o rotor.fem
expect 0 '**   damping: modal 0.01' cat rotor.fem
expect 0 '**   error, measured: frequency-relative' cat rotor.fem
works 'inputs are named by their SHA-256' grep -q \
    "^\*\*   input: $(sha256sum <verified.h5 | cut -c 1-64)" rotor.fem
for group in 1 2 5 6 7 8 9 10 11 13; do
    works "  it has record group $group" \
        grep -q "^\*\* RECORD GROUP $group, " rotor.fem
done

# group 11 sums to the mass of the body, 2068.392 kg
works 'masses sum to that of the body' awk '
    /^\*\* RECORD GROUP/ { group = $4 + 0; next }
    !/^\*\*/ && group == 11 { m += $1 }
    END { exit !(m > 2068.3916 && m < 2068.3918) }' rotor.fem

# MBDyn warns of a matrix that differs from its transpose in one bit
works 'damping is symmetric in all digits' awk '
    /^\*\* RECORD GROUP/ { group = $4 + 0; next }
    !/^\*\*/ && group == 13 { for (k = 1; k <= NF; k++) d[count++] = $k }
    END { for (i = 0; i < 6; i++)
              for (j = 0; j < 6; j++)
                  bad += d[6 * i + j] != d[6 * j + i]
          exit !(count == 36 && bad == 0) }' rotor.fem

# modes of the tangent frame are those of the rotor held at its bearing
expect 0 'frame at grid 1, (0, 0, 0)' ritz-export --to mbdyn --frame 1 \
    --reference tangent verified.h5 -o held.fem
works 'grid 1 is still in every mode' awk '
    function zero(x) { return x < 1e-12 && x > -1e-12 }
    /MODE SHAPE #/ { getline
        for (k = 1; k <= 6; k++) bad += !zero($k)
        count++ }
    END { exit !(count == 6 && bad == 0) }' held.fem

# --- refusals --------------------------------------------------------------------------

expect 2 'takes no state space' ritz-export --states --to mbdyn verified.h5 \
    -o none.fem
expect 1 'no such' ritz-export --to mbdyn --frame 999 verified.h5 -o none.fem
ritz-reduce -q --without-basis rotor.h5 basis.h5 -o bare.h5
expect 1 'without-basis' ritz-export --force --to mbdyn bare.h5 -o none.fem
works '  and nothing is written' test ! -e none.fem
