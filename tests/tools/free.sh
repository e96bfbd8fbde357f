#!/bin/sh
# Free-interface and static methods as a user meets them.
# Usage: free.sh FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

expect 0 "243 dofs" import_body rotor --port bearing=1 --input torque=1:6 \
    --output-at spin=1:6 -o rotor.h5
expect 0 "57 dofs" import_body stator --port bearing=1 --port scan=5 \
    -o stator.h5
expect 0 "6 dofs" import_body platform --port scan=1 -o platform.h5

# --- a body alone -------------------------------------------------------------

# method METHOD COLUMNS: it is made, reduced, and right in the band
method() {
    expect 0 "$2" ritz-basis "$1" --up-to-hz 20 rotor.h5 -o basis.h5
    expect 0 "$2" ritz-reduce rotor.h5 basis.h5 -o "$1.h5"
    json 0 ritz-verify --band-hz 0,10 --limit-frequency 1e-8 --limit-gain 1e-8 \
        --damping "modal 0.002" rotor.h5 "$1.h5" -o "$1-verified.h5"
    holds "  $1 misses no mode, and answers as the full body does" \
        'all(m["verdict"] in ("pass", "measured") for m in j["measures"])
         and all(m["value"] <= 1e-5 for m in j["measures"]
                 if m["name"] in ("response-relative", "missing-modes"))'
}
method macneal "6 rigid, 22 normal, 6 massless"
method rubin "6 constraint, 28 normal"
method inertia-relief "6 rigid, 22 normal, 6 attachment"
method dual-craig-bampton "6 rigid, 22 normal, 6 force"
method normal-modes "6 rigid, 22 normal, 1 static"

# torque and spin are one of the six attached dofs
expect 0 "2 static mode(s) left out, the first of input 'torque'" ritz-basis \
    normal-modes --up-to-hz 20 --loads attached,inputs,outputs rotor.h5 \
    -o basis.h5
expect 0 "6 rigid, 3 normal" ritz-basis normal-modes --modes 3 stator.h5 \
    -o basis.h5
expect 1 "there is no load to respond to, no damper" ritz-basis normal-modes \
    --modes 3 --loads dampers stator.h5 -o basis.h5
expect 2 "serep has no 'loads' to choose" ritz-basis serep --modes 3 \
    --loads inputs rotor.h5 -o basis.h5
expect 0 "2 static mode(s) left out, the first of input 'torque'" ritz-basis \
    rubin --modes 22 --loads inputs,outputs rotor.h5 -o basis.h5
expect 0 "attached dof(s) are no coordinates, grid 1" ritz-basis rubin \
    --modes 235 rotor.h5 -o basis.h5

# --- systems ------------------------------------------------------------------

# scene METHOD: rotor and stator by that method
scene() {
    cat >"scene-$1.yaml" <<END
scene: spacecraft by $1
components:
  rotor: {model: rotor.h5, basis: $1, up_to_hz: 20}
  stator: {model: stator.h5, basis: $1, up_to_hz: 20}
  platform: {model: platform.h5, basis: rigid}
joints:
  - {name: clock, between: [rotor/bearing, stator/bearing], type: hinge, axis: [0, 0, 1], angles_deg: [0, 60]}
  - {name: cone, between: [stator/scan, platform/scan], type: hinge, axis: [0, 1, 0], angles_deg: [0]}
inputs: [{name: torque, at: rotor/bearing, component: 6}]
outputs: [{name: gyro, at: platform/scan, component: 6}]
band_hz: [0, 10]
damping: {modal: 0.002}
select: {by: hankel, tolerance: 1.0e-2}
END
}
for method in macneal rubin inertia-relief dual-craig-bampton \
    loaded-interface; do
    scene "$method"
done
# the flexible modes up to 3 Hz, as macneal-rubin gives them at clock 60
low='[0.1824363, 0.4934836, 1.295845, 1.447517, 1.720726, 2.343622, 2.534052]'
for method in macneal rubin inertia-relief dual-craig-bampton \
    loaded-interface; do
    json 0 ritz-assemble "scene-$method.yaml" --at clock=60 -o "$method.h5"
    holds "  joined by $method it has 8 rigid and the lowest flexible modes" \
        'near(j["frequencies_hz"][:8], [0] * 8, 1e-6)
         and near(j["frequencies_hz"][8:15], '"$low"', 2e-3)'
done
expect 0 "negative-eigenvalues           1.0000e+01            0  fail" \
    ritz-assemble scene-dual-craig-bampton.yaml --at clock=60 -o dual.h5
# poles on the right are those of the forces: rigid motion is not among them
expect 0 "16 poles at 0 are not listed: rigid-body motion" ritz-poles dual.h5
json 0 ritz-poles dual.h5
holds '  and none of the unstable ones is rounding' \
    'sum(p["real"] > 0 for p in j["poles"]) == 10
     and all(p["hertz"] > 1e-2 for p in j["poles"])'
expect 0 "10 poles are negative squares of the forces" ritz-poles dual.h5
works "  and no pole is only called unstable" \
    test -z "$(grep -E 'is unstable: it grows|unstable$' log)"
