#!/bin/sh
# Rankings end to end, on data/dualspin and on the truss of data/truss72.
# Usage: rank.sh FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

# --- a system over its configurations ----------------------------------------

mkdir build
sed 's/0, 60, 120, 180, 240, 300/0, 60/' "$data/dualspin/scene.yaml" >scene.yaml
for name in rotor stator; do
    expect 0 '' import_body $name --port bearing=1 --port scan=5 \
        --units 'kg m s' -o build/$name.h5
done
expect 0 '' import_body platform --port scan=1 --units 'kg m s' \
    -o build/platform.h5
expect 0 '' ritz-assemble scene.yaml --tracks tracks.tsv -o system.h5

expect 0 'modes are followed by number' ritz-rank system.h5
works '  a blank line is between configurations' \
    sh -c "ritz-rank system.h5 | grep -qx '44 flexible modes of .*clock=60.*'"
expect 0 'modes are followed by track' ritz-rank system.h5 --tracks tracks.tsv \
    --by modal-cost --table all.tsv -o all.h5
expect 0 'modal-cost	clock=60,cone=0	modal 0.002	1	' cat all.tsv
json 0 ritz-rank system.h5 --by modal-cost
holds '  is the largest of both configurations, and says where' '
    len(j["rankings"]) == 2 and
    all(abs(j["values"][k]) == max(abs(r["values"][k]) for r in j["rankings"])
        for k in range(len(j["values"]))) and
    all(j["rankings"][["clock=0,cone=0", "clock=60,cone=0"].index(w)]
        ["values"][k] == j["values"][k] for k, w in enumerate(j["where"]))'
holds '  has costs that sum to H2 squared of each' '
    all(abs(sum(r["values"]) - r["total"]) < 1e-12 * r["total"]
        for r in j["rankings"])'
holds '  compares its configurations' '
    [(c["from"], c["to"]) for c in j["comparison"]] ==
        [("clock=0,cone=0", "clock=60,cone=0")] and
    0.5 < j["comparison"][0]["spearman"] < 1'
expect 0 '2 rankings' ritz-info all.h5
works '  and between files' \
    sh -c "ritz-info system.h5 all.h5 | grep -qx 'all.h5:'"
json 0 ritz-rank system.h5 --at clock=60 --by gregory -o gregory.h5
holds '  has the keys of before' 'j["by"] == "gregory" and
    sorted(j["order"]) == list(range(1, len(j["values"]) + 1)) and
    len(j["system_values"]) == 2 * len(j["values"]) and
    j["damping"] == "modal 0.002"'
holds '  says how far the exact values are' '0.01 < j["difference"] < 0.2'
expect 0 'values of single modes are rough there' ritz-rank system.h5 \
    --at clock=60 --by gregory

# --- which ranking, which damping --------------------------------------------

json 0 ritz-rank system.h5 --at clock=60 --top 6 \
    --by gregory,hankel,hankel-band,modal-cost,h2,participation
holds '  compares each ranking with the first' '
    [c["to"] for c in j["comparison"]] ==
        ["hankel", "hankel-band", "modal-cost", "h2", "participation"] and
    j["comparison"][0]["spearman"] == 1 and
    j["comparison"][2]["left"] == [1] and j["comparison"][2]["entered"] == [18]'
expect 0 'modal 0.002 to modal 0.3' ritz-rank system.h5 --at clock=60 \
    --damping 'modal 0.002' --damping 'modal 0.3'
expect 0 'Spearman 1.0000' ritz-rank system.h5 --at clock=60 \
    --damping 'modal 0.002' --damping 'modal 0.001' --by gregory
expect 0 '' ritz-rank -q system.h5 --at clock=60 --by h2 -o h2.h5
expect 0 'gregory.h5' ritz-rank --compare gregory.h5 h2.h5
expect 0 'Kendall' ritz-rank --compare all.h5 -o again.h5
expect 1 'holds one ranking: name another' ritz-rank --compare h2.h5
expect 1 "has none: modes cannot be matched" ritz-rank --compare all.h5 h2.h5

# --- weights -----------------------------------------------------------------

json 0 ritz-rank system.h5 --at clock=60 --by modal-cost \
    --output-weights gyro=4e6 --input-weights torque_rotor=9
cp log.json weighed.json
json 0 ritz-rank system.h5 --at clock=60 --by modal-cost
holds '  gives costs that weights multiply' '
    near(json.load(open("weighed.json"))["values"],
         [36 * v for v in j["values"]], 1e-12)'
expect 0 'Reweighting outputs for 5 modes settles' ritz-rank system.h5 \
    --at clock=60 --reweigh 5
