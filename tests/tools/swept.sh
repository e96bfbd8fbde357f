#!/bin/sh
# A joint that turns while the system vibrates. Usage: swept.sh
# FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

import_spacecraft
spacecraft scene 'band_hz: [0, 5]' \
    'inputs: [{name: motor, at: rotor/bearing, component: 6, against: stator/bearing}]' \
    'outputs: [{name: gyro, at: platform/scan, component: 6}]'
run='--step 0.01 --input motor=sine:1 scene.yaml'

expect 0 'JOINT=FROM:TO:TIME' ritz-simulate --help
# shellcheck disable=SC2086
{
    json 0 ritz-simulate --sweep clock=0:60:4s:smooth --sweep-modes 14 \
        --sweep-against full $run -o run.h5
    holds 'modes at each setting, with the terms, are near the full model' \
        'j["basis"] == "switched" and j["modes"] == 14
         and j["interpolation"] <= 1e-7 and j["against"] == "full"
         and j["response_error"] < 0.05 and j["energy_error"] < 0.05
         and j["diagnostics"][0]["name"] == "angle_deg"
         and j["joints"][0] == {"name": "clock", "setting": 0, "unit": "deg"}'
    holds '  at a rate below the lowest mode, without a warning of it' \
        'j["rate_ratio"] < 1
         and not any("lowest frequency" in w for w in j["warnings"])'
    json 0 ritz-simulate --sweep clock=0:60:0.5s:smooth --sweep-modes 14 \
        $run -o fast.h5
    holds 'a joint that turns faster than the lowest mode has a warning' \
        'j["rate_ratio"] > 1 and any("times the lowest frequency" in w
                                     for w in j["warnings"])'
    json 0 ritz-simulate --sweep clock=0:60:4s:smooth --sweep-modes 14 \
        --sweep-basis without-terms --sweep-against full $run -o wrong.h5
    holds '  and without the terms they are not' \
        'j["response_error"] > 0.05 or j["energy_error"] > 0.05'
    expect 0 '8 rigid motions: forces of the commanded motion' ritz-simulate \
        --sweep clock=60:0:4s:smooth --sweep-basis one --sweep-against full \
        $run -o one.h5
    expect 0 'angle_deg            0 to 60, 60 at the end' ritz-info run.h5
    expect 0 'trapezoidal, step 0.01 s' ritz-info run.h5

    expect 0 'clock from 0 to 60 deg in 4 s' ritz-simulate \
        --sweep clock=0:60:4s:smooth --sweep-modes 14 $run -o run.h5
    expect 0 'clock in deg' ritz-assemble scene.yaml -o system.h5

    # A file of times and settings; the run ends with the path.
    printf '0 10\n1 20\n2 15\n' >path.tsv
    expect 0 '201 times to 2 s' ritz-simulate --sweep clock=path.tsv \
        --sweep-modes 14 $run -o table.h5
    expect 0 'path.tsv' ritz-info table.h5

    # Whole turns cost as much as one.
    json 0 ritz-simulate --sweep clock=0:36000:4000s --seconds 1 \
        --sweep-modes 14 $run -o turns.h5
    holds 'a hundred turns have the settings of one' 'j["settings"] == 129'

    # What the basis does not span of an initial state; by NumPy, 4 / (1 + 4) of
    # the mass norm of modes 10 and 16.
    for k in $(seq 36); do
        case $k in 10) echo 1 ;; 16) echo 2 ;; *) echo 0 ;; esac
    done >x0.txt
    from='--sweep clock=0:60:4s --sweep-modes 14 --step 0.01 scene.yaml -o x.h5'
    expect 0 'leaves out 80 % of the initial displacement' ritz-simulate \
        --initial x0.txt $from
    expect 1 'nothing would move: the basis of 14 modes has no part of the' \
        ritz-simulate --initial mode:16 $from
    json 0 ritz-simulate --initial mode:10 $from
    holds '  and a mode of the basis is whole' \
        'j["lost_displacement"] < 1e-12 and j["lost_strain"] < 1e-12
         and not any("leaves out" in w for w in j["warnings"])'

    # --- refusals -------------------------------------------------------------
    expect 1 "--sweep: unknown joint 'clok', is 'clock' meant?" ritz-simulate \
        --sweep clok=0:60:4s $run -o no.h5
    expect 1 "--at: unknown joint 'con', is 'cone' meant?" ritz-simulate \
        --sweep clock=0:60:4s --at con=1 $run -o no.h5
    expect 2 "'clock' moves by --sweep, and --at sets it too" ritz-simulate \
        --sweep clock=0:60:4s --at cone=1,clock=3 $run -o no.h5
    expect 1 "'no.tsv' is neither FROM:TO:TIME, as 0:60:30s, nor a file" \
        ritz-simulate --sweep clock=no.tsv $run -o no.h5
    expect 1 "'0:0:4s' does not move: it is at 0 all the time" ritz-simulate \
        --sweep clock=0:0:4s $run -o no.h5
    expect 1 "'clock' is not JOINT=FROM:TO:TIME" ritz-simulate \
        --sweep clock $run -o no.h5
    expect 1 'stops with a jump of its rate' ritz-simulate \
        --sweep clock=0:60:4s --seconds 5 --sweep-modes 14 $run -o no.h5
    expect 1 'not by generalised-alpha' ritz-simulate --sweep clock=0:60:4s \
        --method generalised-alpha --sweep-modes 14 $run -o no.h5
    expect 2 'not for --sweep' ritz-simulate --sweep clock=0:60:4s \
        --damper a=1 $run -o no.h5
    expect 1 'not by modal' ritz-simulate --sweep clock=0:60:4s \
        --method modal --sweep-modes 14 $run -o no.h5
    expect 2 'give --sweep-modes or --up-to-hz, not both' ritz-simulate \
        --sweep clock=0:60:4s --up-to-hz 5 --sweep-modes 14 $run -o no.h5
    expect 2 '--up-to-hz has no effect on a basis of all modes' \
        ritz-simulate --sweep clock=0:60:4s --sweep-basis full \
        --up-to-hz 5 $run -o no.h5
    expect 2 '--sweep is given twice: one joint moves' ritz-simulate \
        --sweep clock=0:60:4s --sweep cone=0:10:4s $run -o no.h5
    expect 2 '--sweep-modes has no effect on a basis of all modes' \
        ritz-simulate --sweep clock=0:60:4s --sweep-basis full \
        --sweep-modes 14 $run -o no.h5
    expect 1 'fewer than the 8 rigid motions' ritz-simulate \
        --sweep clock=0:60:4s --sweep-modes 3 $run -o no.h5
}
expect 1 '--sweep needs --step' ritz-simulate --sweep clock=0:60:4s \
    --input motor=step scene.yaml -o no.h5
expect 1 "'rotor.h5' is not a scene: joints of a scene move" ritz-simulate --sweep clock=0:60:4s \
    --step 0.01 --initial mode:7 rotor.h5 -o no.h5
works 'a beam on a hinge is that in space axes, with its rotary inertia' \
    /usr/bin/python3 -s "$here/turning.py" "$bin"
works 'nothing is written where a run is refused' test ! -e no.h5

echo "1..$count"