expect 0 "8 rigid, 36 flexible modes" ritz-info dual.h5
expect 0 "10 negative squares of the forces that join bodies" ritz-info dual.h5
json 0 ritz-info dual.h5
holds "  which stand apart" 'j["configurations"][0]["negative_squares"] == 10'
expect 1 "an unstable model has no steady response" ritz-frf --from-hz 0.1 \
    --to-hz 10 dual.h5 -o none.h5
expect 1 "10 negative squares from 27.9" ritz-frf --from-hz 0.1 --to-hz 10 \
    dual.h5 -o none.h5
expect 0 "296 dofs" ritz-assemble --full scene-dual-craig-bampton.yaml \
    --at clock=60 -o full.h5
expect 1 "10 negative squares from 27.9" ritz-verify full.h5 dual.h5 -o none.h5
expect 1 "is a negative square: forces that join bodies" ritz-rank dual.h5
expect 1 "10 negative squares of the forces that join bodies" ritz-check dual.h5
expect 1 "(stiffness-definite, mode 41, -27.92 Hz)" ritz-export --to matlab \
    dual.h5 -o none.mat
expect 0 "10 negative squares of the forces that join bodies, no modes of" \
    ritz-assemble scene-dual-craig-bampton.yaml --tracks dual.tsv \
    --components dual- -o swept.h5
works "  they have no track, nor are others taken for them" /usr/bin/python3 -s - \
    <<'END'
rows = [line.split("\t") for line in open("dual.tsv")][1:]
there = [r for r in rows if r[1] == "clock=0,cone=0"]
assert len(there) == 46
assert all((r[0] == "0") == (float(r[3]) < 0) for r in rows)
tracks = [r[0] for r in there if r[0] != "0"]
assert len(tracks) == 36 and len(set(tracks)) == 36, tracks
END
expect 0 "10 negative squares of the forces that join bodies of dual-craig" \
    ritz-chart tracks dual.tsv -o tracks.svg
expect 0 "10 negative squares of interface forces, no modes, are left" \
    cat tracks.svg
expect 0 "10 negative squares of the forces that join bodies of dual-craig" \
    ritz-chart mac swept.h5 dual-rotor.h5 dual-stator.h5 dual-platform.h5 \
    -o mac.svg
works "  and is of 36 modes" test "$(wc -l <mac.svg.tsv)" -ge $((36 * 36))
works "  none of them a square" test -z "$(grep -e ': -[0-9.]* Hz' mac.svg.tsv)"
expect 0 "54 shapes" ritz-export --to vtu swept.h5 --at clock=60 -o shapes.vtu \
    --component rotor=dual-rotor.h5 --component stator=dual-stator.h5 \
    --component platform=dual-platform.h5
expect 0 'Name="negative square 41, -27.92 Hz"' cat shapes.vtu
expect 1 "10 negative squares of the forces" ritz-simulate dual.h5 --seconds 5 \
    --step 0.01 --input torque=step -o none.h5
expect 1 "negative squares of interface forces, first: mode 41" \
    ritz-compare scene-dual-craig-bampton.yaml -o none.h5
expect 1 "component 'rotor' is reduced by dual-craig-bampton" \
    ritz-compare scene-dual-craig-bampton.yaml -o none.h5
expect 1 "has columns for a joint by forces" ritz-export --to output4 \
    dual-craig-bampton-verified.h5 -o none.op4
expect 0 "has columns for a joint by forces" ritz-export --to output4 --force \
    dual-craig-bampton-verified.h5 -o forced.op4
expect 0 "stage 2" ritz-compare scene-macneal.yaml -o compared.h5
for method in guyan irs; do
    expect 1 "there is no port; ritz-import --port gives them to a component" \
        ritz-basis $method macneal.h5 -o none.h5
done

# --- neighbours ---------------------------------------------------------------

expect 0 "6 rigid, 12 normal" ritz-basis loaded-interface --modes 12 \
    --attach scan --neighbour scan=platform.h5:scan stator.h5 -o basis.h5
expect 1 "it is not said what hangs on the interface" ritz-basis \
    loaded-interface --modes 12 stator.h5 -o basis.h5
expect 1 "is not PORT=FILE:PORT" ritz-basis loaded-interface --modes 12 \
    --neighbour scan=platform.h5 stator.h5 -o basis.h5
expect 1 "there is no port 'scam', is 'scan' meant?" ritz-basis \
    loaded-interface --modes 12 --neighbour scan=platform.h5:scam stator.h5 \
    -o basis.h5
expect 1 "grid 1 T1 of port 'bearing' is not attached" ritz-basis \
    loaded-interface --modes 12 --attach scan \
    --neighbour bearing=platform.h5:scan stator.h5 -o basis.h5
expect 2 "--neighbour is not for it" ritz-basis craig-bampton --modes 12 \
    --neighbour scan=platform.h5:scan stator.h5 -o basis.h5

printf '1..%d\n' "$count"
