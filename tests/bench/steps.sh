#!/bin/sh
# steps.sh FOLDER-OF-THE-TOOLS - processor time of a step of each kind of run
# over the number of modes, and its exponent, on one thread: the tables of
# docs/methods/simulate.md and closed-loop.md. The target bench_steps must be
# built by name, in the same build. It only prints, and decides nothing.
set -eu
bench=$1/../tests/bench_steps
if [ ! -x "$bench" ]; then
    echo "steps: no $bench, build the target bench_steps" >&2
    exit 0
fi
OMP_NUM_THREADS=1 OMP_THREAD_LIMIT=1
export OMP_NUM_THREADS OMP_THREAD_LIMIT
exec "$bench" 10 20 50 100 190
