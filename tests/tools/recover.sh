#!/bin/sh
# recover.sh FOLDER-OF-THE-TOOLS - stresses of the rotor of data/dualspin from
# its reduced coordinates: against the full model, from files of simulators, as
# pictures, and within a system.
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"
python='/usr/bin/python3 -s' # two words: the user's own packages stay out

if ! $python -c 'import meshio, h5py, numpy' 2>/dev/null; then
    echo 'ok 1 - recovery # skip python3-meshio or python3-h5py is missing'
    exit 0
fi

works 'stress rows of the deck' $python "$data/dualspin/stresses.py" \
    "$data/dualspin/rotor.bdf" rows.mtx rows.txt
set -- --port bearing=1 --input push=4:1 --input torque=1:6 \
    --recovery stress=rows.mtx --recovery-rows stress=rows.txt --units 'kg m s'
expect 0 '475 rows of kind stress' import_body rotor "$@" -o rotor.h5
expect 0 '' import_body rotor -q "$@" --output-matrix rows.mtx -o full.h5
ritz-basis -q macneal-rubin --up-to-hz 20 --attach bearing rotor.h5 -o basis.h5
expect 0 'by mode acceleration too' ritz-reduce --estimates frequency \
    --recovery acceleration rotor.h5 basis.h5 -o small.h5
json 0 ritz-reduce --estimates none --recovery acceleration full.h5 basis.h5 \
    -o observed.h5
# rows of six digits cancel for rigid motion; the port holds all of it
holds '  no rigid motion is free' \
    'j["mode_accelerations"] == 1 and j["free_motions"] == 0'
json 0 ritz-reduce --estimates none --recovery acceleration --recovery-ports '' \
    rotor.h5 basis.h5 -o free.h5
holds '  six are, and stresses do not follow them' \
    'j["mode_accelerations"] == 1 and j["free_motions"] == 6
     and j["rigid_rows"] < 1e-5'

# --- rows as a matrix of the reduced coordinates -----------------------------------

expect 0 'stress  475 x' ritz-export --force --to matlab \
    --matrix K,stress small.h5 -o small.mat
works '  are those of the container' $python -c 'import h5py, scipy.io
rows = scipy.io.loadmat("small.mat")["stress"]
with h5py.File("small.h5") as file:
    names = []
    file.visit(names.append)
    same = [n for n in names if getattr(file[n], "shape", 0) == rows.shape
            and (file[n][:] == rows).all()]
assert same, names'
expect 1 "there is no matrix 'strain'" ritz-export --force --to matlab \
    --matrix strain small.h5 -o none.mat

# --- the full model's own response ------------------------------------------------

# Smooth loads, so that the response is within the band of the basis.
awk 'BEGIN { p = 3.14159265358979
    for (t = 0; t < 4.0005; t += 0.001)
        printf "%.3f %.17g\n", t,
            (t < 1 ? (1 - cos(p * t)) / 2 : 1) * sin(2 * p * 1.3 * t) }' >load
for name in full observed; do
    extra='--coordinates'
    [ $name = observed ] || extra='--up-to-hz 500'
    # shellcheck disable=SC2086
    expect 0 'time response' ritz-simulate --seconds 4 --step 0.002 $extra \
        --input push=load --input torque=load --damping 'modal 0.002' \
        $name.h5 -o $name-run.h5
done
ritz-verify -q --band-hz 0,10 --damping 'modal 0.002' full.h5 observed.h5 \
    -o verified.h5
ritz-frf -q --from-hz 0.01 --to-hz 10 --points 400 --damping 'modal 0.002' \
    full.h5 -o response.h5
for modes in displacement acceleration; do
    expect 0 "by mode $modes" ritz-recover observed-run.h5 \
        --component observed.h5 --modes $modes --every 7 -o $modes.pvd
done

