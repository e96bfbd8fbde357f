#!/bin/sh
# slepc.sh FOLDER-OF-THE-TOOLS - ritz-basis and ritz-reduce --engine slepc on 1,
# 2 and 4 ranks: bases and reduced components agree with those of the usual
# engine. slepc_refused.sh has the failures.
. "$(dirname "$0")/tap.sh"
. "$(dirname "$0")/models.sh"
. "$(dirname "$0")/ranks.sh"

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

import_membrane
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

# Reduction in ranks: of the membrane with a damping matrix that is not symmetric,
# with structural damping and geometric stiffness, of a rotor with grids, and therefore inertia
# invariants, and a damper, and of one grid whose dofs are in several ranks.
alone='-q --estimates none'
together="$alone --engine slepc"
import_damped
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
    [ $model != damped ] ||
        expect 0 'KG/spin' ritz-info $n.h5
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

# interrupted (SIGINT) at any point: the output is complete, or there is none
for seconds in 0.4 0.6; do
    timeout -s INT $seconds mpirun -n 2 ritz-basis -q craig-bampton --modes 12 \
        --engine slepc m.h5 -o int.h5 >log 2>&1 || true
    works "an end after $seconds s leaves no part of a file" sh -c '
        left=$(ls -A | grep int.h5 || true)
        test -z "$left" || { test "$left" = int.h5 && ritz-info int.h5; }'
done

echo "1..$count"
