# Make small sound files of every kind from the dual-spin spacecraft in $data,
# and the file `cases` with one case per line: a file that a tool reads, then
# the command, in which '@' is that file and OUT the output. To be sourced in an
# empty folder, with the tools on the PATH.
# shellcheck shell=sh disable=SC2154 # $data is of those who source it
# --- sound files, small and of every kind --------------------------------------

cp "$data"/stator.op4 "$data"/stator.bdf "$data"/rotor.op4 "$data"/rotor.bdf .
ritz-import -q --stiffness stator.op4:KGG --mass stator.op4:MGG \
    --bulk stator.bdf --port bearing=1 --port scan=5 --input torque=1:6 \
    --output-at gyro=5:6@1e-3 --damper 'strut=5:1,1:1*0' -o stator.h5
ritz-import -q --mass "$data/platform.op4:MGG" --bulk "$data/platform.bdf" \
    --port scan=1 -o platform.h5
cat >scene.yaml <<'YAML'
scene: stator and platform
components:
  stator:   {model: stator.h5,   basis: craig-bampton, modes: 6}
  platform: {model: platform.h5, basis: rigid}
joints:
  - {name: cone, between: [stator/scan, platform/scan], type: hinge, axis: [0, 1, 0], angles_deg: [0, 45]}
inputs:  [{name: torque, at: stator/bearing, component: 6}]
outputs: [{name: gyro, at: platform/scan, component: 6, limit: 1.0e-3}]
band_hz: [0, 10]
damping: {modal: 0.002}
select:  {by: hankel, tolerance: 1.0e-3}
YAML
ritz-basis -q macneal-rubin --modes 4 stator.h5 -o basis.h5
ritz-reduce -q stator.h5 basis.h5 -o reduced.h5
ritz-assemble -q --tracks tracks.tsv scene.yaml -o system.h5
ritz-assemble -q --full --at cone=0 scene.yaml -o full.h5
ritz-rank -q --at cone=0 system.h5 -o ranking.h5
ritz-frf -q --at cone=0 --points 5 --no-refine system.h5 -o response.h5
ritz-simulate -q --at cone=0 --seconds 0.1 --step 0.01 --input torque=step \
    system.h5 -o run.h5
printf '0\t0\n0.05\t1\n0.1\t0\n' >pulse.tsv
ritz-basis -q lanczos-one-sided --modes 6 --damping 'modal 0.01' stator.h5 \
    -o states.h5
ritz-reduce -q stator.h5 states.h5 -o space.h5
ritz-export -q --to output4 reduced.h5 -o binary.op4
ritz-export -q --to output4 --text reduced.h5 -o text.op4
ritz-export -q --to matrix-market --matrix K reduced.h5 -o k.mtx
ritz-export -q --to matlab space.h5 -o space.mat
rows=$(awk '!/^%/ { print $1; exit }' k.mtx)
awk -v n="$rows" 'BEGIN { for (i = 1; i <= n; i++) print i, 0 }' >k.dofs
awk -v n="$rows" 'BEGIN { for (i = 1; i <= n; i++) print "1e-3 0" }' >values.tsv

# one matrix as DMIG, in small fields and in large ones
{
    echo 'DMIG,KAAX,0,6,2,0'
    for k in 1 2 3; do
        printf 'DMIG    KAAX    %8d%8d        %8d%8d%8s\n' \
            7 $k 7 $k "$k.5D+3"
        printf 'DMIG*   %-16s%16d%16d\n*       %16d%16d%16s\n' \
            KAAX 8 $k 7 $k "-$k.5D+3"
        printf '*       %16d%16d%16s\n' 8 $k "$k.5D+3"
    done
} >k.pch

# --- cases: a file to damage, and the command that reads it -------------------

cat >cases <<'CASES'
stator.op4   ritz-info @
stator.op4   ritz-info --directory @
binary.op4   ritz-info @
k.mtx        ritz-info @
stator.bdf   ritz-info @
stator.h5    ritz-info @
system.h5    ritz-info @
ranking.h5   ritz-info @
space.h5     ritz-info @
space.mat    ritz-info @
stator.op4   ritz-import --stiffness @:KGG --mass @:MGG --bulk stator.bdf --port bearing=1 -o OUT
stator.bdf   ritz-import --stiffness stator.op4:KGG --mass stator.op4:MGG --bulk @ --port bearing=1 -o OUT
binary.op4   ritz-import --stiffness @:K --mass @:M --rows 0 -o OUT
text.op4     ritz-import --stiffness @:K --mass @:M --rows 0 -o OUT
space.mat    ritz-import --state-space @ -o OUT
k.mtx        ritz-import --stiffness @ --mass k.mtx --dofs k.dofs -o OUT
k.dofs       ritz-import --stiffness k.mtx --mass k.mtx --dofs @ -o OUT
k.pch        ritz-import --stiffness @:KAAX --mass @:KAAX -o OUT
stator.h5    ritz-check @
stator.h5    ritz-basis craig-bampton --modes 4 @ -o OUT
basis.h5     ritz-reduce stator.h5 @ -o OUT
stator.h5    ritz-reduce @ basis.h5 -o OUT
states.h5    ritz-reduce stator.h5 @ -o OUT
reduced.h5   ritz-verify --band-hz 0,10 stator.h5 @ -o OUT
stator.h5    ritz-verify --band-hz 0,10 @ reduced.h5 -o OUT
space.h5     ritz-verify --band-hz 0,10 stator.h5 @ -o OUT
scene.yaml   ritz-assemble @ -o OUT
scene.yaml   ritz-compare @ -o OUT
stator.h5    ritz-assemble scene.yaml -o OUT
platform.h5  ritz-compare scene.yaml -o OUT
system.h5    ritz-rank --at cone=0 @ -o OUT
system.h5    ritz-poles --at cone=0 --damper stator/strut=5 @ -o OUT
stator.h5    ritz-poles --scan strut=0:10:5 @ -o OUT
system.h5    ritz-frf --at cone=0 --points 5 @ -o OUT
full.h5      ritz-frf --points 5 --to-hz 10 --damping 'modal 0.01' --method direct @ -o OUT
response.h5  ritz-frf --at cone=0 --points-of @ system.h5 -o OUT
space.h5     ritz-frf --points 5 --to-hz 10 @ -o OUT
space.h5     ritz-export --to output4 @ -o OUT
space.h5     ritz-export --to matlab @ -o OUT
reduced.h5   ritz-export --to exudyn @ -o OUT
reduced.h5   ritz-export --to mbdyn @ -o OUT
reduced.h5   ritz-export --to output4 @ -o OUT
response.h5  ritz-export --to tsv @ -o OUT
run.h5       ritz-info @
run.h5       ritz-export --to tsv @ -o OUT
system.h5    ritz-simulate --at cone=0 --seconds 0.1 --step 0.01 --input torque=step @ -o OUT
space.h5     ritz-simulate --seconds 0.1 --step 0.01 --input torque=step @ -o OUT
values.tsv   ritz-simulate --initial @ --seconds 0.1 --step 0.01 reduced.h5 -o OUT
tracks.tsv   ritz-rank --tracks @ system.h5 -o OUT
pulse.tsv    ritz-simulate --seconds 0.1 --step 0.01 --input torque=@ reduced.h5 -o OUT
CASES
