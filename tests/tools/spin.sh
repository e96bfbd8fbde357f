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

# The error at which stiffening is negligible.
sed 's/rate: 6/rate: 6, negligible: 0.01/' constant.yaml >error.yaml
json 0 ritz-assemble error.yaml -o x.h5
holds '  another error of frequencies is that of the rate' \
    'j["stiffening_negligible_error"] == 0.01 and
     near([j["stiffening_negligible_rate"]], [0.4861252396], 1e-8)'

# A mass of 4 kg at the tip, and the same at the end of an arm of 1 m. KG of a
# unit tension has the elements 1/(30 h) [36, 3h, -36, 3h; ...].
printf '%s\n' 'BEGIN BULK' 'GRID,1,,0.,0.,0.' 'ENDDATA' >mass.bdf
printf '%s\n' '%%MatrixMarket matrix coordinate real symmetric' '6 6 3' \
    '1 1 4.' '2 2 4.' '6 6 .01' >mass.mtx
ritz-import -q --mass mass.mtx --bulk mass.bdf --port p=1 -o mass.h5
awk 'BEGIN {
    h = 10 / 12; a = 3 * h; b = 4 * h * h; split("2 3 5 6", row, " ")
    split(sprintf("36 0 0 0 %.17g %.17g 0 0 -36 %.17g 36 0 %.17g %.17g %.17g " \
        "%.17g", a, b, -a, a, -b / 4, -a, b), k, " ") # rows, lower triangle
    for (e = 0; e < 12; e++) for (i = 1; i <= 4; i++) for (j = 1; j <= i; j++)
        A[3*e + row[i], 3*e + row[j]] += k[4*(i - 1) + j] / (30 * h)
    for (at in A) count++
    print "%%MatrixMarket matrix coordinate real symmetric"
    print 39, 39, count
    for (at in A) { split(at, ij, SUBSEP); printf "%d %d %.17g\n", ij[1], ij[2],
        A[at] } }' >pull.mtx
ritz-import -q --stiffness "$folder/K.mtx" --mass "$folder/M.mtx" \
    --geometric-stiffness "$folder/KG.mtx@spin" \
    --geometric-stiffness pull.mtx@pull --bulk "$folder/beam.bdf" \
    --port tip=13 -o pulled.h5
tipped() { # RATE STIFFENING OFFSET
    cat <<SCENE
scene: beam with a mass
plane: xy
components:
  beam: {model: pulled.h5, basis: full, stiffening: {$2}}
  mass: {model: mass.h5, basis: rigid}
joints:
  - {name: j, between: [beam/tip, mass/p], type: rigid, offset: [$3, 0, 0]}
spin: {axis: [0, 0, 1], rate: $1}
SCENE
}
tipped 3 'spin_zz: spin, tip: pull' 0 >at-tip.yaml
tipped 3 'spin_zz: spin, tip: pull' 1 >beyond.yaml
tipped 3 'spin_zz: spin' 0 >untipped.yaml
tipped 0.01 'spin_zz: spin' 0 >slow.yaml
json 0 ritz-assemble at-tip.yaml -o x.h5
holds '  a mass at the tip: two frequencies of an independent program' \
    'near(j["frequencies_hz"][:2], [0.441799073, 3.294482829], 1e-8)
     and not j["warnings"]'
holds '  and the rate up to which stiffening may be left out' \
    'near([j["stiffening_negligible_rate"]], [0.10052804738], 1e-9)'
json 0 ritz-assemble beyond.yaml -o x.h5
holds '  a mass beyond the tip stiffens by its offset' \
    'near(j["frequencies_hz"][:2], [0.4126409038, 2.822638730], 1e-6)'
json 0 ritz-assemble untipped.yaml -o x.h5
holds '  the pull of a mass is missed by name' \
    'any("{tip: LOAD}" in w and "beam" in w and "mass of 4 outboard" in w
         for w in j["warnings"])'
json 0 ritz-assemble slow.yaml -o x.h5
holds '  but not where it changes nothing' 'not j["warnings"]'
expect 0 'may be left out up to about 0.1006' ritz-assemble slow.yaml -o x.h5

# A step that no change of the rate resolves.
sed 's/to: 6, seconds: 15/to: 1, seconds: 0.1/' spin-up.yaml >quick.yaml
expect 0 'the step of 0.2 s is longer than the 0.1 s in which the rate' \
    ritz-simulate quick.yaml --method trapezoidal --step 0.2 --seconds 1 -o x.h5
json 0 ritz-simulate quick.yaml --method trapezoidal --step 0.1 --seconds 1 \
    -o x.h5
holds '  a step as long as the ramp has no warning' 'not j["warnings"]'
sed 's/ramp: .*/profile: [[0, 0], [0.5, 0], [0.6, 1], [9, 1]]}/' spin-up.yaml \
    >jump.yaml
expect 0 'the step of 0.2 s is longer than the 0.1 s in which the rate' \
    ritz-simulate jump.yaml --method trapezoidal --step 0.2 --seconds 1 -o x.h5

# Refusals.
sed 's/rate: 6/rate: 1e200/' constant.yaml >x.yaml
expect 1 'a rate of 1e+200 rad/s is beyond 1e+15 rad/s' \
    ritz-assemble x.yaml -o x.h5
expect 1 'a rate of spin that changes is for ritz-simulate' \
    ritz-assemble spin-up.yaml -o x.h5
expect 1 'a rate of spin that changes needs --step' \
    ritz-simulate spin-up.yaml --seconds 1 -o x.h5
expect 1 'integrated by trapezoidal alone, not by modal' \
    ritz-simulate spin-up.yaml --seconds 1 --step 0.01 -o x.h5
expect 0 'consistent, at a rate that changes' \
    ritz-simulate spin-up.yaml --seconds 1 --step 0.01 --method trapezoidal \
    --coordinates -o x.h5
sed 's/spin_zz: spin/spin_zz: spun/' constant.yaml >x.yaml
expect 1 "spin_zz: unknown load 'spun', is 'spin' meant?" \
    ritz-assemble x.yaml -o x.h5
sed 's/rate: 6/rate: 6, through: [1, 0, 0]/' constant.yaml >x.yaml
expect 1 'its basic origin, which is 1 from the axis' \
    ritz-assemble x.yaml -o x.h5

echo "1..$count"
