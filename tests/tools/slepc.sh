#!/bin/sh
# slepc.sh FOLDER-OF-THE-TOOLS - ritz-basis and ritz-reduce --engine slepc on 1,
# 2 and 4 ranks: bases and reduced components agree with those of the usual
# engine, and a failure is reported once and ends all ranks.
. "$(dirname "$0")/tap.sh"
. "$(dirname "$0")/models.sh"

# Open MPI refuses root and more ranks than cores, unless it is told
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_mpi_yield_when_idle=1
program=$bin/../libexec/ritz/ritz-basis-slepc
check() { /usr/bin/python3 -s "$here/slepc.py" "$@"; }
ranks() { number=$1 && shift && mpirun -n "$number" ritz-basis "$@"; }
reduce() { number=$1 && shift && mpirun -n "$number" ritz-reduce "$@"; }

# Threads of a rank are its share of the cores, also where SLURM states the
# number of ranks for several machines, and Open MPI looks for networks only if
# ranks are on other machines, or if the user says so. A script that prints the
# number of threads and Open MPI's choice takes the place of the program.
mkdir -p tool/bin tool/libexec/ritz
cp "$bin/ritz-basis" tool/bin
printf '#!/bin/sh\necho "threads=$OMP_NUM_THREADS. pml=$OMPI_MCA_pml."\n' \
    >tool/libexec/ritz/ritz-basis-slepc
chmod +x tool/libexec/ritz/ritz-basis-slepc
for tasks in 9999 '9999(x2)' '9999(x2),3' 9999,3; do
    expect 0 'threads=1.' env -u OMP_NUM_THREADS -u OMPI_COMM_WORLD_LOCAL_SIZE \
        SLURM_TASKS_PER_NODE="$tasks" tool/bin/ritz-basis --engine slepc
done
expect 0 threads= tool/bin/ritz-basis craig-bampton --engine=slepc m.h5
for case in '2 2 ob1' '4 2 ' '2 2 ucx OMPI_MCA_pml=ucx'; do
    # shellcheck disable=SC2086 # words
    set -- $case
    expect 0 "pml=${3:-}." env -u OMPI_MCA_pml OMPI_COMM_WORLD_SIZE=$1 \
        OMPI_COMM_WORLD_LOCAL_SIZE=$2 ${4:-} tool/bin/ritz-basis --engine slepc
done

# Built without PETSc, ritz-basis names the packages that it needs.
if [ ! -x "$program" ]; then
    expect 1 'Debian'"'"'s packages slepc-dev, petsc-dev and mpi-default-dev' \
        ritz-basis craig-bampton --modes 3 --engine slepc none.h5 -o out.h5
    expect 1 'Debian'"'"'s packages slepc-dev, petsc-dev and mpi-default-dev' \
        ritz-reduce --engine slepc none.h5 none.h5 -o out.h5
    works 'and writes nothing' test ! -e out.h5
    echo "1..$count"
    exit 0
fi

# the program has the parallel MUMPS, and no symbol of the sequential one
works 'it is not linked with the sequential MUMPS' sh -c '
    ldd "$1" >libraries && ! grep -E "mumps_seq|mpiseq|hdf5_serial" libraries &&
    grep -q "libdmumps-" libraries && nm "$1" >symbols &&
    ! grep -iE " [TtDdBb] (dmumps_|zmumps_|mpi_init|mpi_comm_rank)" symbols' - \
    "$program"

# A square membrane with its rim as port. The interior has 400 dofs, more than
# rank 0 would solve alone, and most eigenvalues are double, by symmetry.
side=22
rim=1-$side,$((side * (side - 1) + 1))-$((side * side))
k=$((side + 1))
while [ $k -lt $((side * (side - 1))) ]; do
    rim=$rim,$k,$((k + side - 1))
    k=$((k + side))
done
works 'a membrane is made' check membrane $side
expect 0 '' ritz-import -q --stiffness m.K.mtx --mass m.M.mtx --dofs m.dofs \
    --port "rim=$rim:3" --port corner=1:3 --port "last=$((side * side)):3" -o m.h5
fixed='-q craig-bampton --attach rim m.h5'
# shellcheck disable=SC2086 # words
{
    expect 0 '' ritz-basis $fixed --modes 12 -o 0.h5
    for n in 1 4; do
        expect 0 '' ranks $n $fixed --modes 12 --engine slepc -o $n.h5
    done
    works 'bases agree on 1 and 4 ranks' check same 0.h5 1.h5 4.h5
    expect 0 '' ranks 2 $fixed --modes 12 --engine slepc --memory 1G \
        --record steps -o 2.h5
    for step in 'order of rows' factor eigenvectors 'count of modes'; do
        works "its steps are told: $step" grep -q "\"$step\"" steps
    done
    # of one rank; with more, MUMPS distributes work while it runs, and last
    # digits differ
    expect 0 '' ritz-basis $fixed --modes 12 --engine slepc -o again.h5
    works 'the same bits again' sh -c 'ritz-info 1.h5 | grep sha256 >a &&
        ritz-info again.h5 | grep sha256 >b && diff a b'
    expect 0 '' ritz-basis $fixed --up-to-hz 0.09 -o 0.h5
    expect 0 '' ranks 2 $fixed --up-to-hz 0.09 --engine slepc -o 2.h5
    works 'up to a frequency' check same 0.h5 2.h5
}
expect 0 '' ritz-reduce -q m.h5 4.h5 -o reduced.h5

