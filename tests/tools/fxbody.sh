#!/bin/sh
# fxbody.sh FOLDER-OF-THE-TOOLS - flexible bodies for Radioss, of data/dualspin.
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

import_body rotor -q --port bearing=1 --units 'kg m s' -o rotor.h5
ritz-basis -q craig-bampton --modes 6 rotor.h5 -o basis.h5
ritz-reduce -q rotor.h5 basis.h5 -o small.h5
ritz-verify -q rotor.h5 small.h5 --band-hz 0,5 -o verified.h5

expect 0 'Rayleigh damping, alpha 0.1, beta 0.002' ritz-export --to fxbody \
    --damping 'rayleigh 0.1 0.002' verified.h5 -o rotor.fxb
expect 0 '       6       0      41       1       1       0       0' cat rotor.fxb
expect 0 '# error, measured: frequency-relative' cat rotor.fxb
works 'inputs are named by their SHA-256' grep -q \
    "^# input: $(sha256sum <verified.h5 | cut -c 1-64)" rotor.fxb
works 'no line is longer than Radioss reads' sh -c \
    "! grep -qE '^.{101}' rotor.fxb"
expect 0 'warning: damping is not alpha M + beta K' ritz-export --to fxbody \
    --damping 'modal 0.01' verified.h5 -o rotor.fxb
expect 0 'frame at grid 1' ritz-export --to fxbody --frame 1 verified.h5 \
    -o rotor.fxb

# --- refusals --------------------------------------------------------------------------

expect 1 '' ritz-export --to fxbody --frame 999999 verified.h5 -o none.fxb
expect 1 '' ritz-export --to fxbody --reference tangent verified.h5 -o none.fxb
expect 2 'takes no state space' ritz-export --states --to fxbody verified.h5 \
    -o none.fxb
works '  and nothing is written' test ! -e none.fxb
