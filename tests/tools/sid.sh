#!/bin/sh
# sid.sh FOLDER-OF-THE-TOOLS - Standard Input Data of a body of data/dualspin.
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

import_body rotor -q --port bearing=1 --units 'kg m s' -o rotor.h5
ritz-basis -q craig-bampton --modes 6 rotor.h5 -o basis.h5
ritz-reduce -q rotor.h5 basis.h5 -o small.h5
ritz-verify -q rotor.h5 small.h5 --band-hz 0,5 -o verified.h5

expect 0 'reference tangent' ritz-export --to sid --frame 1 \
    --damping 'modal 0.01' verified.h5 -o rotor.SID_FEM
expect 0 'error, measured: frequency-relative' head -n 1 rotor.SID_FEM
works 'inputs are named by their SHA-256' grep -q \
    "input: $(sha256sum <verified.h5 | cut -c 1-64)" rotor.SID_FEM
works 'the first line is short enough' test "$(head -n 1 rotor.SID_FEM |
    wc -c)" -lt 1022
expect 0 ' end part' tail -n 1 rotor.SID_FEM
works 'every number has 17 digits and a D' sh -c \
    "! grep -E '^ *m[01]' rotor.SID_FEM |
        grep -vqE '=[ -][0-9]\.[0-9]{16}D[+-][0-9]{2,3}$'"
expect 0 'reference mean-axis' ritz-export --to sid verified.h5 -o mean.SID_FEM
expect 0 'reference none' ritz-export --to sid --reference none verified.h5 \
    -o none.SID_FEM

# --- refusals --------------------------------------------------------------------------

ritz-reduce -q --without-basis rotor.h5 basis.h5 -o bare.h5
rm -f none.SID_FEM
expect 1 '--without-basis' ritz-export --force --to sid bare.h5 -o none.SID_FEM
expect 1 '' ritz-export --to sid --reference tangent verified.h5 -o none.SID_FEM
expect 1 '' ritz-export --to sid --frame 999999 verified.h5 -o none.SID_FEM
expect 2 'takes no state space' ritz-export --states --to sid verified.h5 \
    -o none.SID_FEM
works '  and nothing is written' test ! -e none.SID_FEM
