#!/bin/sh
# loops.sh FOLDER-OF-THE-TOOLS - a step of a closed loop in time, split and by
# one exponential, beside one without a controller: the table of
# docs/methods/closed-loop.md, on one thread. Needs bench_loops, which is built
# by name beside the tools. A table, no verdict.
set -eu
bench=$1/../tests/bench_loops
if [ ! -x "$bench" ]; then
    echo "loops: no $bench, build the target bench_loops" >&2
    exit 0
fi
OMP_NUM_THREADS=1 OMP_THREAD_LIMIT=1
export OMP_NUM_THREADS OMP_THREAD_LIMIT
exec "$bench" 10 20 50 100 190 500
