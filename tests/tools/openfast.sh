#!/bin/sh
# openfast.sh FOLDER-OF-THE-TOOLS - superelements for OpenFAST of a body of
# data/dualspin that one grid holds.
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

import_body rotor -q --port bearing=1 --units 'kg m s' -o rotor.h5
ritz-basis -q craig-bampton --modes 6 rotor.h5 -o basis.h5
ritz-reduce -q rotor.h5 basis.h5 -o small.h5

ritz-verify -q rotor.h5 small.h5 --band-hz 0,5 -o verified.h5
for to in openfast openfast-4; do
    expect 0 'six directions of grid 1 and 6 modes' ritz-export --to $to \
        --damping 'modal 0.01' verified.h5 -o $to.dat
    expect 0 '! damping: modal 0.01' cat $to.dat
    expect 0 '! error, measured: frequency-relative' cat $to.dat
    expect 0 '!Dimension: 12' cat $to.dat
    works 'inputs are named by their SHA-256' grep -q \
        "^! input: $(sha256sum <verified.h5 | cut -c 1-64)" $to.dat
done
expect 1 '' grep -q '^!Loading' openfast.dat
expect 0 '' grep -q '^!Weight constant' openfast.dat
expect 0 '' grep -q '^!Loading' openfast-4.dat

# --- refusals --------------------------------------------------------------------------

import_body rotor -q --port bearing=1 -o bare.h5
ritz-basis -q craig-bampton --modes 6 bare.h5 -o basis.h5
ritz-reduce -q bare.h5 basis.h5 -o bare-small.h5
expect 1 'the units are not known: import with --units' \
    ritz-export --force --to openfast bare-small.h5 -o none.dat
ritz-basis -q macneal-rubin --modes 6 rotor.h5 -o basis.h5
ritz-reduce -q rotor.h5 basis.h5 -o free.h5
expect 0 'six directions of grid 1 and' \
    ritz-export --force --to openfast-4 free.h5 -o free.dat
expect 1 "there is no port 'bearings', is 'bearing' meant?" \
    ritz-export --force --port bearings --to openfast free.h5 -o none.dat
expect 2 'takes a model whole, without a choice of ports' \
    ritz-export --port bearing --to dmig verified.h5 -o none.dat
expect 2 'takes no state space' ritz-export --states --to openfast verified.h5 \
    -o none.dat
works '  and nothing is written' test ! -e none.dat