# Reduction in ranks: of the membrane with a damping matrix that is not symmetric
# and with structural damping, of a rotor with grids, and therefore inertia
# invariants, and a damper, and of one grid whose dofs are in several ranks.
works 'damping matrices are made' check damping m.dofs 22
alone='-q --estimates none'
together="$alone --engine slepc"
expect 0 '' ritz-import -q --stiffness m.K.mtx --mass m.M.mtx --dofs m.dofs \
    --damping m.D.mtx --structural-damping m.K4.mtx --port corner=1:3 \
    --port "rim=$rim:3" --input push=30:3 --output see=40:3 \
    --damper 'soft=100:3,142:3*2' --damper 'same=100:3,142:3*1' -o damped.h5
import_spacecraft --damper 'ground=1:1*10'
# shellcheck disable=SC2086 # words
for case in damped:1 damped:4 rotor:2 platform:4; do
    model=${case%:*} n=${case#*:}
    method='craig-bampton --modes 6'
    [ $model != platform ] || method=rigid
    expect 0 '' ritz-basis -q $method $model.h5 -o $model.b.h5
    expect 0 '' ritz-reduce $alone $model.h5 $model.b.h5 -o 0.h5
    expect 0 '' reduce $n $together $model.h5 $model.b.h5 -o $n.h5
    works "$model is reduced alike in $n" check alike 0.h5 $n.h5
done

# static vectors: of the dampers, one of which depends on the other; of other
# loads; where rank 0 finds all modes alone; and without modes
# shellcheck disable=SC2086 # words
for choice in '--modes 6' '--modes 6 --loads inputs,outputs' '--modes 390' \
    '--modes 0'; do
    fixed="craig-bampton --attach rim $choice damped.h5"
    left=
    [ "$choice" != '--modes 6' ] ||
        left='1 static mode(s) left out, the first of damper'
    expect 0 "$left" ritz-basis $fixed -o 0.h5
    expect 0 "$left" ranks 2 $fixed --engine slepc -o 2.h5
    works "static vectors, $choice" check same 0.h5 2.h5
done

# free, with a rigid mode; no mpirun is one rank
expect 0 '' ritz-basis -q normal-modes --modes 8 m.h5 -o 0.h5
expect 0 '' ritz-basis -q normal-modes --modes 8 --engine slepc m.h5 -o 1.h5
expect 0 '' ranks 2 -q normal-modes --modes 8 --engine slepc m.h5 -o 2.h5
works 'free bodies agree' check same 0.h5 1.h5 2.h5

# few masses: Krylov spaces end early
works 'a membrane of few masses is made' check membrane $side 7
expect 0 '' ritz-import -q --stiffness m.K.mtx --mass m.M.mtx --dofs m.dofs \
    --port "corner=1:3" -o few.h5
expect 0 '' ritz-basis -q craig-bampton --modes 20 few.h5 -o 0.h5
expect 0 '' ranks 2 -q craig-bampton --modes 20 --engine slepc few.h5 -o 2.h5
works 'a mass of low rank' check same 0.h5 2.h5

# a beam so long that low modes lose six digits in K x
works 'a beam is made' check beam 400
expect 0 '' ritz-import -q --stiffness m.K.mtx --mass m.M.mtx --dofs m.dofs \
    --port "end=1-2:3" -o beam.h5
for n in 1 2 4; do
    expect 0 '' ranks $n -q craig-bampton --modes 12 --engine slepc beam.h5 \
        -o long-$n.h5
done
works 'residuals of a long beam' check residual long-1.h5 long-2.h5 long-4.h5

# fewer rows than ranks, and none
works 'nine dofs are made' check membrane 3
expect 0 '' ritz-import -q --stiffness m.K.mtx --mass m.M.mtx --dofs m.dofs \
    --port most=1-8:3 --port all=1-9:3 -o nine.h5
for port in most all; do
    expect 0 '' ritz-basis -q craig-bampton --modes 2 --attach $port nine.h5 \
        -o 0.h5
    expect 0 '' ranks 4 -q craig-bampton --modes 2 --attach $port \
        --engine slepc nine.h5 -o 4.h5
    works "$port of nine dofs held" check same 0.h5 4.h5
done

# fails STATUS WORDS COMMAND...: the failure is reported in one line by one rank,
# with the status of a single process, and no file is left.
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
fails 1 'bad.h5: K: entry' reduce 2 --engine slepc --estimates none bad.h5 1.h5
cp m.h5 bad.h5
check damage bad.h5 0 7
fails 1 "K: 'data' is damaged: its checksum does not fit" ranks 2 \
    craig-bampton --modes 3 --engine slepc bad.h5
cp m.h5 bad.h5
check damage bad.h5 1166 -7 unsealed
fails 1 'K is not symmetric to the last bit' reduce 2 --engine slepc \
    --estimates none bad.h5 1.h5
fails 1 'K is unsymmetric by' ranks 2 craig-bampton --modes 3 --attach corner \
    --engine slepc bad.h5
cp m.h5 bad.h5
check damage bad.h5 -2 -7 unsealed
fails 1 'K is unsymmetric: its column of an attached dof' ranks 2 \
    craig-bampton --modes 3 --attach last --engine slepc bad.h5

# interrupted (SIGINT) at any point: the output is complete, or there is none
for seconds in 0.4 0.6; do
    timeout -s INT $seconds mpirun -n 2 ritz-basis -q craig-bampton --modes 12 \
        --engine slepc m.h5 -o int.h5 >log 2>&1 || true
    works "an end after $seconds s leaves no part of a file" sh -c '
        left=$(ls -A | grep int.h5 || true)
        test -z "$left" || { test "$left" = int.h5 && ritz-info int.h5; }'
done

echo "1..$count"
