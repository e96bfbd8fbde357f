#!/bin/sh
# Joints of a scene from import to response, as a user meets them.
# Usage: joints.sh FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"

# A free body: one grid of mass $1 and inertia $2 about each axis.
mass() {
    echo '%%MatrixMarket matrix coordinate real symmetric'
    echo '6 6 6'
    for i in 1 2 3; do echo "$i $i $1"; done
    for i in 4 5 6; do echo "$i $i $2"; done
}
mass 2 0.5 >a.m.mtx
mass 3 4 >b.m.mtx
mass 1 1 >c.m.mtx
printf 'GRID,1,,0.,0.,0.\n' >point.bdf
for body in a b c; do
    expect 0 "$body.h5" ritz-import --mass $body.m.mtx --bulk point.bdf \
        --port p=1 -o $body.h5
done

# scene JOINTS: bodies a, b, c and what joins them.
scene() {
    cat <<END
scene: three points
components:
  a: {model: a.h5, basis: rigid}
  b: {model: b.h5, basis: rigid}
  c: {model: c.h5, basis: rigid}
joints:
$1
inputs: [{name: torque, at: a/p, component: 6}]
outputs: [{name: turn, at: b/p, component: 6}]
damping: {modal: 0.002}
END
}

# The slider turns b with c and the hinge carries a with b, so that J is
# 1 / (1 / 0.5 + 1 / (4 + 1)) and m is 1 / (1 / (2 + 3) + 1 / 1).
scene '  - {name: clock, between: [a/p, b/p], type: hinge, axis: [0, 0, 1],
     angles_deg: [0, 30], state: caged, stiffness: 8, damping: 0.1}
  - {name: slide, between: [b/p, c/p], type: slider, axis: [0, 0, 1],
     positions: [0, -2.5], state: caged, stiffness: 30}' >caged.yaml
json 0 ritz-assemble caged.yaml -o caged.h5
holds '  hinge and slider swing on their springs at each setting' '
    len(j["configurations"]) == 4 and all(
        len(c["frequencies_hz"]) == 8
        and all(f == 0 for f in c["frequencies_hz"][:6])
        and near(c["frequencies_hz"][6:], sorted([
            math.sqrt(8 * (2 + 1 / 5)) / (2 * math.pi),
            math.sqrt(30 * (1 / 5 + 1)) / (2 * math.pi)]), 1e-12)
        for c in j["configurations"])'
holds '  settings are named' '
    [c["at"] for c in j["configurations"]] == [
        "clock=0,slide=0", "clock=0,slide=-2.5",
        "clock=30,slide=0", "clock=30,slide=-2.5"]'
expect 0 'clock=30,slide=-2.5' ritz-assemble caged.yaml \
    --at clock=30,slide=-2.5 -o one.h5
expect 0 '8 dofs' ritz-assemble caged.yaml --at slide=-2.5,clock=30 --full \
    -o full.h5
expect 0 'clock=30,slide=-2.5' ritz-info one.h5
expect 0 'pass' ritz-verify full.h5 one.h5 --band-hz 0,2 \
    --limit-frequency 1e-12 --limit-response 1e-9 -o verified.h5
expect 1 "--at: joint 'slide' has several settings and none is given here" \
    ritz-assemble caged.yaml --at clock=30 -o none.h5
expect 1 "unknown joint 'slid', is 'slide' meant?" \
    ritz-assemble caged.yaml --at clock=30,slid=1 -o none.h5
expect 1 "'slide' is not JOINT=SETTING" \
    ritz-assemble caged.yaml --at slide -o none.h5
expect 1 "there is no joint 'slid' to set" \
    ritz-frf caged.h5 --at clock=30,slid=0 -o none.h5

scene '  - {name: gimbal, between: [a/p, b/p], type: universal,
     axes: [[0, 0, 1], [0, 1, 0]], angles_deg: [0, 90], angles2_deg: [10]}
  - {name: mount, between: [b/p, c/p], type: bushing,
     stiffness: [30, 0, 120, 0, 20, 45]}' >gimbal.yaml
