#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs the decks of this folder through NASTRAN-95 and stores K and M beside them.
# usage: make-matrices.sh NASTRAN-DIR    (the folder that holds bin/nastrn and rf/)
#
# Each NAME.deck is the executive and case control below + NAME.bdf + ENDDATA:
# edit the .bdf only.  KEEP_OUTPUT=FOLDER keeps the printed output as well.
set -eu

here=$(cd "$(dirname "$0")" && pwd)
nastran=$(cd "${1:?usage: $0 NASTRAN-DIR}" && pwd)
work=$(mktemp -d "${TMPDIR:-/tmp}/dualspin.XXXXXX")
trap 'rm -rf "$work"' EXIT

# executive and case control; the platform has no stiffness, so only M leaves
# and the run ends there
head_of() {
    case $1 in
    platform) matrices='MGG,,,,//-1/-14' ; stop='EXIT $' ;;
    *)        matrices='KGG,MGG,,,//-1/-14' ; stop= ;;
    esac
    cat <<HEAD
NASTRAN BANDIT=-1
ID RITZ,$(echo "$1" | tr '[:lower:]' '[:upper:]')
APP DISP
SOL 3,0
TIME 10
DIAG 14
ALTER 42 \$
OUTPUT4 $matrices \$
HEAD
    if [ -n "$stop" ]; then echo "$stop"; fi
    cat <<HEAD
ENDALTER \$
CEND
TITLE = DUAL-SPIN SPACECRAFT, $1
METHOD = 1
BEGIN BULK
EIGR    1       FEER    0.0                     30
HEAD
}

# nastrn keeps file names in short buffers: run inside the temporary folder
# and name everything relative to it
run() {
    name=$1
    mkdir "$work/$name"
    cd "$work/$name"
    ln -s "$nastran/rf" rf
    export RFDIR=rf DIRCTY=. DBMEM=12000000 OCMEM=2000000
    export LOGNM=log NPTPNM=nptp DICTNM=dict PLTNM=plot PUNCHNM=punch
    export OPTPNM=none
    for i in 1 2 3 4 5 6 7 8 9 10; do export "SOF$i=none"; done
    for i in 11 12 13 14 15 16 17 18 19 20 21 22 23; do
        export "FTN$i=ftn$i"
    done
    { head_of "$name"; cat "$here/$name.bdf"; echo ENDDATA; } >"$name.deck"
    "$nastran/bin/nastrn" <"$name.deck" >"$name.f06" || true
    if [ ! -s ftn14 ]; then
        echo "make-matrices: no matrix came out of '$name.deck':" >&2
        grep FATAL "$name.f06" >&2 || true
        exit 1
    fi
    cp "$name.deck" "$here/$name.deck"
    cp ftn14 "$here/$name.op4"
    if [ -n "${KEEP_OUTPUT:-}" ]; then cp "$name.f06" "$KEEP_OUTPUT"; fi
}

for name in rotor stator platform; do
    run "$name"
done
