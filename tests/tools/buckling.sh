#!/bin/sh
# buckling.sh FOLDER-OF-THE-TOOLS - geometric stiffness of a column through the
# chain, and the loads at which it buckles.
. "$(dirname "$0")/tap.sh"

column() { /usr/bin/python3 -s "$here/column.py" "$@"; }
import_column() {
    ritz-import -q --stiffness K.mtx --mass M.mtx --dofs dofs \
        --bulk column.bdf --geometric-stiffness tip.mtx@tip \
        --geometric-stiffness spin.mtx@spin_zz "$@"
}

works 'a column is made' column 12
expect 0 '' import_column --port end=13:126 -o column.h5
json 0 ritz-check column.h5
holds '  it buckles at a quarter of pi^2' '
    abs([c["value"] for c in j["checks"] if c["name"] == "buckling:tip"][0]
        - 2.4674021) < 5e-8'
holds '  but not if it is pulled' '
    [c["value"] for c in j["checks"]
     if c["name"] in ("buckling-reversed:tip", "buckling:spin_zz")] == 2 * [None]'
expect 0 'K + 2.4674021 KG is singular' ritz-check column.h5
expect 0 'make deflections 2.55 times as large' ritz-check column.h5 \
    --load tip=1.5
expect 1 'buckling-applied' ritz-check column.h5 --load tip=2.5
expect 0 'stiffen it' ritz-check column.h5 --load spin_zz=5
expect 0 '' ritz-check -q column.h5 --load tip=2.5 --load spin_zz=9

# --- a load that always acts --------------------------------------------------

# A cantilever under a push P = k^2 at its end bends by (tan k - k) / (P k) under
# a unit force across it [TimoshenkoGere1961].
expect 0 'the stiffness is that under load tip=1.5' ritz-import \
    --stiffness K.mtx --mass M.mtx --dofs dofs --bulk column.bdf \
    --geometric-stiffness tip.mtx@tip --input push=13:2 --output-at see=13:2 \
    --preload tip=1.5 -o pressed.h5
json 0 ritz-check pressed.h5
holds '  it buckles under what is left to the buckling load' '
    abs([c["value"] for c in j["checks"] if c["name"] == "buckling:tip"][0]
        - 0.9674021) < 5e-8'
works 'its response' ritz-frf -q pressed.h5 --from-hz 1e-6 --to-hz 1e-5 \
    --points 2 --no-refine --damping 'modal 0.01' -o response.h5
works 'its states, balanced' ritz-basis -q balanced --modes 12 \
    --damping 'modal 0.01' pressed.h5 -o balanced.h5
expect 0 'geometric stiffness of 1 load is left out' ritz-reduce pressed.h5 \
    balanced.h5 -o states.h5
works '  and their response' ritz-frf -q states.h5 --from-hz 1e-6 --to-hz 1e-5 \
    --points 2 --no-refine -o of-states.h5
works 'its run in time' ritz-simulate -q pressed.h5 --up-to-hz 1e6 \
    --input push=step --damping 'modal 0.7' --seconds 60 --step 0.1 -o run.h5
works '  all bend as a column that is pushed' /usr/bin/python3 -s - <<'END'
import math
import h5py
k = math.sqrt(1.5)
exact = (math.tan(k) - k) / (k * k * k)
found = [h5py.File(f"{name}.h5")["H/real"][0].ravel()[0]
         for name in ("response", "of-states")]
found.append(h5py.File("run.h5")["y"][-1, 0])
# twelve Hermite elements err by 1e-6; balanced states by their bound
assert all(abs(x / exact - 1) < tolerance
           for x, tolerance in zip(found, (3e-6, 1e-4, 3e-6))), (found, exact)
END
for wrong in wind=1 tip tip=nan; do
    expect 1 'ritz-import: --preload: ' import_column --preload $wrong -o no.h5
done
expect 1 "load 'tip' is given twice" import_column --preload tip=1 \
    --preload tip=2 -o no.h5
expect 1 'needs the geometric stiffness' ritz-import --stiffness K.mtx \
    --mass M.mtx --dofs dofs --preload tip=1 -o no.h5
expect 0 '' import_column --preload tip=2.5 -o buckled.h5
expect 1 'stiffness-definite' ritz-check buckled.h5

# --- files that are not what they should be -----------------------------------

works 'odd files are made' /usr/bin/python3 -s - <<'END'
lines = open("tip.mtx").read().splitlines()
head, size, entries = lines[0], lines[1], [l.split() for l in lines[2:]]
n, count = int(size.split()[0]), len(entries)
def put(name, head, size, entries):
    with open(name, "w") as file:
        print(head, size, *map(" ".join, entries), sep="\n", file=file)
put("zero.mtx", head, f"{n} {n} 0", [])
short = [e for e in entries if max(map(int, e[:2])) <= n - 3]
put("short.mtx", head, f"{n - 3} {n - 3} {len(short)}", short)
put("nan.mtx", head, size, entries[:-1] + [entries[-1][:2] + ["nan"]])
off = [e for e in entries if e[0] != e[1]][:1]
both = [e for e in entries if e[0] == e[1]] + off
put("lopsided.mtx", head.replace("symmetric", "general"),
    f"{n} {n} {len(both)}", both)
put("seven.mtx", head, size,
    [e[:2] + [f"{float(e[2]):.6e}"] for e in entries])
