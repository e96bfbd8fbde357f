#!/bin/sh
# Coordinates of the bodies of a scene over time, from runs of every kind, and
# the motion of a mesh that is recovered from them.
# Usage: coordinates.sh FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"
python='/usr/bin/python3 -s' # two words: the user's own packages stay out

if ! $python -c 'import meshio, h5py, numpy' 2>/dev/null; then
    echo 'ok 1 - coordinates # skip python3-meshio or python3-h5py is missing'
    exit 0
fi

$python "$data/dualspin/stresses.py" "$data/dualspin/rotor.bdf" rows.mtx rows.txt
import_spacecraft --port boom=33 --recovery stress=rows.mtx \
    --recovery-rows stress=rows.txt
ritz-basis -q macneal-rubin --modes 12 --attach bearing,boom rotor.h5 -o basis.h5
ritz-reduce -q --estimates none --recovery acceleration rotor.h5 basis.h5 \
    -o small.h5
outputs='outputs:'
for c in 1 2 3; do
    outputs="$outputs
  - {name: x$c, at: rotor/boom, component: $c}
  - {name: v$c, at: rotor/boom, component: $c, quantity: velocity}
  - {name: a$c, at: rotor/boom, component: $c, quantity: acceleration}"
done
spacecraft plain 'band_hz: [0, 5]' 'inputs:' \
    '  - {name: motor, at: rotor/bearing, component: 6, against: stator/bearing}' \
    "$outputs"
sed 's|rotor: {model: rotor.h5.*}|rotor: {model: small.h5}|' plain.yaml >scene.yaml
ritz-assemble -q scene.yaml -o system.h5
drive='--seconds 0.4 --step 1e-3 --every 10 --input motor=sine:3'

# The displacement of grid 33 in the pictures NAME.xdmf, and the same over time
# from NAME.h5: S q, S q' and S q'' by T of the body and the rows of grid 33.
cat >same.py <<'END_PY'
import h5py, meshio, numpy, sys

def tip():
    with h5py.File("small.h5") as f:
        dofs = list(zip(f["dofs/grid"][:], f["dofs/component"][:]))
        rows = [dofs.index((33, c)) for c in (1, 2, 3)]
        return f["T"][:][rows]

def of_body(name):
    """q, q' and q'' of the rotor."""
    with h5py.File(name + ".h5") as f:
        all = [f["coordinates/" + k][:] for k in "qva"]
        if "blocks" in f:
            b = f["blocks/rotor"].attrs
            part = slice(b["first"], b["first"] + b["order"])
            return [x[:, part] for x in all], f["y"][:]
        with h5py.File("system.h5") as s:
            at = [c for c in s["configurations"].values()
                  if abs(c["settings"][0] - 90) < 1e-9][0]
            return [x @ at["blocks/rotor"][:].T for x in all], f["y"][:]

def pictured(name):
    with h5py.File("small.h5") as f:
        point = f["grids/position"][:][list(f["grids/id"][:]).index(33)]
    moved = []
    with meshio.xdmf.TimeSeriesReader(name + ".xdmf") as series:
        points, cells = series.read_points_cells()
        row = abs(points - point).max(axis=1).argmin()
        for k in range(series.num_steps):
            moved.append(series.read_data(k)[1]["displacement"][row])
    return numpy.array(moved)

def off(a, b):
    return (abs(a - b).max(axis=0) / abs(b).max(axis=0)).max()

name, limit = sys.argv[1], float(sys.argv[2])
states, y = of_body(name)
worst = [off(x @ tip().T, y[:, k::3]) for k, x in enumerate(states)]
seen = off(pictured(name), y[:, 0::3])
print(name, "q, q', q'' and pictures against outputs:", *worst, seen)
sys.exit(not (max(worst) < limit and seen < limit))
END_PY

