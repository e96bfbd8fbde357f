#!/bin/sh
# Damaged input through every tool: status 0 or 1, one sentence where it is 1,
# no signal, no partial output. The readers have tests of their own in process;
# these are the tools end to end, on the dual-spin spacecraft.
# Usage: damage.sh FOLDER-OF-THE-TOOLS [SEEDS]
# SEEDS random damages for each file and tool; 7 is every kind of damage once.
# Slow, for a night: damage.sh build/dev-gcc/bin 500
set -eu
bin=$(cd "$1" && pwd)
seeds=${2:-7}
here=$(cd "$(dirname "$0")" && pwd)
data=${RITZ_DATA:-$here/../../data}/dualspin
[ -f "$data/rotor.op4" ] || {
    echo "ok 1 - damage # SKIP no data in $data"
    echo '1..1'
    exit 0
}
dir=$(mktemp -d)
failed=yes
trap '[ "$failed" = yes ] || rm -rf "$dir"' EXIT
PATH=$bin:$PATH
mkdir "$dir/good"
cd "$dir/good"

. "$here/sound.sh"
/usr/bin/python3 -s "$here/damage.py" "$dir/good" "$seeds"
failed=no
