#!/bin/sh
# slepc_refused.sh FOLDER-OF-THE-TOOLS - ritz-basis and ritz-reduce --engine
# slepc on several ranks where they must fail: one rank reports the failure with
# the status and the sentence of a single process, all ranks end, and no file
# is left.
. "$(dirname "$0")/tap.sh"
. "$(dirname "$0")/models.sh"
. "$(dirname "$0")/ranks.sh"

# slepc.sh tests the refusal of tools that were built without it
if [ ! -x "$program" ]; then
    echo 'skipped: built without PETSc'
    exit 77
fi

import_membrane
import_damped
import_spacecraft --damper 'ground=1:1*10'
for model in m damped; do
    expect 0 '' ritz-basis -q craig-bampton --modes 6 $model.h5 -o $model.b.h5
done

# Open MPI sends SIGTERM to the ranks that are left, and after this number of
# seconds SIGKILL; by default it waits a second each time.
export OMPI_MCA_odls_base_sigkill_timeout=0

# fails STATUS WORDS COMMAND...: one rank reports the failure in one line, with
# the status of a single process, and no file is left.
fails() {
    rm -f out.h5
    expect "$@" -o out.h5
    cp log said
    works '  once, and nothing is written' sh -c 'cat said
        test "$(grep -c "^ritz-[a-z]*:" said)" = 1 &&
        test -z "$(ls -A | grep out.h5)"'
}
fails 1 'a rigid-body motion or mechanism left free? with the attached dofs held, 1 motion(s) cost no energy' \
    ranks 2 craig-bampton --modes 3 --attach '' --engine slepc m.h5
fails 2 'finds bases of craig-bampton and normal-modes, not of macneal' \
    ranks 2 macneal --modes 3 --engine slepc m.h5
fails 2 'engine slepc takes no --interface-modes' ritz-basis craig-bampton \
    --modes 3 --interface-modes 2 --engine slepc m.h5
fails 2 "no method 'craig'" ranks 2 craig --modes 3 --engine slepc m.h5
fails 1 'makes no static vectors of inputs, outputs or dampers for a free' \
    ritz-basis normal-modes --modes 3 --engine slepc damped.h5
fails 1 'static vectors: there is no load to respond to, no input' \
    ritz-basis craig-bampton --modes 3 --loads inputs --engine slepc m.h5
fails 2 'engine slepc makes no estimates: say --estimates none' reduce 2 \
    --engine slepc damped.h5 damped.b.h5
fails 2 'engine slepc makes no estimates: say --estimates none' ritz-reduce \
    --engine=slepc --estimates frequency damped.h5 damped.b.h5
fails 2 'engine slepc takes no --damping' ritz-reduce --engine slepc \
    --estimates none --damping 'modal 0.01' damped.h5 damped.b.h5
fails 1 'is a basis for 484 dofs' reduce 2 --engine slepc --estimates none \
    rotor.h5 damped.b.h5
works 'a larger membrane is made' check membrane 120
expect 0 '' ritz-import -q --stiffness m.K.mtx --mass m.M.mtx --dofs m.dofs \
    --port corner=1:3 -o large.h5
fails 1 'are allowed (--memory)' ranks 2 craig-bampton --modes 3 --memory 10M \
    --engine slepc large.h5

# Matrices that no engine accepts are refused with the sentence of one process:
# a stiffness and a mass that are negative at a dof, and a dof without stiffness.
negate='NR > 2 && $1 == 200 && $2 == 200 { $3 = -$3 } { print }'
remove='NR > 2 && ($1 == 200 || $2 == 200) { $3 = 0 } { print }'
works 'the membrane is made again' check membrane $side
awk "$negate" m.K.mtx >indefinite.mtx
awk "$negate" m.M.mtx >negative.mtx
awk "$remove" m.K.mtx >loose.mtx
for case in 'indefinite.mtx m.M.mtx' 'm.K.mtx negative.mtx' 'loose.mtx m.M.mtx'; do
    # shellcheck disable=SC2086 # words
    set -- $case
    expect 0 '' ritz-import -q --stiffness "$1" --mass "$2" --dofs m.dofs \
        --port corner=1:3 -o sick.h5
    ritz-basis -q craig-bampton --modes 3 sick.h5 -o out.h5 2>sentence || true
    for n in 1 2; do
        fails 1 "$(cat sentence)" ranks $n -q craig-bampton --modes 3 \
            --engine slepc sick.h5
    done
done

# Where one process says so of small models alone: the lowest mode of a negative
# stiffness far beyond the first shift, and a small negative mass.
for case in 'soft normal-modes K is not positive semidefinite: an eigenvalue is -1.83' \
    'light craig-bampton mass is not positive definite: entry (248, 248) is -0.01'; do
    # shellcheck disable=SC2086 # words
    set -- $case
    model=$1 method=$2
    shift 2
    works "a $model membrane is made" check flaw $model $side
    expect 0 '' ritz-import -q --stiffness m.K.mtx --mass m.M.mtx \
        --dofs m.dofs --port "corner=1:3" -o flaw.h5
    for n in 1 2; do
        fails 1 "$*" ranks $n $method --modes 3 --engine slepc flaw.h5
    done
done

# only the last rank reads this entry
cp m.h5 bad.h5
check damage bad.h5 -1 nan unsealed
fails 1 'bad.h5: K: entry' ranks 4 craig-bampton --modes 3 --engine slepc bad.h5
fails 1 'bad.h5: K: entry' reduce 2 --engine slepc --estimates none bad.h5 m.b.h5
cp m.h5 bad.h5
check damage bad.h5 0 7
fails 1 "K: 'data' is damaged: its checksum does not fit" ranks 2 \
    craig-bampton --modes 3 --engine slepc bad.h5
cp m.h5 bad.h5
check damage bad.h5 1166 -7 unsealed
fails 1 'K is not symmetric to the last bit' reduce 2 --engine slepc \
    --estimates none bad.h5 m.b.h5
fails 1 'K is unsymmetric by' ranks 2 craig-bampton --modes 3 --attach corner \
    --engine slepc bad.h5
cp m.h5 bad.h5
check damage bad.h5 -2 -7 unsealed
fails 1 'K is unsymmetric: its column of an attached dof' ranks 2 \
    craig-bampton --modes 3 --attach last --engine slepc bad.h5

echo "1..$count"
