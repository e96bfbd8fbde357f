#!/bin/sh
# Krylov vectors end to end, on the truss of data/truss72.
# Usage: krylov.sh FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"
data=$data/truss72

# --- the data are what their script makes ------------------------------------

expect 0 '' sh "$data/make-truss.sh"
for file in k.mtx m.mtx dofs bdf; do
    same "truss72.$file is what make-truss.sh gives" "truss72.$file" \
        "$data/truss72.$file"
done
expect 0 '' sh "$data/make-truss.sh" small 4 held
expect 0 '16 dofs at 8 grids' ritz-import --stiffness small.k.mtx \
    --mass small.m.mtx --dofs small.dofs -o small.h5
expect 0 '72 dofs at 36 grids' ritz-import --stiffness truss72.k.mtx \
    --mass truss72.m.mtx --dofs truss72.dofs --bulk truss72.bdf \
    --port middle=17,18 --input push=1:2 --output-at tip=36:2 \
    --output-at rate=36:1/vel -o truss.h5

# reduce METHOD WORDS OPTION...: basis, reduced component and its errors
reduce() {
    method=$1 words=$2
    shift 2
    expect 0 "$words" ritz-basis "$method" "$@" truss.h5 -o basis.h5
    expect 0 '3 rigid' ritz-reduce truss.h5 basis.h5 -o reduced.h5
    expect 0 'frequency-relative' ritz-verify truss.h5 reduced.h5 \
        --band-hz 0,60 --limit-frequency 1e-5 --limit-gain 1e-9 \
        --limit-response 1e-4 -o verified.h5
}

# --- each method to the end --------------------------------------------------

reduce krylov '4 whole block(s) about 0 Hz' --modes 12 --attach ''
reduce krylov '2 whole block(s) about 0 Hz, 2 whole block(s) about 30 Hz' \
    --modes 12 --attach '' --shift-hz 30,0 --inner mass
reduce krylov-damped 'krylov does the same' --modes 12 --attach ''
reduce krylov-damped '4 whole block(s) about 0 Hz' --modes 12 --attach '' \
    --damping 'rayleigh 2 1e-5'
reduce krylov-damped '2 whole block(s) about 0 Hz, 1 whole block(s) about 30 Hz' \
    --modes 12 --attach '' --shift-hz 30,0 --damping 'rayleigh 2 1e-5'
reduce krylov-cms-fixed '4 constraint, 14 krylov' --modes 14
reduce krylov-cms-free '4 attachment' --modes 14
expect 0 'krylov (modes 12 shift-hz 0,30 load inputs) [CraigSuKim1992]' \
    ritz-basis krylov --modes 12 --shift-hz 0,30 --loads inputs truss.h5 \
    -o basis.h5

# --- what is asked in vain ---------------------------------------------------

expect 1 'ask for a number of them' ritz-basis krylov --up-to-hz 20 truss.h5 \
    -o none.h5
expect 1 'there is no load to respond to' ritz-basis krylov --modes 4 --attach '' \
    --loads dampers truss.h5 -o none.h5
expect 1 'ratios of modes make no matrix D' ritz-basis krylov-damped \
    --modes 4 --damping 'modal 0.01' truss.h5 -o none.h5
expect 2 "craig-bampton has no 'shift_hz' to choose" ritz-basis craig-bampton \
    --modes 4 --shift-hz 3 truss.h5 -o none.h5
expect 1 '3 motion(s) cost no energy' ritz-basis krylov-cms-fixed --modes 4 \
    --attach '' truss.h5 -o none.h5
expect 0 '69 vectors and not 400, nothing new is left' \
    ritz-basis krylov --modes 400 truss.h5 -o most.h5

echo "1..$count"
