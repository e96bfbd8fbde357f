#!/bin/sh
# solid.sh FOLDER-OF-THE-TOOLS [NX NY NZ] - seconds and peak memory of each step
# of a reduction of a solid block; 25 x 25 x 25 bricks (53 thousand dofs) unless
# other numbers are given. A table, no verdict.
set -eu
bin=$(cd "$1" && pwd)
here=$(cd "$(dirname "$0")" && pwd)
nx=${2:-25} ny=${3:-25} nz=${4:-25}
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
n=$(/usr/bin/python3 -s "$here/brick.py" "$nx" "$ny" "$nz" .)
# a patch of four by four grids: on one line they would not hold the body
port=$(awk -v n="$((nz + 1))" 'BEGIN {
    for (j = 0; j < 4; j++)
        for (k = 1; k <= 4; k++)
            printf "%s%d", (j + k > 1 ? "," : ""), j * n + k
}')
printf '%s dofs, 50 modes, 48 interface dofs\n%-34s %9s %9s\n' \
    "$n" step seconds MB

# step NAME COMMAND...
step() {
    name=$1
    shift
    rm -f record
    "$bin/$@" -q --record record
    /usr/bin/python3 -s -c 'import json, sys
r = json.loads(open("record").readline())
print("%-34s %9.2f %9.0f" % (sys.argv[1], r["seconds"]["wall"],
                             r["peak_bytes"] / 1e6))' "$name"
}

step import ritz-import --stiffness K.mtx --mass M.mtx --dofs dofs.txt \
    --bulk grids.bdf --port face="$port" -o solid.h5
step check ritz-check solid.h5
step craig-bampton ritz-basis craig-bampton --modes 50 solid.h5 -o cb.h5
step reduce ritz-reduce solid.h5 cb.h5 -o cbr.h5
step macneal-rubin ritz-basis macneal-rubin --modes 50 solid.h5 -o mr.h5
