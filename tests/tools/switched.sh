#!/bin/sh
# Switched models by the tools, on the models of data/switching.
# Usage: switched.sh FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"

data=$here/../../data/switching
sh "$data/make-matrices.sh" .

ritz-import -q --stiffness plane.K.mtx --mass plane.M.mtx \
    --damping plane.D.mtx --dofs plane.dofs --input fx=1:1 --input fy=1:2 \
    --output-at x=1:1 --output-at vx=1:1/vel -o plane.h5
ritz-import -q --stiffness turn.K.mtx --mass beam.M.mtx --dofs beam.dofs \
    --input along=11:1 --input across=11:2 --output-at x=11:1 \
    --output-at y=11:2 -o turn.h5
ritz-basis -q normal-modes --modes 10 turn.h5 -o basis.h5

plane='--seconds 3 --step 0.0025 --input fx=d3-x.tsv --input fy=d3-y.tsv'
turn='--seconds 8 --step 0.001 --every 20 --input along=turn-along.tsv
    --input across=turn-across.tsv'

# --- runs --------------------------------------------------------------------

json 0 ritz-simulate $plane plane.h5 --switched density4.mtx --redundant \
    --switch-interval 0.01 --indicator 0.9 -o plane-d4.h5
holds '  one vector of 32 carries the motion' \
    'j["vectors"] == 32 and 0.9 < j["mean_vectors"] < 1
     and j["fallbacks"] == 0 and j["imbalance"] < 1e-12'
expect 0 'leading vector       0 to 21' ritz-info plane-d4.h5
expect 0 'method         switched, step 0.0025 s' ritz-info plane-d4.h5

json 0 ritz-simulate $turn turn.h5 --damping 'rayleigh 10 0' \
    --switched basis.h5 --switch-interval 0.02 --indicator 0.999999999 \
    --share-of library --look-ahead -o switched.h5
holds '  fewer vectors a step than the twelve of the library' \
    'j["vectors"] == 12 and j["mean_vectors"] < 8
     and 0 < j["left_out"] < 1e-4 and not j.get("warnings")'
ritz-simulate -q $turn turn.h5 --damping 'rayleigh 10 0' --up-to-hz 1e6 \
    -o full.h5
expect 0 '' ritz-chart switched full.h5 switched.h5 -o switched.svg
expect 0 'switched.h5: 6' cat switched.svg
expect 1 'the full model first' ritz-chart switched full.h5 -o x.svg
expect 1 "'plane-d4.h5' has no output 'y'" ritz-chart switched full.h5 \
    plane-d4.h5 -o x.svg

# Of a run of half the time, as an interrupted one is, and of one at every step
# the errors are those at the times that both have.
for run in half few; do
    every=20
    [ "$run" = few ] || every=1
    ritz-simulate -q $turn turn.h5 --damping 'rayleigh 10 0' --switched \
        basis.h5 --switch-interval 0.02 --indicator 0.999999999 --share-of \
        library --look-ahead --seconds 4 --every $every -o $run.h5
    ritz-chart -q switched full.h5 $run.h5 -o $run.svg
    sed -n "s/.*$run.h5: \([^<]*\).*/\1/p" $run.svg | head -1 >$run.txt
done
works 'the errors of a part of the times are charted' cmp half.txt few.txt
works '  for what there is' grep -q 'vectors, error' half.txt
expect 0 '' ritz-chart switched half.h5 switched.h5 few.h5 -o x.svg
rm x.svg
ritz-simulate -q $turn turn.h5 --up-to-hz 1e6 --seconds 0.01 --every 1 \
    -o short.h5
expect 1 "'short.h5' and the first run have fewer than two times" ritz-chart switched \
    full.h5 short.h5 -o x.svg
ritz-simulate -q turn.h5 --seconds 8 --step 0.003 --up-to-hz 1e6 \
    --input along=step -o other.h5
expect 1 "'other.h5' has other times than the first run" ritz-chart switched \
    full.h5 other.h5 -o x.svg

json 0 ritz-simulate $turn turn.h5 --damping 'rayleigh 10 0' \
    --switched modes:6 --switch-interval 0.02 --indicator 0.9 --jump project \
    --share-of library -o project.h5
holds '  what a projection takes is in the balance' 'j["imbalance"] < 1e-9'
holds '  a projection that takes motion is warned of' \
    'j["left_out"] > 1e-3 and "kinetic energy, which is lost" in str(j["warnings"])'
expect 0 'energy lost at switches' ritz-info project.h5

# The beam of 6.3 has 30 modes. While the load acts across it, 10 to 15 are
# taken at Emin 0.9 (fewer where the load passes through 0), nearly all at
# 0.9999.
ritz-import -q --stiffness beam.K.mtx --mass beam.M.mtx --dofs beam.dofs \
    --input along=11:1 --input across=11:2 --output-at y=11:2 -o beam.h5
for least in 0.9 0.9999; do
    ritz-simulate -q beam.h5 --damping 'rayleigh 1 1e-3' --switched modes \
        --switch-interval 0.01 --indicator $least --seconds 4 --step 0.0005 \
        --every 20 --input along=along.tsv --input across=across.tsv \
        -o beam-$least.h5
    ritz-export -q --to tsv beam-$least.h5 -o beam-$least.tsv
