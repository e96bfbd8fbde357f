#!/bin/sh
# engines.sh FOLDER-OF-THE-TOOLS - with two threads every engine that finds modes
# writes the same bytes in every run; and RITZ_TEST_ENGINE sets the engine.
. "$(dirname "$0")/tap.sh"

# A cube of bricks, 8232 dofs: enough for two threads of each engine. Where sums of
# substructures depended on the thread, half of the runs on this cube differed, so
# that these run four times; on a long block all runs were alike.
works 'a block is made' /usr/bin/python3 -s "$here/../bench/brick.py" 13 13 13 .
expect 0 '' ritz-import -q --stiffness K.mtx --mass M.mtx --dofs dofs.txt \
    --port root=1,14,30,200:123 -o block.h5
# other tests are told to use one
unset OMP_THREAD_LIMIT
export OMP_NUM_THREADS=2
for options in 'lanczos --modes 30' 'arpack --modes 8' 'slices --modes 300' \
    'amls --modes 60' 'lanczos --modes 30 --accuracy 1e-4'; do
    runs='1 2'
    [ "${options%% *}" != amls ] || runs='1 2 3 4'
    for run in $runs; do
        # shellcheck disable=SC2086 # words
        works "$options" ritz-basis -q craig-bampton --engine $options \
            block.h5 -o basis.h5
        mv basis.h5 $run.h5
        same "  run $run has the bytes of the first" 1.h5 $run.h5
    done
done

# --- RITZ_TEST_ENGINE -------------------------------------------------------------

works 'a membrane is made' /usr/bin/python3 -s "$here/slepc.py" membrane 22
expect 0 '' ritz-import -q --stiffness m.K.mtx --mass m.M.mtx --dofs m.dofs \
    --port corner=1:3 -o m.h5
membrane='normal-modes --modes 24 m.h5'
# shellcheck disable=SC2086 # words
{
    expect 0 'dense LAPACK' ritz-basis $membrane -o m.b.h5
    for pair in lanczos:block arpack:ARPACK slices:spectrum amls:substructures; do
        expect 0 "${pair#*:}" env RITZ_TEST_ENGINE=${pair%:*} \
            ritz-basis $membrane -o m.b.h5
    done
    expect 0 'ARPACK' env RITZ_TEST_ENGINE=slices \
        ritz-basis --engine arpack $membrane -o m.b.h5
}
echo "1..$count"
