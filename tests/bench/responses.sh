#!/bin/sh
# responses.sh FOLDER-OF-THE-TOOLS [BRICKS [CHECKS]] - engines of responses on a
# solid block of BRICKS^3 bricks, 13 unless another number is given (8 thousand
# dofs; 25 are 53 thousand, and take an hour): processor seconds for 1000 points
# on one thread, errors beside full factors at CHECKS random frequencies, 40 and
# 4 of more than 13 bricks, ratio to a factor at each point. Needs
# bench_responses, which is built by name beside the tools. A table, no verdict.
set -eu
bin=$(cd "$1" && pwd)
here=$(cd "$(dirname "$0")" && pwd)
n=${2:-13}
checks=${3:-$((n > 13 ? 4 : 40))}
bench=$bin/../tests/bench_responses
if [ ! -x "$bench" ]; then
    echo "responses: no $bench, build the target bench_responses" >&2
    exit 0
fi
OMP_NUM_THREADS=1 OMP_THREAD_LIMIT=1
export OMP_NUM_THREADS OMP_THREAD_LIMIT
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
/usr/bin/python3 -s "$here/brick.py" "$n" "$n" "$n" . >dofs
corner=$(((n + 1) * (n + 1) * (n + 1)))
middle=$((corner / 2))
"$bin/ritz-import" -q --stiffness K.mtx --mass M.mtx --dofs dofs.txt \
    --bulk grids.bdf --input push=1:1 --input pull=$middle:2 \
    --output-at tip=$corner:1 --output-at side=$middle:2 -o solid.h5
# frequencies of a block go with its size: some ten modes
to=$((20000 / n))
"$bench" solid.h5 'modal 0.01' 50 "$to" "$checks" modal krylov rational
"$bench" solid.h5 'rayleigh 10 1e-7' 50 "$to" "$checks" krylov rational