done
# vectors FROM TO FILE: the median number of vectors from FROM to TO seconds
vectors() {
    awk -F '\t' -v from="$1" -v to="$2" 'NR == 1 {
        for (j = 1; j <= NF; j++)
            if ($j == "vectors")
                at = j
    }
    NR > 1 && $1 > from + 1e-6 && $1 < to + 1e-6 { print $at + 0 }' "$3" |
        sort -n | awk '{ v[NR] = $1 } END { print v[int((NR + 1) / 2)] }'
}
median=$(vectors 0 0.5 beam-0.9.tsv)
works "10 to 15 modes at Emin 0.9 ($median)" \
    test "$median" -ge 10 -a "$median" -le 15
works 'all 20 bending modes at Emin 0.9999' \
    test "$(vectors 0 0.5 beam-0.9999.tsv)" -eq 20
works 'and most of the 30 after a load along the beam' \
    test "$(vectors 1 1.5 beam-0.9999.tsv)" -ge 24

# A reduced component, and a run that is continued from its checkpoint.
ritz-reduce -q turn.h5 basis.h5 -o reduced.h5
works 'a reduced component is switched' ritz-simulate -q $turn reduced.h5 \
    --damping 'rayleigh 10 0' --switched modes --switch-interval 0.02 \
    --checkpoint kept.h5 -o reduced-run.h5
works 'its checkpoint is removed' test ! -e kept.h5

# A basis of another model fits by its number of rows.
ritz-import -q --stiffness turn.K.mtx --mass beam.M.mtx --dofs beam.dofs \
    --input along=11:1 --input across=11:2 --output-at y=10:2 -o other.h5
expect 0 "basis 'basis.h5' was made from 'turn.h5', whose SHA-256 differs from" \
    ritz-simulate $turn other.h5 --damping 'rayleigh 10 0' \
    --switched basis.h5 --switch-interval 0.02 --indicator 0.999999999 \
    --share-of library -o other-run.h5

# --- refusals ----------------------------------------------------------------

run="ritz-simulate $turn turn.h5 --switch-interval 0.02 -o x.h5"
expect 1 'D couples vector' $run --damping 'rayleigh 1 1e-3' \
    --switched basis.h5
expect 1 'sets that dwell' $run --damping 'rayleigh 1 1e-3' \
    --switched basis.h5 --jump project
expect 1 'is an eigenvector of M' $run --damping 'rayleigh 10 0' \
    --switched modes --inner euclidean
expect 1 'a library of 2 rows is of another model' $run --switched a.mtx
expect 1 "'modes:x' is not a number of modes" $run --switched modes:x
expect 1 'a library without a name' $run --switched modes:3,
expect 1 'damping ratios of a component' $run --damping 'modal 0.01' \
    --switched modes:3
expect 1 "'turn.h5' holds a component, not a basis" $run --switched turn.h5
expect 1 '--switched needs --switch-interval' ritz-simulate $turn turn.h5 \
    --switched modes -o x.h5
expect 1 '--switched needs --step' ritz-simulate --seconds 1 \
    --input along=step turn.h5 --switched modes --switch-interval 0.1 -o x.h5
for given in '--switch-interval 0.1' '--indicator 0.99' '--share-of model' \
    --look-ahead '--inner mass' '--jump offset' '--hysteresis 0' '--dwell 0' \
    --redundant; do
    expect 2 'is for --switched' ritz-simulate $turn turn.h5 \
        --up-to-hz 1e6 $given -o x.h5
done
expect 2 '--method trapezoidal cannot be used' $run --damping 'rayleigh 10 0' \
    --switched basis.h5 --method trapezoidal
works 'nothing is written where a run is refused' test ! -e x.h5

# --- a scene -----------------------------------------------------------------

. "$here/models.sh"
data=$here/../../data
import_spacecraft
spacecraft scene 'inputs:' \
    '  - {name: motor, at: rotor/bearing, component: 6, against: stator/bearing}' \
    'outputs:' '  - {name: gyro, at: platform/scan, component: 6}'
ritz-assemble -q scene.yaml --at clock=90 -o system.h5
ritz-basis -q normal-modes --modes 12 system.h5 -o joined.h5
ritz-basis -q normal-modes --modes 12 rotor.h5 -o body.h5
scene='scene.yaml --at clock=90 --seconds 1 --step 0.001 --input motor=sine:3
    --switch-interval 0.02 --indicator 0.999999 --share-of library'
json 0 ritz-simulate $scene --switched modes:12 -o modes.h5
holds '  the modes of a scene are those of its system' \
    'j["vectors"] == 12 and j["imbalance"] < 1e-9'
expect 1 'D couples vector 21 to others' ritz-simulate $scene \
    --switched joined.h5 -o x.h5 # the static vector of the motor
json 0 ritz-simulate $scene --damping 'rayleigh 1 0' --switched joined.h5 \
    -o joined-run.h5
holds '  a basis of the system is a library of the scene' \
    'j["vectors"] == 21 and j["imbalance"] < 1e-9'
expect 1 'give '"'modes'"', or a basis of the system that ritz-assemble' \
    ritz-simulate $scene --switched body.h5 -o x.h5
expect 1 'give --constraints or --switched, not both' \
    ritz-simulate $scene --switched modes --constraints index-2 -o x.h5

echo "1..$count"
