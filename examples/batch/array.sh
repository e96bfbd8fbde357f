#!/bin/sh
# array.sh - one target of the Makefile beside it, by its number among those of
# `make targets`. The lines below are for SLURM, whose array has an index for
# each target; of another batch system set TASK.
#
#SBATCH --array=1-100
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=4
#SBATCH --mem=16G
#SBATCH --output=array-%a.log
set -eu
cd "${SLURM_SUBMIT_DIR:-.}"
task=${SLURM_ARRAY_TASK_ID:-${TASK:?number of a target}}
target=$(make -s targets "$@" | sed -n "${task}p")
[ -n "$target" ] || exit 0 # the array is longer than the list
OMP_NUM_THREADS=${SLURM_CPUS_PER_TASK:-1}
export OMP_NUM_THREADS
exec make "$target" "$@"