json 0 ritz-assemble gimbal.yaml -o gimbal.h5
holds '  two free angles, two free directions of the bushing' '
    [c["at"] for c in j["configurations"]] == [
        "gimbal=0,gimbal.2=10", "gimbal=90,gimbal.2=10"]
    and all(sum(f == 0 for f in c["frequencies_hz"]) == 6 + 2 + 2
            for c in j["configurations"])'
expect 0 'gimbal=5,gimbal.2=-7' ritz-assemble gimbal.yaml \
    --at gimbal.2=-7,gimbal=5 -o one.h5

scene '  - {name: ball, between: [a/p, b/p], type: spherical}
  - {name: ballast, between: [b/p, c/p], type: rigid, offset: [0, 3, 4]}' \
    >ball.yaml
json 0 ritz-assemble ball.yaml -o ball.h5
holds '  a ball leaves three motions and a rigid joint none' '
    j["configurations"][0]["frequencies_hz"] == [0] * 9'

# --- refusals ----------------------------------------------------------------

# refuse WORDS JOINT: a scene with one joint between a and b is refused.
refuse() {
    scene "  - {name: j, between: [a/p, b/p], $2}" >bad.yaml
    expect 1 "$1" ritz-assemble bad.yaml -o none.h5
}
refuse "bad.yaml:7:62: 'angles_deg' does not belong to a slider" \
    'type: slider, angles_deg: [1], axis: [0, 0, 1]'
refuse "bad.yaml:7:5: universal joint 'j' has no axes" 'type: universal'
refuse "bad.yaml:7:59: the two axes are parallel" \
    'type: universal, axes: [[1, 2, 3], [2, 4, 6]]'
refuse "stiffness -8 is negative" \
    'type: spherical, state: caged, stiffness: -8'
refuse "'damping' is for a caged hinge, 'j' is free" \
    'type: hinge, axis: [0, 0, 1], damping: 1'
refuse "unknown joint type 'ball', there is fixed, hinge, slider, universal" \
    'type: ball'

# --- a second hinge beside the first, its axis off by little -------------------

# beside AXIS: a and b on two hinges about z, the second about AXIS.
beside() {
    scene "  - {name: clock, between: [a/p, b/p], type: hinge, axis: [0, 0, 1]}
  - {name: again, between: [a/p, b/p], type: hinge, axis: $1}
  - {name: mount, between: [b/p, c/p], type: fixed}" >beside.yaml
}

beside '[0, 0, 1]'
json 0 ritz-assemble beside.yaml -o beside.h5
holds '  two hinges about one axis leave a turn, without a warning' '
    j["warnings"] == [] and len(j["configurations"][0]["frequencies_hz"]) == 7'
for d in 1e-10 1e-8 1e-6 9e-5; do
    beside "[0, $d, 1]"
    json 0 ritz-assemble beside.yaml -o beside.h5
    holds "  so they do with an axis off by $d" "
        len(j['configurations'][0]['frequencies_hz']) == 7
        and len(j['warnings']) == ($d > 1e-9)
        and all('\'again\' is taken as [0, 0, 1]' in w for w in j['warnings'])"
    expect 0 '7 dofs' ritz-assemble beside.yaml --full -o full.h5
    expect 0 '16 rows of rank 11' ritz-simulate beside.yaml --seconds 0.1 \
        --step 0.01 --input torque=step --constraints index-2 -o time.h5
done
beside '[0, 0.001, 1]'
json 0 ritz-assemble beside.yaml -o beside.h5
holds '  an axis that is off by 1e-3 locks the turn, and this is said' '
    len(j["configurations"][0]["frequencies_hz"]) == 6 and
    "locks a motion of its loop, because it is off by 0.001 rad from [0, 0, 1]"
    in j["warnings"][0]'
beside '[0, 0.5, 1]'
json 0 ritz-assemble beside.yaml -o beside.h5
holds '  an axis of another direction is meant' '
    j["warnings"] == [] and len(j["configurations"][0]["frequencies_hz"]) == 6'

echo "1..$count"
