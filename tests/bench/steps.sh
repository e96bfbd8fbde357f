#!/bin/sh
# loops.sh FOLDER-OF-THE-TOOLS - processor time of a step of a closed loop,
# split and by one exponential, and of a step without a controller, on one
# thread: the table of docs/methods/closed-loop.md. The target bench_loops must
# be built by name, in the same build. It only prints, and decides nothing.
set -eu
bench=$1/../tests/bench_loops
if [ ! -x "$bench" ]; then
    echo "loops: no $bench, build the target bench_loops" >&2
    exit 0
fi
OMP_NUM_THREADS=1 OMP_THREAD_LIMIT=1
export OMP_NUM_THREADS OMP_THREAD_LIMIT
exec "$bench" 10 20 50 100 190 500
