#!/bin/sh
# export_42.sh FOLDER-OF-THE-TOOLS - flexible bodies for 42, of data/dualspin.
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

import_body rotor -q --port bearing=1 --units 'kg m s' -o rotor.h5
ritz-basis -q craig-bampton --modes 6 rotor.h5 -o basis.h5
ritz-reduce -q rotor.h5 basis.h5 -o small.h5
ritz-verify -q rotor.h5 small.h5 --band-hz 0,5 -o verified.h5

expect 0 'REFPT_JOINT; 1 of 1 ports are joints' ritz-export --to 42 --frame 1 \
    --damping 'modal 0.01' verified.h5 -o Flex.txt
expect 0 '0 is port bearing, grid 1' cat Flex.txt
expect 0 'error, measured: frequency-relative' cat Flex.txt
works 'inputs are named by their SHA-256' grep -q \
    "^input: $(sha256sum <verified.h5 | cut -c 1-64)" Flex.txt
expect 0 '41   ! Number of Nodes' cat Flex.txt.nodes
works 'lines that 42 reads fit into 80 bytes behind their numbers' sh -c \
    "! sed '/EOF/,\$d; s/^[-+0-9. e]*//' Flex.txt | grep -qE '^.{80}'"
expect 0 'REFPT_CM' ritz-export --to 42 verified.h5 -o Flex.txt

# --- refusals --------------------------------------------------------------------------

expect 1 '42 takes modes of a free body that are' ritz-export --to 42 --reference none \
    verified.h5 -o none.txt
expect 1 '' ritz-export --to 42 --frame 999999 verified.h5 -o none.txt
expect 2 'takes no state space' ritz-export --states --to 42 verified.h5 \
    -o none.txt
works '  and nothing is written' test ! -e none.txt -a ! -e none.txt.nodes