expect 1 'weights are found at one configuration' ritz-rank system.h5 \
    --reweigh 5
expect 1 "there is no output 'gyr' to weigh, is 'gyro' meant?" \
    ritz-rank system.h5 --output-weights gyr=1
expect 1 "'x' is no weight of 'gyro'" ritz-rank system.h5 \
    --output-weights gyro=x

# --- mass --------------------------------------------------------------------

expect 1 'rigid modes carry all of the mass of a free model' \
    ritz-rank system.h5 --by effective-mass
expect 1 'a system has no interface to hold' \
    ritz-rank system.h5 --by effective-interface-mass
expect 0 '' ritz-basis craig-bampton --modes 20 --attach bearing build/rotor.h5 \
    -o basis.h5
expect 0 '' ritz-reduce build/rotor.h5 basis.h5 -o rotor.h5
json 0 ritz-rank rotor.h5 --by effective-interface-mass
holds '  ranks fixed-interface modes by shares of one' '
    len(j["values"]) == 20 and 0 < sum(j["values"]) < 1 and
    [p["name"] for p in j["parts"]] ==
        ["x", "y", "z", "about x", "about y", "about z"] and
    all(0 <= sum(p["values"]) < p["whole"] for p in j["parts"])'
expect 1 'has no damping' ritz-rank rotor.h5 --damping ''

# --- a chart -----------------------------------------------------------------

if command -v gnuplot >/dev/null; then
    expect 0 '' ritz-rank -q system.h5 --by modal-cost --chart chart.svg
    expect 0 '</svg>' cat chart.svg
    expect 0 'clock=60,cone=0' cat chart.svg.tsv
fi
gnuplot=$(command -v gnuplot || true)
if [ "$gnuplot" != "$bin/gnuplot" ]; then
    expect 1 "gnuplot is not installed: 'none.svg.gp' is there" \
        env PATH="$bin" "$bin/ritz-rank" -q system.h5 --chart none.svg
fi
expect 1 "does not end in '.svg'" ritz-rank -q system.h5 --chart chart.png

# --- what is not in modes ----------------------------------------------------

expect 0 '' ritz-import --stiffness "$data/truss72/truss72.k.mtx" \
    --mass "$data/truss72/truss72.m.mtx" --dofs "$data/truss72/truss72.dofs" \
    --input push=1:2 --output-at tip=36:2 -o truss.h5
json 0 ritz-rank truss.h5 --damping 'modal 0.02' -o values.h5
holds '  gives Hankel values of a component' 'j["order"] == [] and
    j["damping"] == "modal 0.02" and len(j["system_values"]) > 20 and
    all(a >= b for a, b in zip(j["system_values"], j["system_values"][1:]))'
expect 0 'Hankel value' ritz-info values.h5
expect 0 '' ritz-basis normal-modes --modes 69 --attach '' truss.h5 -o modes.h5
expect 0 '' ritz-reduce truss.h5 modes.h5 -o truss-modes.h5
cp log.json component.json
json 0 ritz-rank truss-modes.h5 --damping 'modal 0.02'
holds '  gives the same values by modes' 'near(
    [v / j["system_values"][0] for v in j["system_values"]],
    [v / j["system_values"][0]
     for v in json.load(open("component.json"))["system_values"]
              [:len(j["system_values"])]], 1e-8)'
expect 0 '' ritz-basis lanczos-one-sided --modes 8 --damping 'modal 0.02' \
    truss.h5 -o states.h5
expect 1 'nothing else ranks it' ritz-rank truss.h5 --by gregory

# --- state spaces: 1/(s + 1) and 3/(s + 2) apart ---------------------------------

array A.mtx '2 2' -1 0 0 -2
array B.mtx '2 2' 1 0 0 3
array C.mtx '2 2' 1 0 0 1
expect 0 '' ritz-import --state-space A=A.mtx,B=B.mtx,C=C.mtx -o space.h5
json 0 ritz-rank space.h5
holds '  has the values of its two halves' \
    'near(j["system_values"], [0.75, 0.5], 1e-14)'
expect 1 'it has Hankel values, and nothing else ranks it' ritz-rank space.h5 --by gregory

# --- usage -------------------------------------------------------------------

expect 2 "no ranking 'modalcost', is 'modal-cost' meant?" \
    ritz-rank system.h5 --by gregory,modalcost
expect 2 'takes rankings as they are' ritz-rank --compare all.h5 --at clock=0
expect 2 'one model is ranked' ritz-rank system.h5 rotor.h5
expect 1 'no configuration is at' ritz-rank system.h5 --at clock=61
expect 1 'it is no table of tracks' ritz-rank system.h5 --tracks all.tsv