# recovered NAME LIMIT WORDS...: NAME.h5 gives the outputs of its own run
recovered() {
    name=$1 limit=$2
    shift 2
    expect 0 "$1" ritz-recover "$name.h5" --component small.h5 --system system.h5 \
        --body rotor --at clock=90 --maxima "$name-maxima.h5" --to xdmf \
        -o "$name.xdmf"
    works "  the tip of '$name' moves as its outputs say" \
        $python same.py "$name" "$limit"
}

# differ A B LIMIT: the maxima of A and B, and of the tip's displacement over
# time, differ by at most LIMIT of the largest.
cat >differ.py <<'END_PY'
import h5py, numpy, sys
a, b = sys.argv[1:3]
def of(name):
    with h5py.File(name + "-maxima.h5") as f, h5py.File(name + ".h5") as s:
        return abs(f["quantities/stress/value"][:]), s["y"][:, 0::3]
off = [abs(x - y).max() / abs(y).max() for x, y in zip(of(a), of(b))]
print(a, b, "stress, displacement:", *off)
sys.exit(not max(off) <= float(sys.argv[3]))
END_PY

run() {
    name=$1
    shift
    # shellcheck disable=SC2086 # $drive is words
    expect 0 '' ritz-simulate -q $drive "$@" --coordinates -o "$name.h5"
}

# --- the eliminated system, and bodies that constraints hold ------------------

# outputs and coordinates are sums of the same terms, whose forces cancel in
# accelerations to 1e-3 and less
run joined scene.yaml --at clock=90 --method trapezoidal
recovered joined 1e-10 'by mode acceleration'
run none scene.yaml --at clock=90 --constraints none
recovered none 1e-10 'by mode acceleration'
# rounding in frequencies that are up to 1e3 times those of the output
works '  stresses are those of the eliminated system' \
    $python differ.py none joined 1e-9
run penalty scene.yaml --at clock=90 --constraints penalty:hz=800
recovered penalty 1e-10 'by mode acceleration'

json 0 ritz-info none.h5
holds '  the bodies are named' 'j["bodies"] == ["rotor", "stator", "platform"]'
expect 0 'blocks/rotor/order_full' ritz-info --members none.h5
expect 0 '' ritz-recover -q none.h5 --component small.h5 --body rotor \
    --table alone.tsv
ritz-recover -q none.h5 --component small.h5 --system system.h5 --body rotor \
    --table with.tsv
works '  no system is needed' sh -c \
    'grep -v "^#" alone.tsv >a && grep -v "^#" with.tsv | cmp - a'
expect 1 'coordinates of 3 bodies: of which one? name it by --body' ritz-recover \
    none.h5 --component small.h5 --table x.tsv
expect 1 "unknown body 'roter', is 'rotor' meant?" ritz-recover none.h5 \
    --component small.h5 --body roter --table x.tsv
expect 1 "'stator' has" ritz-recover none.h5 --component small.h5 --body stator \
    --table x.tsv
ritz-basis -q macneal-rubin --modes 11 --attach bearing,boom rotor.h5 -o other.h5
ritz-reduce -q --estimates none rotor.h5 other.h5 -o other-small.h5
expect 1 'rotor has 30 coordinates, the component 29' ritz-recover none.h5 \
    --component other-small.h5 --body rotor -o x.pvd
expect 2 '--system and --body belong together' ritz-recover joined.h5 \
    --component small.h5 --body rotor --table x.tsv

# --- a joint that moves -------------------------------------------------------

run cut scene.yaml --sweep clock=90:120:0.4s --sweep-modes 20
recovered cut 1e-10 'by mode acceleration'
run still scene.yaml --sweep clock=90:90.00001:0.4s --sweep-basis full
recovered still 1e-10 'by mode acceleration'
# 1e-5 degrees are 2e-7, which changes stresses by about as much
works '  a joint that hardly moves gives the stresses of one at rest' \
    $python differ.py still joined 1e-6
{ cat scene.yaml && echo 'select: {modes: [1, 2, 4]}'; } >few.yaml
run one few.yaml --sweep clock=90:120:0.4s --sweep-basis one
recovered one 1e-10 'by mode acceleration'

