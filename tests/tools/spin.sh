#!/bin/sh
# Scenes that spin: data/spin-up is imported, reduced and simulated, and
# compared with tip.tsv, for which an independent program integrated all dofs.
# Usage: spin.sh FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"

folder=$data/spin-up
cp "$folder/spin-up.yaml" .
ritz-import -q --stiffness "$folder/K.mtx" --mass "$folder/M.mtx" \
    --geometric-stiffness "$folder/KG.mtx@spin" --bulk "$folder/beam.bdf" \
    --port tip=13 -o beam.h5
ritz-basis -q full beam.h5 -o basis.h5
ritz-reduce -q beam.h5 basis.h5 -o reduced.h5

# spin_up SCENE SECONDS: simulate SCENE.yaml and write the run as SCENE.tsv
spin_up() {
    ritz-simulate "$1.yaml" --method trapezoidal --step 0.005 --seconds "$2" \
        -o "$1.h5" 2>"$1.log" >"$1.out" &&
        ritz-export -q --to tsv "$1.h5" -o "$1.tsv"
}

# near COLUMN RUN-COLUMN NAME BOUND: at whole seconds RUN-COLUMN of NAME.tsv
# differs from COLUMN of tip.tsv by at most BOUND of the largest value. BOUND is
# the error of the integrator, (w h)^2 / 12 a period, w = 4.5 rad/s at the end.
near() {
    awk -v c="$1" -v r="$2" -v bound="$4" '
        NR == FNR { if (FNR > 1) { value[$1] = $c } next }
        !/^#/ && ($1 in value) && value[$1] != "nan" {
            e = $r - value[$1]; if (e < 0) e = -e; if (e > worst) worst = e
            v = value[$1]; if (v < 0) v = -v; if (v > most) most = v
            n++
        }
        END { if (n < 11 || worst > bound * most) {
            print "worst " worst " of " most " at " n; exit 1 } }
    ' "$folder/tip.tsv" "$3.tsv"
}

works 'the beam spins up' spin_up spin-up 20
works '  its tip deflects as in the reference' near 2 2 spin-up 3e-5
works '  and stretches as in the reference' near 3 3 spin-up 3e-5
works '  the rate up to which stiffening may be left out is printed' \
    grep -q 'may be left out up to 0.1545' spin-up.out

# The inconsistent and the ruthless model are wrong on purpose.
for model in inconsistent ruthless; do
    { cat spin-up.yaml && echo "spin_model: $model"; } >$model.yaml
done
works 'the inconsistent model diverges' spin_up inconsistent 10
works '  as it does in the reference' near 4 2 inconsistent 3e-4
works '  with a warning that names the missing terms' \
    grep -q 'leaves out geometric stiffness (KG)' inconsistent.log
works '  and a warning that names the rate at which it fails' \
    grep -q 'above 3.7977.* rad/s, where the stiffness of the inconsistent' \
    inconsistent.log
works 'the ruthless model keeps only the loads' spin_up ruthless 20
works '  and deflects as in the reference' near 5 2 ruthless 3e-5
works '  with a warning' grep -q 'leaves out gyroscopic' ruthless.log

# A constant rate.
{ grep -v '^spin:' spin-up.yaml && echo 'spin: {axis: [0, 0, 1], rate: 6}'; } \
    >constant.yaml
expect 0 'positive definite up to' ritz-assemble constant.yaml -o constant.h5
expect 0 '0.7181098' ritz-poles constant.h5
expect 0 'centrifugal' ritz-info constant.h5
expect 0 'tip' ritz-frf constant.h5 --to-hz 5 --damping 'modal 0.01' -o frf.h5
expect 0 'time response' ritz-simulate constant.yaml --seconds 1 \
    --input centrifugal=step -o constant-run.h5
sed '/stiffening/d' constant.yaml >lacking.yaml
expect 0 "component 'beam' has no 'stiffening: {spin_zz: LOAD}'" \
    ritz-assemble lacking.yaml -o lacking.h5

# Refusals.
expect 1 'a rate of spin that changes is for ritz-simulate' \
    ritz-assemble spin-up.yaml -o x.h5
expect 1 'a rate of spin that changes needs --step' \
    ritz-simulate spin-up.yaml --seconds 1 -o x.h5
expect 1 'integrated by trapezoidal alone, not by modal' \
    ritz-simulate spin-up.yaml --seconds 1 --step 0.01 -o x.h5
sed 's/spin_zz: spin/spin_zz: spun/' constant.yaml >x.yaml
expect 1 "spin_zz: unknown load 'spun', is 'spin' meant?" \
    ritz-assemble x.yaml -o x.h5
sed 's/rate: 6/rate: 6, through: [1, 0, 0]/' constant.yaml >x.yaml
expect 1 'its basic origin, which is 1 from the axis' \
    ritz-assemble x.yaml -o x.h5

echo "1..$count"
