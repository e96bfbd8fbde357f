#!/bin/sh
# Runs that end early and are continued. Usage: long.sh FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"
# shellcheck disable=SC2086 # $run is words

import_body stator -q --port bearing=1 --port scan=5 --input torque=1:6 \
    --output-at gyro=5:6 -o stator.h5
ritz-basis -q macneal-rubin --modes 4 stator.h5 -o basis.h5
ritz-reduce -q stator.h5 basis.h5 -o reduced.h5

# long NAME OPTIONS: set $run to the command of a run into NAME.h5, which takes
# about a second
long() {
    run="ritz-simulate reduced.h5 --seconds 2500 --step 0.002 --every 50000 \
        --input torque=sine:0.7 --coordinates $2 -o $1.h5"
}

# same TITLE FILE: FILE holds the values of whole.h5. Tables with 16 digits are
# compared, since the command, an attribute of the files, differs.
same() {
    ritz-export -q --to tsv whole.h5 -o whole.tsv
    ritz-export -q --to tsv "$2" -o "$2.tsv"
    works "$1" cmp whole.tsv "$2.tsv"
}

long whole ''
expect 0 'time response' $run

# --- a signal -----------------------------------------------------------------

for signal in INT TERM; do
    echo before >kept.h5
    rm -f kept.h5.interrupted
    long kept ''
    expect 1 "s, is in 'kept.h5.interrupted'" at_step "$signal" simulation $run
    works '  the output is as it was' grep -qx before kept.h5
    expect 0 'interrupted    the run, after' ritz-info kept.h5.interrupted
    expect 0 'times, 1 outputs' ritz-export --to tsv kept.h5.interrupted \
        -o kept.tsv
    works '  its times are those of the whole run' test "$(sed 1d kept.tsv |
        wc -l)" -lt "$(ritz-export -q --to tsv whole.h5 -o whole.tsv &&
        sed 1d whole.tsv | wc -l)"
done

# --- a checkpoint -------------------------------------------------------------

rm -f run.h5
long run '--checkpoint run.ck'
expect 1 "the same command continues it from 'run.ck'" at_step INT simulation $run
expect 1 "is in 'run.h5.interrupted'" at_step INT simulation $run
works '  after two signals both files are there' \
    test -s run.ck -a -s run.h5.interrupted -a ! -e run.h5
expect 0 'time response' $run
same '  the third run gives the values of an uninterrupted one' run.h5
works '  and its checkpoint is gone' test ! -e run.ck
works '  and what the interrupted runs had left' test ! -e run.h5.interrupted
mv kept.h5.interrupted whole.h5.interrupted
long whole ''
expect 0 'time response' $run
works '  but not what another command had left' test -s whole.h5.interrupted
long run '--checkpoint run.ck'

# --- a checkpoint that cannot be written ---------------------------------------

mkdir gone
long run '--checkpoint gone/run.ck'
expect 1 "is in 'run.h5.interrupted'; its checkpoint was not written: gone" \
    at_step away:gone,INT simulation $run
cp log said
mkdir gone out
works '  what to copy is said' \
    grep -q "if you copy 'run.h5.interrupted' to 'gone/run.ck'" said
cp run.h5.interrupted gone/run.ck
expect 0 'time response' $run
same '  what is kept continues as a checkpoint' run.h5
works '  and is gone in the end' test ! -e run.h5.interrupted -a ! -e gone/run.ck

set -- $run -o out/run.h5
expect 1 "nor can the checkpoint be written to 'gone/run.ck'" \
    at_step away:out,away:gone,INT simulation "$@"
mkdir gone out
expect 1 "; the same command continues the run from 'gone/run.ck'" \
    at_step away:out,INT simulation "$@"
mkdir out
expect 0 'time response' "$@"
same '  and it does' out/run.h5

# Checkpoints are written every half minute: of a clock that a library makes
# faster. Sanitizers must be loaded before it, and their builds have none.
clock=$bin/../tests/libritz_clock.so
if [ -f "$clock" ]; then
    rm run.h5
    expect 0 'warning: a checkpoint was not written; the run goes on' \
        at_step away:gone simulation env "LD_PRELOAD=$clock" $run
    cp log said
    works '  once' test "$(grep -c 'a checkpoint was not written' said)" = 1
    same '  to its end' run.h5

    # that the next ones are written is seen where the output cannot be
    mkdir gone
    expect 1 "the same command continues the run from 'gone/run.ck'" at_step \
        away:gone,away:out simulation + back:gone 'was not written' \
        env "LD_PRELOAD=$clock" "$@"
    mkdir out
    expect 0 'time response' "$@"
    same '  and it does' out/run.h5
fi
long run '--checkpoint run.ck'

# --- files that are not a checkpoint of the run -------------------------------

expect 1 "the same command continues it" at_step INT simulation $run
long run "--checkpoint run.ck --every 2"
expect 1 "'run.ck' is a checkpoint of 'ritz-simulate reduced.h5" $run
ritz-reduce -q stator.h5 basis.h5 --band-hz 0,5 -o reduced.h5
long run '--checkpoint run.ck'
expect 1 'is a checkpoint of files that have changed since' $run
long run '--checkpoint whole.h5'
expect 1 "'whole.h5' is no checkpoint" $run
long run '--checkpoint reduced.h5'
expect 1 "'reduced.h5' is the model" $run
long run '--checkpoint run.h5'
expect 1 "'run.h5' is the output too" $run
echo nothing >empty.ck
long run '--checkpoint empty.ck'
expect 1 'empty.ck' $run
works '  and stays' grep -qx nothing empty.ck
expect 2 '--checkpoint needs --step' ritz-simulate reduced.h5 --seconds 1 \
    --input torque=step --checkpoint run.ck -o run.h5

echo "1..$count"