# The same with the rotor behind the joint that moves.
sed -n '/rotor:/p' scene.yaml >rotor.row
sed -e '/  rotor:/d' -e '/  platform:/r rotor.row' scene.yaml >behind.yaml
run behind behind.yaml --sweep clock=90:120:0.4s --sweep-modes 20
expect 0 'rotor                30 coordinates, turned by the joint' \
    ritz-info behind.h5
recovered behind 1e-10 'by mode displacement'
expect 1 'of a body that turns, here by the joint of --sweep' ritz-recover \
    behind.h5 --component small.h5 --body rotor --modes acceleration --table x.tsv

# --- vectors that are switched, and a controller ------------------------------

run exact scene.yaml --at clock=90
recovered exact 1e-10 'by mode acceleration'
run switched scene.yaml --at clock=90 --switched modes --switch-interval 1e-3 \
    --indicator 0.99999999
recovered switched 1e-10 'by mode acceleration'
# vectors that hold 1e-8 of |R|^2, 1e-4 of the forces, do not move; measured 8e-4
works '  stresses are those of the model, to what sets leave out' \
    $python differ.py switched exact 5e-3

/usr/bin/python3 -s - <<'END_PY'
import numpy, scipy.io
one = numpy.array([[1.0]])
scipy.io.savemat("law.mat", {"A": -10 * one, "B": one, "C": 10 * one, "D": 0 * one})
END_PY
ritz-import -q --state-space law.mat -o law.h5
run loop scene.yaml --at clock=90 --controller law.h5 --connect v3=u1 \
    --connect y1=motor --force
recovered loop 1e-10 'by mode acceleration'

# --- a scene that spins -------------------------------------------------------

{ grep -v '^damping' scene.yaml && echo 'spin: {axis: [0, 0, 1], rate: 0.5}'; } \
    >steady.yaml
{ grep -v '^damping' scene.yaml &&
    echo 'spin: {axis: [0, 0, 1], ramp: {to: 0.5, seconds: 0.4}}'; } >ramp.yaml
# The system of a rate that changes is that of the scene at rest.
for name in ramp steady; do
    run $name $name.yaml --at clock=90 --method trapezoidal
    expect 0 'spin           consistent' ritz-info $name.h5
    [ $name = ramp ] || ritz-assemble -q $name.yaml -o system.h5
    recovered $name 1e-10 'by mode displacement'
    expect 1 'of a body that turns, here by consistent' ritz-recover $name.h5 \
        --component small.h5 --system system.h5 --at clock=90 --body rotor \
        --modes acceleration --table x.tsv
done
run steady steady.yaml --at clock=90 --constraints baumgarte
recovered steady 1e-10 'by mode displacement'

# --- a run that is stopped and continued --------------------------------------

run="ritz-simulate scene.yaml --at clock=90 --input motor=sine:3 --seconds 200
    --step 1e-3 --every 20000 --constraints baumgarte --coordinates"
# shellcheck disable=SC2086
{
    expect 0 '' $run -q -o whole.h5
    expect 1 "the same command continues it from 'run.ck'" at_step INT \
        simulation $run --checkpoint run.ck -o stopped.h5
    expect 0 'stator               16 coordinates' ritz-info run.ck
    expect 0 'bodies' $run --checkpoint run.ck -o stopped.h5
}
works '  it has the values of an uninterrupted one' $python -c 'import h5py
with h5py.File("whole.h5") as a, h5py.File("stopped.h5") as b:
    for name in ("y", "coordinates/q", "coordinates/v", "coordinates/a",
                 "diagnostics/values"):
        assert a[name][:].tobytes() == b[name][:].tobytes(), name
    assert len(a["y"]) == 11 and a["blocks"].keys() == b["blocks"].keys()'

echo "1..$count"
