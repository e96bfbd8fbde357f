#!/bin/sh
# invariants.sh FOLDER-OF-THE-TOOLS [BRICKS]... - processor seconds, on one
# thread, of inertia invariants beside those of the reduced mass, for 100 columns
# of solid blocks of BRICKS^3 bricks; 14 and 32 (10 and 108 thousand dofs) unless
# other numbers are given. Needs bench_invariants, which is built by name beside
# the tools. A table, no verdict.
set -eu
bin=$(cd "$1" && pwd)
here=$(cd "$(dirname "$0")" && pwd)
shift
[ $# -gt 0 ] || set -- 14 32
bench=$bin/../tests/bench_invariants
if [ ! -x "$bench" ]; then
    echo "invariants: no $bench, build the target bench_invariants" >&2
    exit 0
fi
OMP_NUM_THREADS=1 OMP_THREAD_LIMIT=1
export OMP_NUM_THREADS OMP_THREAD_LIMIT
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
for n in "$@"; do
    /usr/bin/python3 -s "$here/brick.py" "$n" "$n" "$n" . >dofs
    "$bin/ritz-import" -q --stiffness K.mtx --mass M.mtx --dofs dofs.txt \
        --bulk grids.bdf --port face=1 -o "solid-$n.h5"
done
"$bench" 100 solid-*.h5