END
bare() {
    ritz-import -q --stiffness K.mtx --mass M.mtx --dofs dofs \
        --bulk column.bdf "$@"
}
expect 1 'has 33 rows' bare --geometric-stiffness short.mtx@x -o no.h5
expect 1 'the value is not finite' bare --geometric-stiffness nan.mtx@x -o no.h5
expect 1 'unsymmetric by' bare --geometric-stiffness lopsided.mtx@x -o no.h5
expect 1 "there are two loads 'x'" bare --geometric-stiffness tip.mtx@x \
    --geometric-stiffness spin.mtx@x -o no.h5
expect 1 "holds '/'" bare --geometric-stiffness tip.mtx@a/b -o no.h5
expect 0 '' bare --geometric-stiffness zero.mtx@nothing \
    --geometric-stiffness 'tip.mtx@wind from the left' \
    --geometric-stiffness seven.mtx@rounded -o odd.h5
json 0 ritz-check odd.h5 --load 'wind from the left=1.5'
holds '  nothing, names with blanks and seven digits are taken' '
    (lambda c: c["buckling:nothing"] is None
     and c["buckling-reversed:nothing"] is None
     and abs(c["buckling:wind from the left"] - 2.4674021) < 5e-8
     and abs(c["buckling:rounded"] - 2.4674021) < 1e-4)(
        {c["name"]: c["value"] for c in j["checks"]})'

# --- a reduced column ----------------------------------------------------------

ritz-basis -q craig-bampton --modes 6 column.h5 -o basis.h5
expect 0 '' ritz-reduce -q column.h5 basis.h5 -o small.h5
json 0 ritz-check small.h5
holds '  the factor of a reduced column is a little higher' '
    0 <= [c["value"] for c in j["checks"]
          if c["name"] == "buckling:tip"][0] - 2.4674021 < 1e-5'
expect 1 'buckling-applied' ritz-check small.h5 --load tip=2.5
expect 1 "there is no geometric stiffness of a load 'wind'" ritz-check \
    small.h5 --load wind=1
expect 1 "'tip' is not of the form NAME=X" ritz-check small.h5 --load tip

json 0 ritz-verify column.h5 small.h5 -o checked.h5
holds '  factors of both models are compared' '
    [b["load"] for b in j["buckling"]] == ["tip", "spin_zz"] and
    abs(j["buckling"][0]["full"] - 2.4674021) < 5e-8 and
    0 <= j["buckling"][0]["reduced"] - j["buckling"][0]["full"] < 1e-5 and
    j["buckling"][0]["full_reversed"] is None and
    abs(j["buckling"][1]["full_reversed"] + 10.243361021) < 1e-7'
expect 0 "buckling factor of load 'tip': 2.4674 full, 2.46741 reduced" \
    ritz-verify column.h5 small.h5 -o checked.h5

# If KG = K in a component, KG = K in all that is made of it: by every method
# that projects, in a system of two bodies, its second stage and its full model.
expect 0 '' ritz-import -q --stiffness K.mtx --mass M.mtx --dofs dofs \
    --bulk column.bdf --geometric-stiffness K.mtx@all --port end=13:126 \
    --input push=13:2 --output-at see=13:2 -o all.h5
for method in craig-bampton full guyan inertia-relief irs krylov \
    krylov-cms-fixed krylov-cms-free macneal-rubin normal-modes rubin serep; do
    case $method in
    guyan | full | irs) how= ;;
    serep) how='--modes 3' ;;
    *) how='--modes 4' ;;
    esac
    # shellcheck disable=SC2086 # words
    works "a basis by $method" ritz-basis -q $method $how all.h5 -o b.h5
    works "is reduced" ritz-reduce -q all.h5 b.h5 -o "all-$method.h5"
    works "and keeps KG = K" column alike "all-$method.h5"
done
ritz-basis -q balanced --modes 8 --damping 'modal 0.01' all.h5 -o b.h5
expect 0 'geometric stiffness of 1 load is left out: a state space' \
    ritz-reduce all.h5 b.h5 -o states.h5

cat >pair.yaml <<'END'
scene: two columns, tip to tip
components:
  left: {model: all.h5, basis: craig-bampton, modes: 3}
  right: {model: all.h5, basis: craig-bampton, modes: 3}
joints:
  - {name: middle, type: fixed, between: [left/end, right/end]}
band_hz: [0, 3]
select: {by: band}
END
expect 0 '' ritz-assemble -q pair.yaml -o pair.h5
expect 0 '' ritz-assemble -q --full pair.yaml -o whole.h5
expect 0 '' ritz-compare -q pair.yaml --components compared- -o second.h5
works 'systems and their bodies keep KG = K' column alike pair.h5 whole.h5 \
    second.h5 compared-left.h5 compared-right.h5
expect 0 'buckling:left:all' ritz-check pair.h5
expect 0 '' ritz-verify -q all.h5 all-craig-bampton.h5 -o verified.h5
expect 0 '' ritz-fit -q all.h5 --tolerance frequency=1e-2 --band-hz 0,3 \
    -o fitted.h5
works 'verified and fitted ones too' column alike verified.h5 fitted.h5

works 'a free column is made' column 12 free
expect 0 '' import_column --port end=13:126 -o free.h5
expect 0 'not computed: a motion is free' ritz-check free.h5

echo "1..$count"
