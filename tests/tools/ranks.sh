# Shared by the scripts that test --engine slepc; sourced after tap.sh and
# models.sh.
# shellcheck shell=sh disable=SC2034 # for those who source it

# Open MPI refuses root and more ranks than cores, unless it is told
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_mpi_yield_when_idle=1
program=$bin/../libexec/ritz/ritz-basis-slepc
check() { /usr/bin/python3 -s "$here/slepc.py" "$@"; }
ranks() { number=$1 && shift && mpirun -n "$number" ritz-basis "$@"; }
reduce() { number=$1 && shift && mpirun -n "$number" ritz-reduce "$@"; }

# import_membrane: m.h5, a square membrane with its rim as port. Its interior
# has 400 dofs, more than rank 0 would solve alone, and most eigenvalues are
# double, by symmetry.
import_membrane() {
    side=22
    rim=1-$side,$((side * (side - 1) + 1))-$((side * side))
    k=$((side + 1))
    while [ $k -lt $((side * (side - 1))) ]; do
        rim=$rim,$k,$((k + side - 1))
        k=$((k + side))
    done
    works 'a membrane is made' check membrane $side
    expect 0 '' ritz-import -q --stiffness m.K.mtx --mass m.M.mtx \
        --dofs m.dofs --port "rim=$rim:3" --port corner=1:3 \
        --port "last=$((side * side)):3" -o m.h5
}

# import_damped: damped.h5, the membrane with a damping matrix that is not
# symmetric, structural damping, geometric stiffness of two loads, dampers, an
# input and an output.
import_damped() {
    works 'damping matrices are made' check damping m.dofs $side
    expect 0 '' ritz-import -q --stiffness m.K.mtx --mass m.M.mtx \
        --dofs m.dofs --damping m.D.mtx --structural-damping m.K4.mtx \
        --geometric-stiffness m.M.mtx@spin --geometric-stiffness m.K.mtx@all \
        --port corner=1:3 --port "rim=$rim:3" --input push=30:3 \
        --output see=40:3 --damper 'soft=100:3,142:3*2' \
        --damper 'same=100:3,142:3*1' -o damped.h5
}
