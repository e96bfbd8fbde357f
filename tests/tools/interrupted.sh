#!/bin/sh
# interrupted.sh FOLDER-OF-THE-TOOLS - the files that ritz-fit and ritz-compare
# leave after a signal.
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

# interrupt SIGNAL WORD COMMAND...: run the command and send it the signal when
# a line of its record has the word. The record is a pipe, and the tool waits
# until each line is read: so it is still searching when the signal comes. Its
# status is in $got, its output in the file said. If it ends before such a line,
# no signal is sent.
#
# The tool opens the record for each line. Where the reader closes it between
# that and the line, SIGPIPE ends the tool, and it is run again.
interrupt() {
    got=141
    while [ "$got" = 141 ]; do
        interrupt_once "$@"
    done
}
interrupt_once() {
    signal=$1 word=$2
    shift 2
    rm -f record ended tool
    mkfifo record
    {
        # a shell starts background commands with SIGINT ignored
        env --default-signal="$signal" "$@" --record record >said 2>&1 &
        echo $! >tool
        status=0
        wait $! || status=$?
        echo "$status" >ended
        : >record # the end of the pipe, for a reader that waits for a line
    } &
    line=
    until [ -e ended ] || case $line in *"$word"*) true ;; *) false ;; esac do
        read -r line <record || line=
    done
    until [ -s tool ]; do sleep 0.01; done
    [ -e ended ] || kill -s "$signal" "$(cat tool)" || true # it may have ended
    exec 3<>record # a reader for the lines to come
    wait $!
    exec 3>&-
    got=$(cat ended)
}

# says NAME WORDS: the interrupted tool printed these words and failed.
says() {
    cp said log
    [ "$got" = 1 ] && grep -qF -e "$2" said && report yes "$1" || report no "$1"
}

truss=$data/truss72
expect 0 '' ritz-import --stiffness "$truss/truss72.k.mtx" \
    --mass "$truss/truss72.m.mtx" --bulk "$truss/truss72.bdf" \
    --dofs "$truss/truss72.dofs" --port left=1:12 --input f=36:2 \
    --output-at y=35:2 -q -o truss.h5

# --- a component --------------------------------------------------------------

set -- ritz-fit truss.h5 --band-hz 0,20 --damping 'modal 0.01' \
    --methods craig-bampton,normal-modes,krylov --tolerance flexible=1e-2
echo before >fit.h5
for signal in INT TERM; do
    rm -f fit.h5.interrupted
    interrupt "$signal" '"feasible":true' "$@" -o fit.h5
    says "SIG$signal ends the search with the best so far" \
        "is in 'fit.h5.interrupted'"
    works '  after how many candidates is said' grep -q 'Why: interrupted after [0-9]* cand' said
    works '  methods that were not tried are not judged' \
        test "$(grep -c 'no other method meets it' said)" = 0
    works '  the output is as it was' grep -qx before fit.h5
    expect 0 'the search, after' ritz-info fit.h5.interrupted
    expect 0 'pass' ritz-verify truss.h5 fit.h5.interrupted --band-hz 0,20 \
        --damping 'modal 0.01' --limit-flexible 1e-2 -o verified.h5
done

# The tool may be one candidate ahead of the line that was read: so a tolerance
# that the first few do not meet.
rm -f fit.h5.interrupted
interrupt TERM '"feasible":false' ritz-fit truss.h5 --band-hz 0,20 \
    --damping 'modal 0.01' --methods normal-modes,krylov \
    --tolerance flexible=1e-13 -o fit.h5
says 'before anything meets the tolerance there is nothing to keep' \
    'no candidate so far meets the tolerance'
works '  and nothing is left' test ! -e fit.h5.interrupted
works '  the output is as it was' grep -qx before fit.h5

# --- a scene ------------------------------------------------------------------

import_spacecraft
spacecraft scene 'band_hz: [0, 5]' \
    'inputs: [{name: motor, at: rotor/bearing, component: 6, against: stator/bearing}]' \
    'outputs: [{name: gyro, at: platform/scan, component: 6}]'
interrupt TERM '"feasible":true' ritz-fit scene.yaml --tolerance flexible=1e-1 \
    --methods craig-bampton --components s- --report s.txt -o s.h5
says 'a scene gives the system of the best so far' "is in 's.h5.interrupted'"
expect 0 'flexible-response-relative' ritz-info s.h5.interrupted
works '  and no components, and no report' \
    test ! -e s.h5 -a ! -e s-rotor.h5 -a ! -e s.txt

# --- COMPARE at many configurations -------------------------------------------

# The signal comes when the first of many configurations have been shown.
angles=$(seq -s ', ' 0 0.05 90)
sed "s/angles_deg: \[0, 90\]/angles_deg: [$angles]/" scene.yaml >many.yaml
echo before >many.h5
got=0
at_step TERM configuration: ritz-compare many.yaml --components m- \
    --report m.txt -o many.h5 >said 2>&1 || got=$?
says 'SIGTERM ends the comparison with what is done' \
    "of 1801 configurations are in 'many.h5.interrupted'"
expect 0 'of 1801 configurations, with modes' ritz-info many.h5.interrupted
works '  the output is as it was' grep -qx before many.h5
works '  and there are no components, and no report' \
    test ! -e m-rotor.h5 -a ! -e m.txt
expect 0 '' ritz-frf --at clock=0 --to-hz 5 -q many.h5.interrupted -o H.h5

echo "1..$count"
