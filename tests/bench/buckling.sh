#!/bin/sh
# buckling.sh FOLDER-OF-THE-TOOLS [POINTS]... - processor seconds, on one thread,
# of the buckling factors of plates with POINTS points inside a side, under loads
# of one sign and of both, and their errors; beside them the reduction of KG and
# of K to 100 columns. 32, 100 and 316 (1, 10 and 100 thousand dofs) unless other
# numbers are given. Needs bench_buckling, which is built by name beside the
# tools. A table, no verdict.
set -eu
bin=$(cd "$1" && pwd)
shift
[ $# -gt 0 ] || set -- 32 100 316
bench=$bin/../tests/bench_buckling
if [ ! -x "$bench" ]; then
    echo "buckling: no $bench, build the target bench_buckling" >&2
    exit 0
fi
OMP_NUM_THREADS=1 OMP_THREAD_LIMIT=1
export OMP_NUM_THREADS OMP_THREAD_LIMIT
exec "$bench" 100 "$@"
