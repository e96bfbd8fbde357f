#!/bin/sh
# Faults in every tool: allocations and calls that write fail, disks are full,
# runs are killed.
# Usage: faults.sh BUILD-FOLDER [TRIES] [KIND]...
# TRIES is the number of faults of each kind for each case: 1 for check, 50 for
# a night. A KIND is memory, write, disk or kill; by default all are tried. The
# script ends with a table, and with status 1 if there is a finding.
set -eu
build=$(cd "$1" && pwd)
tries=${2:-1}
shift $(($# < 2 ? $# : 2))
here=$(cd "$(dirname "$0")" && pwd)
data=${RITZ_DATA:-$here/../../data}/dualspin
preload=$build/tests/libritz_faults.so
[ -f "$data/rotor.op4" ] && [ -f "$preload" ] || {
    echo "skipped: no data in $data, or no $preload"
    exit 77
}
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
trap 'exit 129' HUP
trap 'exit 130' INT
trap 'exit 143' TERM
PATH=$build/bin:$PATH
export OMP_NUM_THREADS=1 OMP_THREAD_LIMIT=1 RITZ_SYNC=1
mkdir "$dir/good"
cd "$dir/good"
. "$here/../fuzz/sound.sh"
/usr/bin/python3 -s -B "$here/faults.py" "$dir/good" "$preload" \
    "$tries" "$@"
