#!/bin/sh
# batch.sh FOLDER-OF-THE-TOOLS - examples/batch makes several components and
# configurations by make -j, and the same files by the tasks of a batch array.
. "$(dirname "$0")/tap.sh"
. "$(dirname "$0")/models.sh"

import_spacecraft
spacecraft scene 'inputs:' \
    '  - {name: torque, at: rotor/bearing, component: 6}' 'outputs:' \
    '  - {name: turn, at: platform/scan, component: 6}'
expect 0 '' ritz-assemble -q scene.yaml -o system.h5

# folder NAME: a folder with the inputs of examples/batch, and nothing made yet.
folder() {
    mkdir -p "$1/components"
    cp "$here/../../examples/batch/Makefile" system.h5 "$1"
    cp rotor.h5 stator.h5 "$1/components"
    printf 'clock=0,cone=0\nclock=90,cone=0\n' >"$1/configurations.txt"
}
folder one
works 'two components and two configurations by make -j' make -s -j 2 -C one \
    MODES=4 FREQUENCIES='--from-hz 1 --to-hz 20 --points 20'
works 'are made once' sh -c 'make -C one MODES=4 | grep -q "Nothing to be done"'

# the tasks of an array, the last first; there are four targets, so that task 5
# has nothing to do
folder two
export SLURM_ARRAY_TASK_ID SLURM_SUBMIT_DIR="$dir/two"
for SLURM_ARRAY_TASK_ID in 5 4 3 2 1; do
    works "task $SLURM_ARRAY_TASK_ID of the array" \
        sh "$here/../../examples/batch/array.sh" MODES=4 \
        FREQUENCIES='--from-hz 1 --to-hz 20 --points 20'
done
for file in bases/rotor.h5 reduced/rotor.h5 reduced/stator.h5 responses/1.h5 \
    responses/2.h5; do
    same "$file is the same by both" "one/$file" "two/$file"
done

# a task that cannot list its targets fails
sed 's/^targets:/&\n\t@false/' one/Makefile >two/Makefile
SLURM_ARRAY_TASK_ID=1
expect 2 '' sh "$here/../../examples/batch/array.sh" MODES=4

# a component that cannot be read: make fails with its name and leaves no file
echo junk >one/components/broken.h5
expect 2 'broken.h5' make -s -k -j 2 -C one MODES=4
works 'and is not there' test ! -e one/reduced/broken.h5

echo "1..$count"