# ritz-verify measured errors relative to the largest response to a unit force;
# here two forces of 1 act at once, so that the bound is twice that.
cat >compare.py <<'END_PY'
import h5py, meshio, numpy, random, sys
full = h5py.File("full-run.h5")
y, seconds = full["y"][:], full["seconds"][:]
H = h5py.File("response.h5")
largest = numpy.hypot(H["H/real"][:], H["H/imag"][:]).max()
errors = h5py.File("verified.h5")["errors"]
measured = dict(zip((e.decode() for e in errors["name"][:]), errors["value"][:]))
stated = 2 * measured["response-relative"] * largest
rows = [l.split() for l in open("rows.txt") if l[0] != "#"]
random.seed(1)
frames = random.sample(range(len(seconds) // 7), 40)
worst = {}
for modes in "displacement", "acceleration":
    worst[modes] = 0.0
    for k in frames:
        mesh = meshio.read(f"{modes}.frames/{k:06d}.vtu")
        cell = {int(e): i for i, e in
                enumerate(mesh.cell_data["element"][0].ravel())}
        found = numpy.array(
            [mesh.cell_data["stress " + w][0].ravel()[cell[int(e)]]
             for e, w in rows])
        worst[modes] = max(worst[modes], abs(found - y[7 * k]).max())
print(f"stated {stated:.4g}, largest {abs(y).max():.4g}: {worst}")
sys.exit(not (worst["acceleration"] <= stated
              and worst["displacement"] <= stated
              and worst["acceleration"] <= 0.01 * worst["displacement"]))
END_PY
works 'stresses are within the stated error of the response, and those by mode acceleration a hundredth of those by displacement' \
    $python compare.py
sed 's/^/# /' log

# --- maxima and pictures -----------------------------------------------------------

ritz-simulate -q --seconds 1 --step 0.01 --input push=sine:0.7 --coordinates \
    --damping 'modal 0.002' small.h5 -o run.h5
expect 0 '6 frames of xdmf' ritz-recover run.h5 --component small.h5 --every 20 \
    --table t.tsv --maxima m.h5 --to xdmf -o motion.xdmf
expect 0 'stress' ritz-info m.h5
cat >pictures.py <<'END_PY'
import h5py, meshio, numpy
with h5py.File("small.h5") as f, h5py.File("run.h5") as r, h5py.File("m.h5") as m:
    q, v, a, u = (r[k][:] for k in ("coordinates/q", "coordinates/v",
                                    "coordinates/a", "u"))
    s = f["quantities/stress"]
    assert (m["quantities/stress/place"][:] == s["place"][:]).all()
    table = [l.rstrip("\n").split("\t") for l in open("t.tsv") if l[0] != "#"]
    assert [float(t[3]) for t in table[1:]] == list(m["quantities/stress/value"][:])
    # by hand without damping, whose forces are a thousandth
    y = q @ s["Q"][:].T + a @ s["A"][:].T + u @ s["F"][:].T
    peak = abs(m["quantities/stress/value"][:])
    assert abs(peak - abs(y).max(0)).max() < 1e-2 * peak.max()
    T = f["T"][:]
    row = [i for i, (g, c) in enumerate(zip(f["dofs/grid"][:], f["dofs/component"][:]))
           if (g, c) == (29, 2)][0]  # the feed of the antenna, along y
    with meshio.xdmf.TimeSeriesReader("motion.xdmf") as series:
        points, cells = series.read_points_cells()
        assert sum(len(c) for c in cells) == 62
        for k in range(series.num_steps):
            t, point, cell = series.read_data(k)
            at = sorted(f["grids/id"][:]).index(29)
            assert abs(t - 0.2 * k) < 1e-12
            assert abs(point["displacement"][at, 1] - T[row] @ q[20 * k]) < 1e-15
            assert set(cell) == {"stress"} | {
                "stress " + w.decode() for w in s["part"][:]}
END_PY
works 'maxima, tables and pictures hold what the coordinates give' \
    $python pictures.py

if command -v gnuplot >/dev/null; then
    expect 0 '' ritz-chart motion acceleration.pvd -o shaken.svg
    works '  four times, with the colours of stresses' sh -c \
        'grep -q "2 s" shaken.svg && grep -q "|stress| 0 to" shaken.svg &&
         [ "$(sed 1d shaken.svg.tsv | grep -c "^3.0")" = 62 ]'
    cat >bands.py <<'END_PY'
import meshio, numpy, re
names = re.findall('file="([^"]*)"', open("acceleration.pvd").read())
frames = [names[(k + 1) * (len(names) - 1) // 4] for k in range(4)]
value = numpy.array([abs(meshio.read(f).cell_data["stress"][0].ravel())
                     for f in frames])
most = value.max()
due = 2 + numpy.digitize(value, [most / 64, most / 16, most / 4])
drawn = numpy.loadtxt("shaken.svg.tsv", skiprows=1)
for k in range(4):
    found = drawn[(drawn[:, 0] == k) & (drawn[:, 1] > 0), 1]
    assert (numpy.bincount(found.astype(int)) == numpy.bincount(due[k])).all()
words = [float(b) for b in re.findall(
    r"\|stress\| [^ ]* to ([^ <]*)<", open("shaken.svg").read())]
assert numpy.allclose(words, [most / 64, most / 16, most / 4, most], rtol=5e-3)
END_PY
    works '  bands of stress, each to four times the one before' \
        $python bands.py
    expect 0 '' ritz-chart report acceleration.pvd -o report.html
    expect 0 'Stresses in motion' cat report.html
    expect 1 'holds a collection of frames, not a time response' \
        ritz-chart simulation acceleration.pvd -o x.svg
    sed 's/000000/999999/' acceleration.pvd >lost.pvd
    sed -i 's/acceleration.frames/no.frames/' lost.pvd
    expect 1 'no.frames/' ritz-chart motion lost.pvd -o x.svg
fi

# --- files of simulators -----------------------------------------------------------

cat >write.py <<'END_PY'
import h5py
with h5py.File("run.h5") as r:
    t, q, v, a, u = (r[k][:] for k in ("seconds", "coordinates/q", "coordinates/v",
                                       "coordinates/a", "u"))
n = q.shape[1]
def put(name, head, rows):
    open(name, "w").write(head + "".join(rows))
number = lambda x: "%.17g" % x
put("exudyn.txt", "#Exudyn sensor\n", (
    ",".join(map(number, (t[k], *q[k], *v[k], *a[k]))) + "\n" for k in range(len(t))))
names = ["time"] + [f"{c}[{j + 1}]" for c in "qva" for j in range(n)] + ["push", "torque"]
put("fmpy.csv", ",".join(f'"{x}"' for x in names) + "\n", (
    ",".join(map(number, (t[k], *q[k], *v[k], *a[k], *u[k]))) + "\n"
    for k in range(len(t))))
put("body.mod", "", (
    "%8d.%d %s %s %s\n" % (5, j + 1, *map(number, (q[k, j], v[k, j], a[k, j])))
    for k in range(len(t)) for j in range(n)))
END_PY
works 'the same motion as simulators write it' $python write.py
rows_of() { grep -v '^#' "$1" >"$1.rows"; }
ritz-recover -q run.h5 --component small.h5 --modes displacement --table d.tsv
rows_of d.tsv
for file in exudyn.txt fmpy.csv body.mod; do
    expect 0 'by mode displacement' ritz-recover $file --component small.h5 \
        --step 0.01 --modes displacement --table $file.tsv
    rows_of $file.tsv
    [ $file = body.mod ] || same "  $file gives the same maxima" \
        $file.tsv.rows d.tsv.rows
done
# a file .mod counts its times, k * 0.01, which round otherwise
works '  body.mod gives the same maxima' $python -c '
a, b = ([l.split("\t") for l in open(f)][1:] for f in ("body.mod.tsv.rows", "d.tsv.rows"))
assert all(x[:4] == y[:4] and abs(float(x[4]) - float(y[4])) < 1e-12
           for x, y in zip(a, b)) and len(a) == len(b) == 475'
# other coordinates of the same motion: its modes, as an FMU has them, and those
# of a matrix; a floating frame leaves out rigid motion, which stresses do not
# follow
cat >turn.py <<'END_PY'
import h5py, numpy
with h5py.File("run.h5") as r, h5py.File("small.h5") as f:
    t, q = r["seconds"][:], r["coordinates/q"][:]
    rigid = sum(k == b"rigid" for k in f["columns/kind"][:])
    numpy.random.seed(3)
    V = numpy.linalg.qr(numpy.random.rand(34, 34))[0]
def put(name, x):
    with open(name, "w") as out:
        for k in range(len(t)):
            out.write(" ".join("%.17g" % y for y in (t[k], *x[k])) + "\n")
put("turned.txt", q @ V)
with open("V.mtx", "w") as out:
    out.write("%%MatrixMarket matrix array real general\n34 34\n")
    out.writelines("%.17g\n" % x for x in V.T.ravel())
put("floating.txt", q[:, rigid:])
END_PY
works 'the same in other coordinates' $python turn.py
for how in turned:V.mtx floating:floating; do
    expect 0 'by mode displacement' ritz-recover ${how%:*}.txt \
        --component small.h5 --transform ${how#*:} --table turned.tsv
    grep -v '^#' turned.tsv >turned.rows
    works "  $how gives the same maxima" $python -c '
a, b = ([l.split("\t") for l in open(f)][1:] for f in ("turned.rows", "d.tsv.rows"))
most = max(abs(float(y[3])) for y in b)
off = max(abs(abs(float(x[3])) - abs(float(y[3]))) for x, y in zip(a, b)) / most
print(off)
# rows follow rigid motion by rounding of the deck, axes of seven digits: 7e-6
# measured of the floating frame
assert off < 1e-4'
done
expect 1 'no real matrix of 34 rows' ritz-recover turned.txt --component \
    small.h5 --transform rows.mtx --table x.tsv
# damping is that of the model, none, where a table does not say it
expect 0 'by mode acceleration' ritz-recover fmpy.csv --component small.h5 \
    --damping 'modal 0.002' --table f.tsv
rows_of f.tsv && rows_of t.tsv
same '  and by mode acceleration, with its inputs' f.tsv.rows t.tsv.rows
expect 0 'by mode displacement' ritz-recover exudyn.txt --component small.h5 \
    --table e.tsv # it has no inputs
expect 1 'has no inputs, which '"'stress'"' needs for mode acceleration' \
    ritz-recover exudyn.txt --component small.h5 --modes acceleration \
    --table e.tsv
expect 0 'table' ritz-recover --list

# --- a body of a system ------------------------------------------------------------

expect 0 '' import_body stator -q --port bearing=1 --port scan=5 \
    --units 'kg m s' -o stator.h5
expect 0 '' import_body platform -q --port scan=1 --units 'kg m s' -o platform.h5
spacecraft scene 'inputs:' \
    '  - {name: torque, at: rotor/bearing, component: 6}'
sed 's|rotor: {model: rotor.h5.*}|rotor: {model: small.h5}|' scene.yaml >two.yaml
ritz-assemble -q --at clock=0 two.yaml -o system.h5
ritz-simulate -q --seconds 1 --step 0.01 --input torque=sine:1 --coordinates \
    system.h5 -o system-run.h5
expect 0 'by mode acceleration' ritz-recover system-run.h5 --component small.h5 \
    --system system.h5 --body rotor --maxima body.h5
cat >body.py <<'END_PY'
import h5py, numpy
with h5py.File("small.h5") as f, h5py.File("system-run.h5") as r, \
     h5py.File("body.h5") as m, h5py.File("system.h5") as s:
    P = s["configurations/0/blocks/rotor"][:]
    q, a = (r["coordinates/" + k][:] @ P.T for k in "qa")
    M = f["M"][:]
    squares, modes = numpy.linalg.eigh(
        numpy.linalg.solve(numpy.linalg.cholesky(M), numpy.linalg.solve(
            numpy.linalg.cholesky(M), f["K"][:]).T))
    modes = numpy.linalg.solve(numpy.linalg.cholesky(M).T, modes)
    kept = modes[:, squares <= (2 * numpy.pi * f["columns/hertz"][:][
        ~numpy.isnan(f["columns/hertz"][:])].max() * (1 + 1e-9)) ** 2]
    t = f["quantities/stress"]
    y = q @ t["Q"][:].T + (a @ (kept @ kept.T @ M).T) @ t["A"][:].T
    peak = abs(m["quantities/stress/value"][:])
    assert abs(peak - abs(y).max(0)).max() < 1e-9 * peak.max()
END_PY
works '  by the coordinates of the body, at whose ports the loads are' \
    $python body.py

# --- what is refused ---------------------------------------------------------------

expect 2 'of which component? name it by --component' ritz-recover run.h5 \
    --table t.tsv
expect 2 'give -o, --maxima or --table' ritz-recover run.h5 --component small.h5
expect 2 '--system and --body belong together' ritz-recover run.h5 \
    --component small.h5 --body rotor --table t.tsv
ritz-simulate -q --seconds 1 --step 0.01 --input push=sine:0.7 small.h5 -o bare.h5
expect 1 'has no coordinates: ritz-simulate --coordinates stores them' \
    ritz-recover bare.h5 --component small.h5 --table t.tsv
expect 1 'coordinates, the component 34' ritz-recover system-run.h5 \
    --component small.h5 --table t.tsv
ritz-reduce -q --estimates none --without-basis rotor.h5 basis.h5 -o bare-T.h5
expect 0 'by mode displacement' ritz-recover run.h5 --component bare-T.h5 \
    --table bare.tsv
expect 1 'reduced --without-basis' ritz-recover run.h5 --component bare-T.h5 \
    -o x.pvd
expect 1 'no quantity has mode acceleration' ritz-recover run.h5 \
    --component bare-T.h5 --modes acceleration --table x.tsv
ritz-basis -q normal-modes --modes 9 --attach '' small.h5 -o again.h5
expect 1 'was reduced before' ritz-reduce --recovery acceleration small.h5 \
    again.h5 -o x.h5
expect 2 '--recovery-ports are of' ritz-reduce --recovery-ports bearing \
    rotor.h5 basis.h5 -o x.h5
expect 0 'by mode acceleration too' ritz-reduce --estimates none small.h5 \
    again.h5 -o twice.h5
works '  no file is left' test ! -e x.pvd -a ! -e x.tsv -a ! -e x.frames

# --- interrupted -------------------------------------------------------------------

ritz-simulate -q --seconds 40 --step 0.001 --input push=sine:0.7 --coordinates \
    small.h5 -o long.h5
expect 1 'files that end in .interrupted' at_step INT times ritz-recover long.h5 \
    --component small.h5 --every 100 --table long.tsv -o long.pvd
works '  with what was done' test -s long.pvd.interrupted -a \
    -s long.tsv.interrupted -a ! -e long.pvd -a ! -e long.tsv
expect 0 '# interrupted: the history, after' cat long.tsv.interrupted

echo "1..$count"
