#!/bin/sh
# array.sh [VARIABLE=VALUE...] - make one target of the Makefile in this folder:
# the one in line N of `make targets`, N the index of the task. SLURM sets the
# index and reads the lines below; with another batch system set TASK to it.
#
#SBATCH --array=1-100
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=4
#SBATCH --mem=16G
#SBATCH --output=array-%a.log
set -eu
cd "${SLURM_SUBMIT_DIR:-.}"
task=${SLURM_ARRAY_TASK_ID:-${TASK:?number of a target}}
# in two steps: of a pipe, sh would notice a failure of the last command only
targets=$(make -s targets "$@")
target=$(printf '%s\n' "$targets" | sed -n "${task}p")
[ -n "$target" ] || exit 0 # the array is longer than the list
OMP_NUM_THREADS=${SLURM_CPUS_PER_TASK:-1}
export OMP_NUM_THREADS
exec make "$target" "$@"
