#!/bin/sh
# Tests of the tools as a user meets them: exit status, words, files.
# Usage: tools.sh FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

# --- models whose every number is known --------------------------------------

# The axial bar: E A = rho A = 1, length 1, n elements, consistent mass, free.
bar() {
    awk -v n="$1" -v what="$2" 'BEGIN {
        h = 1 / n
        d = what == "K" ? 1 / h : h / 3
        o = what == "K" ? -1 / h : h / 6
        print "%%MatrixMarket matrix coordinate real symmetric"
        print n + 1, n + 1, 2 * n + 1
        for (i = 1; i <= n + 1; i++) {
            printf "%d %d %.17g\n", i, i, (i == 1 || i == n + 1) ? d : 2 * d
            if (i <= n) printf "%d %d %.17g\n", i + 1, i, o
        }
    }'
}
bar 20 K >bar.k.mtx
bar 20 M >bar.m.mtx
awk 'BEGIN { for (i = 1; i <= 21; i++) print i, 1 }' >bar.dofs
awk 'BEGIN { for (i = 1; i <= 21; i++)
    printf "GRID,%d,,%.17g,0.,0.\n", i, (i - 1) / 20 }' >bar.bdf

# Two bodies of mass 1 and inertia 1 at one place, a spring for each direction:
# its frequencies are sqrt(2 k) / 2 pi.
pair() {
    echo '%%MatrixMarket matrix coordinate real symmetric'
    echo '12 12 18'
    i=0
    for k in "$@"; do
        i=$((i + 1))
        echo "$i $i $k"
        echo "$((i + 6)) $((i + 6)) $k"
        echo "$((i + 6)) $i -$k"
    done
}
pair 100 400 900 1600 2500 3600 >a.k.mtx
pair 200 300 700 1100 1300 1700 >b.k.mtx
awk 'BEGIN { print "%%MatrixMarket matrix coordinate real symmetric"
    print 12, 12, 12; for (i = 1; i <= 12; i++) print i, i, 1 }' >one.m.mtx
printf 'GRID,1,,0.,0.,0.\nGRID,2,,0.,0.,0.\n' >pair.bdf
cat >scene.yaml <<'END'
scene: two pairs on a hinge
components:
  a: {model: a.h5, basis: craig-bampton, modes: 6}
  b: {model: b.h5, basis: craig-bampton, modes: 6, attach: [near]}
joints:
  - {name: clock, between: [a/far, b/near], type: hinge, axis: [0, 0, 1], angles_deg: [0, 90]}
inputs: [{name: torque, at: a/far, component: 6}, {name: push, at: a/far, component: 1}]
outputs: [{name: gyro, at: b/near, component: 6}, {name: drift, at: b/near, component: 1}, {name: side, at: b/near, component: 2}]
band_hz: [0, 10]
damping: {modal: 0.002}
select: {by: hankel, tolerance: 1.0e-2}
END

# --- what every tool has --------------------------------------------------------

tools='import info check basis reduce assemble rank compare frf poles verify export'
expect 0 'frequency response' ritz
expect 0 'ritz (Ritz) ' ritz --version
expect 2 "no tool 'chek', is 'check' meant?" ritz chek
expect 0 'Usage: ritz-basis' ritz help basis
for tool in $tools; do
    expect 0 "  $tool " ritz --help
    expect 0 "ritz-$tool (Ritz) " ritz "$tool" --version
    expect 0 'Usage: ritz-' "ritz-$tool" --help
    expect 0 '--record FILE' "ritz-$tool" -h
    expect 2 "unknown option 'jsom', is 'json' meant?" "ritz-$tool" --jsom
    expect 2 "no argument goes with '--json'" "ritz-$tool" --json=1
    expect 2 "unknown option '-k'" "ritz-$tool" -qk
    expect 2 "no argument to '--record'" "ritz-$tool" --record
    expect 1 'cannot write to standard output' \
        sh -c "ritz-$tool --help >/dev/full"
done
for tool in check reduce assemble rank compare frf poles verify; do
    expect 2 'expected' "ritz-$tool" -o x.h5
done
expect 0 'craig-bampton' ritz-basis --list
expect 0 'gregory' ritz-rank --list
expect 0 'matrix-market' ritz-export --list

# --- import, info, check --------------------------------------------------------

expect 0 'bar.h5' ritz-import --stiffness bar.k.mtx --mass bar.m.mtx \
    --bulk bar.bdf --dofs bar.dofs --port left=1:1 --port right=21:1 \
    --input push=21:1 --output-at tip=21:1@0.5 --units 'm kg s' -o bar.h5
cp bar.h5 first.h5
expect 0 '' ritz-import --stiffness bar.k.mtx --mass bar.m.mtx \
    --bulk bar.bdf --dofs bar.dofs --port left=1:1 --port right=21:1 \
    --input push=21:1 --output-at tip=21:1@0.5 --units 'm kg s' -o bar.h5
same 'the same run gives the same bytes' bar.h5 first.h5
expect 2 'nothing to import' ritz-import -o x.h5
expect 2 'name it with -o' ritz-import --mass bar.m.mtx
expect 2 "'bar.m.mtx' is no option" ritz-import bar.m.mtx -o x.h5
expect 1 "none.mtx" ritz-import --mass none.mtx -o x.h5
expect 1 'not FILE@LOAD' ritz-import --mass bar.m.mtx \
    --geometric-stiffness bar.k.mtx -o x.h5
json 1 ritz-import --mass none.mtx -o x.h5
holds '  and says why' '"none.mtx" in j["error"]'
for body in a b; do
    expect 0 '12 dofs' ritz-import --stiffness $body.k.mtx --mass one.m.mtx \
        --bulk pair.bdf --port near=1 --port far=2 -o $body.h5
done

json 0 ritz-info bar.h5
holds '  says what is in a component' 'j["kind"] == "component" and
    j["dofs"] == 21 and j["ports"] == ["left", "right"] and
    j["inputs"] == ["push"] and j["outputs"] == ["tip"] and
    j["units"] == "m kg s" and set(j["checksums"]) >= {"K", "M"}'
json 0 ritz-info bar.k.mtx
holds '  gives a file and its container one checksum' \
    'j["checksums"][""] == json.loads(__import__("subprocess").check_output(
        ["ritz-info", "--json", "bar.h5"]))["checksums"]["K"]'
holds '  says what is in a matrix file' 'j["matrices"][0]["rows"] == 21 and
    j["matrices"][0]["symmetric"] and j["matrices"][0]["asymmetry"] == 0'
json 0 ritz-info bar.bdf bar.m.mtx
holds '  knows bulk data' 'j["files"][0]["grids"] == 21 and
    len(j["files"]) == 2'
expect 0 "'m kg s'" ritz-info bar.h5
expect 0 'made by' ritz-info bar.h5 -o info.txt
same '  -o keeps what was printed' log info.txt
expect 1 'none.h5' ritz-info none.h5
expect 1 'that Ritz knows' ritz-info bar.dofs
expect 1 'is a folder' ritz-info .
: >empty
expect 1 'empty' ritz-info empty
expect 2 'FILE...' ritz-info

expect 0 ' 0 fail' ritz-check a.h5
json 0 ritz-check a.h5
holds '  has a verdict for each check' 'len(j["checks"]) > 5 and all(
    c["verdict"] in ("pass", "warn", "fail") for c in j["checks"])'
expect 1 'scene.yaml' ritz-check scene.yaml

# --- basis, reduce, verify ------------------------------------------------------

expect 0 '7 columns for 21 dofs' ritz-basis craig-bampton --modes 5 bar.h5 \
    -o cb.h5
json 0 ritz-basis craig-bampton --modes 5 bar.h5 -o cb2.h5
holds '  finds the frequencies of the clamped bar' 'near(j["frequencies_hz"],
    [math.sqrt(2400 * (1 - math.cos(k * math.pi / 20)) /
     (2 + math.cos(k * math.pi / 20))) / (2 * math.pi) for k in range(1, 6)],
    1e-9)'
holds '  with small residuals' 'len(j["residuals"]) == 5 and
    max(j["residuals"]) < 1e-9 and j["vectors"] == 7'
expect 0 '2 constraint' ritz-basis guyan bar.h5 --output guyan.h5
expect 0 '2 constraint' ritz-basis guyan --memory 1.5GiB bar.h5 -o limited.h5
expect 1 'are allowed (--memory)' ritz-basis guyan --memory 1K bar.h5 -o not.h5
expect 2 "'22X' is no size such as 500M or 22G" ritz-basis guyan --memory 22X \
    bar.h5 -o not.h5
for tool in assemble check compare fit frf poles rank reduce simulate verify; do
    expect 2 "'22X' is no size" "ritz-$tool" --memory 22X bar.h5 bar.h5 -o not.h5
done
expect 0 '1 constraint' ritz-basis guyan --attach left bar.h5 -o one.h5
expect 2 "no method 'guyam', is 'guyan' meant?" ritz-basis guyam bar.h5 -o x.h5
expect 0 '7 columns for 21 dofs' ritz-basis craig-bampton --modes 5 --count no \
    --engine lanczos bar.h5 -o uncounted.h5
expect 0 'modes 5 engine lanczos count no' ritz-info uncounted.h5
expect 0 'modes 5 accuracy' ritz-basis craig-bampton --modes 5 \
    --accuracy 1e-4 bar.h5 -o accurate.h5
expect 2 'with an accuracy the engines are auto, lanczos and amls' ritz-basis \
    craig-bampton --modes 5 --accuracy 1e-4 --engine slices bar.h5 -o x.h5
expect 2 "'3' is no accuracy of modes from 1e-8 to 1e-2" ritz-basis \
    craig-bampton --modes 5 --accuracy 3 bar.h5 -o x.h5
expect 2 "guyan has no 'accuracy' to choose" ritz-basis guyan --accuracy 1e-4 \
    bar.h5 -o x.h5
expect 2 'its engines are auto, lanczos, arpack, slices, amls and slepc' ritz-basis \
    craig-bampton --modes 5 --engine modal bar.h5 -o x.h5
expect 2 'its engines are auto, dense, modal, low-rank and projection' \
    ritz-basis balanced \
    --modes 5 --engine arpack bar.h5 -o x.h5
expect 2 "guyan has no 'count' to choose" ritz-basis guyan --count no bar.h5 \
    -o x.h5
expect 2 'whole number' ritz-basis craig-bampton --modes 2.5 bar.h5 -o x.h5
expect 2 'from 0 to 100000' ritz-basis craig-bampton --modes -1 bar.h5 -o x.h5
expect 2 'METHOD COMPONENT' ritz-basis bar.h5 -o x.h5
expect 2 '--help' ritz-basis craig-bampton --modes 3 --up-to-hz 5 bar.h5 -o x
expect 2 'a frequency: --modes or --up-to-hz' ritz-basis craig-bampton bar.h5 \
    -o x.h5
expect 1 "'top'" ritz-basis guyan --attach left,top bar.h5 -o x.h5
expect 1 'a basis, not a component' ritz-basis guyan cb.h5 -o x.h5
expect 1 'not a regular file' ritz-basis guyan bar.h5 -o .
expect 1 'none/x.h5' ritz-basis guyan bar.h5 -o none/x.h5

expect 0 '7 coordinates for 21 dofs' ritz-reduce bar.h5 cb.h5 -o red.h5
expect 0 '' ritz-reduce bar.h5 cb.h5 --without-basis -o small.h5
json 0 ritz-reduce bar.h5 cb.h5 -o red.h5
holds '  estimates its errors' 'len(j["estimates"]) > 0 and j["dofs"] == 7 and
    j["dofs_full"] == 21 and j["frequencies_hz"][0] == 0'

# geometric stiffness goes with K and M
expect 0 'geometric stiffness of 1 load is stored' ritz-import \
    --stiffness bar.k.mtx --mass bar.m.mtx --bulk bar.bdf --dofs bar.dofs \
    --port left=1:1 --input push=21:1 --output-at tip=21:1 --units 'm kg s' \
    --geometric-stiffness bar.k.mtx@spin -o stiff.h5
expect 0 '' ritz-basis craig-bampton --modes 5 stiff.h5 -o stiff-cb.h5
expect 0 '' ritz-reduce stiff.h5 stiff-cb.h5 -o stiff-red.h5
expect 0 'KG/spin' ritz-info stiff-red.h5
printf 'scene: a bar\ncomponents:\n  bar: {model: stiff.h5, %s}\n' \
    'basis: craig-bampton, modes: 2, attach: [left]' >stiff.yaml
expect 0 '' ritz-assemble stiff.yaml -o stiff-system.h5
expect 0 'bar:spin, geometric stiffness' ritz-info stiff-system.h5
expect 0 '' ritz-assemble --full stiff.yaml -o stiff-full.h5
expect 0 'KG/bar:spin' ritz-info stiff-full.h5
json 0 ritz-reduce bar.h5 cb.h5 -o red.h5
holds '  nothing is said where there is none' 'j["warnings"] == []'
expect 1 'is a basis for 21 dofs' ritz-reduce a.h5 cb.h5 -o x.h5
expect 1 'a component, not a basis' ritz-reduce bar.h5 bar.h5 -o x.h5

expect 0 'pass' ritz-verify bar.h5 red.h5 --damping 'modal 0.01' \
    --band-hz 0,2 --limit-frequency 0.02 -o checked.h5
expect 1 'limits not met' ritz-verify bar.h5 red.h5 --damping 'modal 0.01' \
    --band-hz 0,2 --limit-frequency 1e-15 -o failed.h5
json 0 ritz-info failed.h5
holds '  the file says that it failed' \
    'any(m["verdict"] == "fail" for m in j["errors"])'
expect 0 '' ritz-basis guyan a.h5 -o a-cb.h5
expect 0 '' ritz-reduce a.h5 a-cb.h5 -o a-red.h5
expect 1 "a limit of 'response-relative' needs inputs and outputs" \
    ritz-verify a.h5 a-red.h5 --limit-response 0.1 -o none.h5
expect 0 "--limit-mac: nothing of 'red.h5' is there to be compared" \
    ritz-verify bar.h5 red.h5 --band-hz 1e-4,2e-4 --limit-mac 0.9 -o checked.h5
expect 2 'two ascending numbers' ritz-verify bar.h5 red.h5 --band-hz 2,1 -o x
expect 2 'from 0 to 1,' ritz-verify bar.h5 red.h5 --limit-mac 2 -o x.h5
expect 1 'has nothing to choose from' \
    ritz-verify bar.h5 red.h5 --at clock=0 -o x.h5
expect 1 'damping' ritz-verify bar.h5 red.h5 --damping 'viscous 3' -o x.h5

# --- scenes -----------------------------------------------------------------------

# Joined, each direction is a chain of masses 1, 2, 1 and springs p, q:
# lambda^2 - 3/2 (p + q) lambda + 2 p q = 0; about the hinge the pairs turn
# by themselves. At 90 degrees x of one pair lies along y of the other.
cat >chain.py <<'END'
def chain(p, q):
    s, d = 0.75 * (p + q), (0.5625 * (p + q) ** 2 - 2 * p * q) ** 0.5
    return [s - d, s + d]
def hertz(a, b):
    roots = [2 * a[5], 2 * b[5]]
    for p, q in zip(a[:5], b[:5]):
        roots += chain(p, q)
    return [0.0] * 7 + sorted(r ** 0.5 / 6.283185307179586 for r in roots)
a, b = (100, 400, 900, 1600, 2500, 3600), (200, 300, 700, 1100, 1300, 1700)
turned = (300, 200, 700, 1300, 1100, 1700)
END
json 0 ritz-assemble scene.yaml -o system.h5
holds '  gives the frequencies of the chains at both angles' '
    exec(open("chain.py").read()) or
    [c["at"] for c in j["configurations"]] == ["clock=0", "clock=90"] and
    near(j["configurations"][0]["frequencies_hz"], hertz(a, b), 1e-7) and
    near(j["configurations"][1]["frequencies_hz"], hertz(a, turned), 1e-7)'
expect 0 'clock=90' ritz-assemble scene.yaml --at clock=90 -o at90.h5
expect 0 'component' ritz-assemble scene.yaml --full --at clock=90 -o full.h5
expect 1 'clok' ritz-assemble scene.yaml --at clok=90 -o x.h5
expect 1 'none.yaml' ritz-assemble none.yaml -o x.h5
sed 's/modes: 6,/modez: 6,/' scene.yaml >typo.yaml
expect 1 'typo.yaml:4:' ritz-assemble typo.yaml -o x.h5

expect 0 'stage 2' ritz-compare scene.yaml --components small- \
    --report report.txt -o both.h5
same '  --report keeps what was printed' log report.txt
expect 0 'errors measured by ritz-compare:' ritz-export --to output4 \
    --force small-a.h5 -o small.op4
expect 0 'these are errors of stage two against stage one alone' \
    ritz-export --to output4 --force small-a.h5 -o small.op4
json 0 ritz-export --to output4 --force small-a.h5 -o small.op4
holds '  in JSON too' 'j["errors_against"] == "stage-1"'
expect 0 '' ritz-verify a.h5 small-a.h5 --band-hz 0,2 -o small-verified.h5
json 0 ritz-export --to output4 --force small-verified.h5 -o small.op4
holds '  and not once they are measured' 'j["errors_against"] == "full" and
    not any("stage" in w for w in j["warnings"])'
json 0 ritz-compare scene.yaml -o both2.h5
holds '  keeps the modes that it says' 'len(j["kept"]) == 2 and
    [c["stage1"] for c in j["components"]] == [12, 12] and
    all(c["errors"]["frequency"] < 1e-9 for c in j["configurations"]
        if c["listed"])'

expect 0 'damping modal 0.002' ritz-rank at90.h5 --by gregory
json 0 ritz-rank system.h5 --at clock=0 --by hankel -o ranking.h5
holds '  orders all flexible modes' \
    'sorted(j["order"]) == list(range(1, len(j["values"]) + 1)) and
     len(j["system_values"]) == 2 * len(j["values"])'
expect 2 "no ranking 'gregori', is 'gregory' meant?" \
    ritz-rank system.h5 --by gregori
expect 0 'Largest over 2 configurations' ritz-rank system.h5
expect 1 'not a component or a reduced component' ritz-rank ranking.h5

sed 's/by: hankel/by: hankle/' scene.yaml >by.yaml
expect 1 "by.yaml:11:14: there is no ranking 'hankle', is 'hankel' meant" \
    ritz-compare by.yaml -o x.h5

expect 0 '' ritz-import --stiffness b.k.mtx --mass one.m.mtx --bulk pair.bdf \
    --port near=1 --port far=2 --units 'kg mm s' -o mm.h5
sed 's/b.h5/mm.h5/' scene.yaml >mm.yaml
for full in '' --full; do
    # shellcheck disable=SC2086 # a word or none
    expect 1 "'b' in 'kg mm s'" ritz-assemble $full --at clock=0 mm.yaml -o x.h5
done

# Joints in a loop must meet, and agree.
printf 'GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\n' >long.bdf
expect 0 '' ritz-import --stiffness a.k.mtx --mass one.m.mtx --bulk long.bdf \
    --port near=1 --port far=2 -o long.h5
loop() {
    cat <<END
scene: a loop
components: {a: {model: a.h5, basis: craig-bampton, modes: 6}, b: {model: $1.h5, basis: craig-bampton, modes: 6}}
joints:
  - {name: first, between: [a/far, b/near], type: hinge, axis: [0, 0, 1], angles_deg: [90]}
  - {name: second, between: [a/near, b/far], type: hinge, axis: [0, 0, 1], angles_deg: [$2]}
END
}
loop b 90 >loop.yaml
expect 0 'system' ritz-assemble loop.yaml -o loop.h5
loop b 60 >loop.yaml
expect 1 "'second': closes a loop of joints whose angles do not agree" \
    ritz-assemble loop.yaml -o x.h5
loop long 90 >loop.yaml
expect 1 "'a/near' and 'b/far' stand 1 apart" ritz-assemble loop.yaml -o x.h5

# --- responses, export ------------------------------------------------------------

expect 0 'modal response' ritz-frf system.h5 --at clock=90 -o h.h5
expect 0 'direct response' ritz-frf full.h5 --to-hz 10 --method direct \
    --damping 'rayleigh 0.01 1e-5' --points 20 -o hd.h5
expect 0 'modal response' ritz-frf full.h5 --to-hz 10 --points 20 \
    --damping 'modal 0.002' -o hm.h5
expect 1 'give --to-hz' ritz-frf red.h5 -o x.h5
expect 1 'is for components' ritz-frf red.h5 --to-hz 2 --method direct -o x.h5
expect 2 "no method 'dirct', is 'direct' meant?" \
    ritz-frf bar.h5 --method dirct --to-hz 2 -o x.h5
expect 1 'lies above --to-hz' ritz-frf red.h5 --from-hz 3 --to-hz 2 -o x.h5

expect 0 'measured by ritz-verify' ritz-export checked.h5 --to output4 -o r.op4
expect 0 'not verified' ritz-export red.h5 --to output4 --text -o rt.op4
expect 0 'OUTPUT4' ritz-info r.op4 rt.op4
expect 0 '' ritz-export red.h5 --to matrix-market --matrix K -o r.mtx
expect 0 '' ritz-export h.h5 --to tsv -o h.tsv
expect 1 'not a response' ritz-export red.h5 --to tsv -o x.tsv
expect 2 "no format 'outptu4', is 'output4' meant?" \
    ritz-export red.h5 --to outptu4 -o x
expect 2 'exudyn has no matrices to choose' \
    ritz-export red.h5 --to exudyn --matrix K -o x
expect 2 'tsv has no body in a moving frame' \
    ritz-export h.h5 --to tsv --frame centre -o x
expect 2 'tsv has no body in a moving frame' \
    ritz-export h.h5 --to tsv --reference tangent -o x
expect 2 'tsv has one way of writing' ritz-export h.h5 --to tsv --digits 5 -o x
expect 1 "'K' is named twice" \
    ritz-export red.h5 --to output4 --matrix K,K --force -o x
expect 2 'name it with --to' ritz-export red.h5 -o x
/usr/bin/python3 -s - <<'END'
import h5py, shutil
shutil.copy("red.h5", "bare.h5")
with h5py.File("bare.h5", "a") as f:
    if "estimates" in f:
        del f["estimates"]
END
expect 1 'neither estimated nor measured' \
    ritz-export bare.h5 --to output4 -o x.op4
expect 0 'nothing is known of the errors' \
    ritz-export bare.h5 --to output4 --force -o bare.op4

# --- records, quiet, interruption ---------------------------------------------------

ids=
for i in 1 2 3 4 5 6 7 8; do
    ritz-basis craig-bampton --modes $i bar.h5 -q -o p$i.h5 \
        --record runs.jsonl &
    ids="$ids $!"
done
for id in $ids; do
    wait "$id"
done
/usr/bin/python3 -s - >log.json <<'END'
import json
print(json.dumps([json.loads(line) for line in open("runs.jsonl")]))
END
holds 'eight tools at once append eight whole records' 'len(j) == 8 and
    sorted(r["order"] for r in j) == [3, 4, 5, 6, 7, 8, 9, 10] and
    all(r["ok"] and r["method"] == "craig-bampton" and
        r["peak_bytes"] > 0 and r["seconds"]["wall"] > 0 and
        {"start", "reading", "writing"} <= set(r["phases"]) and
        r["inputs"][0].endswith("  bar.h5") and "residual" in r["errors"]
        for r in j)'
expect 1 'cannot open' ritz-info bar.h5 --record none/runs.jsonl
ritz-basis guyan bar.h5 -q -o p1.h5 >log 2>&1
[ ! -s log ] && report yes '--quiet says nothing' || report no '--quiet'

json 1 ritz-info bar.h5 --record none/runs.jsonl
holds '  says that the record failed' '"none/runs.jsonl" in j["error"]'
expect 1 'none.h5' ritz-info none.h5 --record none/runs.jsonl
expect 0 '' sh -c 'ritz-basis guyan bar.h5 -q -o p1.h5 >&-'
expect 1 'cannot write to standard output' \
    sh -c 'ritz-basis guyan bar.h5 -o p1.h5 >&-'
expect 1 'is the disk full?' \
    sh -c 'ulimit -f 2; ritz-basis craig-bampton --modes 9 bar.h5 -o x.h5'
expect 0 'units          N/mm' sh -c 'ritz-import -q --mass bar.m.mtx --dofs bar.dofs \
    --units N/mm -o p1.h5 && ritz-info p1.h5'
expect 1 'the name of a port cannot' ritz-import --mass bar.m.mtx \
    --dofs bar.dofs --port a,b=1:1 -o x.h5
expect 1 'is not UTF-8' ritz-import --mass bar.m.mtx \
    --dofs bar.dofs --port "$(printf 'a\377')=1:1" -o x.h5
expect 0 'a mass alone' sh -c 'ritz-import -q --mass bar.m.mtx \
    --dofs bar.dofs --port near=1:1 -o mass.h5 &&
    ritz-basis -q macneal-rubin --modes 2 mass.h5 -o mass-basis.h5 &&
    ritz-reduce -q mass.h5 mass-basis.h5 -o mass-red.h5 &&
    ritz-verify -q mass.h5 mass-red.h5 -o mass-ver.h5 && echo a mass alone'
ln -s p1.h5 link.h5
ritz-basis guyan bar.h5 -q -o link.h5
ritz-basis guyan bar.h5 -q -o link.h5
works 'an output that is a link stays one' test -L link.h5

# --- names with escape sequences ----------------------------------------------

# Escape sequences in a file's name and among its values are printed as '?' and
# kept as they are in JSON: a file from elsewhere must not control a terminal.
works 'no control character of a file leaves a tool' \
    /usr/bin/python3 -s - <<'END'
import json, h5py, numpy, shutil, subprocess, sys
evil = "a\x1b]0;title\x07b\x9b2J\x7f\rc"
shutil.copy("bar.h5", evil + ".h5")
with h5py.File(evil + ".h5", "r+") as file:
    file.attrs["units"] = numpy.bytes_(evil.encode())
def run(*command):
    return subprocess.run(command, capture_output=True)
bad = [b"\x1b", b"\x07", b"\x7f", b"\r", "\x9b".encode()]
made = run("ritz-basis", "guyan", evil + ".h5", "-o", "evil.h5",
           "--record", "evil.jsonl")
texts = {
    "a basis": made.stdout + made.stderr,
    "info": run("ritz-info", evil + ".h5", "evil.h5").stdout,
    "json": run("ritz-info", "--json", "evil.h5").stdout,
    "a record": open("evil.jsonl", "rb").read(),
    "a refusal": run("ritz-info", evil).stderr,
    "an option": run("ritz-info", "--" + evil).stderr,
    "a verb": run("ritz", evil).stderr,
    "too many": run("ritz-claims", "--record").stderr +
                run("ritz-assemble", evil, evil).stderr,
}
run("ritz-info", evil + ".h5", "-o", "evil.txt")
texts["a report"] = open("evil.txt", "rb").read()
wrong = [name for name, text in texts.items()
         if not text or any(c in text for c in bad)]
inputs = json.loads(texts["a record"])["inputs"]
if not any(evil + ".h5" in name for name in inputs):
    wrong.append(f"not kept in JSON: {inputs}")
sys.exit(", ".join(wrong) if wrong else 0)
END
rm -f evil* a*c.h5

# A bar so large that the tool is still busy when the signal comes.
bar 20000 K >big.k.mtx
bar 20000 M >big.m.mtx
awk 'BEGIN { for (i = 1; i <= 20001; i++) print i, 1 }' >big.dofs
ritz-import -q --stiffness big.k.mtx --mass big.m.mtx --dofs big.dofs \
    --port all=1-13000:1 -o big.h5
for ends in 130:INT 143:TERM 129:HUP; do
    expect "${ends%:*}" eigenvectors at_step "${ends#*:}" eigenvectors \
        ritz-basis craig-bampton --modes 400 --attach '' big.h5 -o big-basis.h5
done

# The tool gets a signal while it writes. This is tried again until the signal
# comes when the temporary file exists.
for number in TERM XCPU PIPE ABRT; do
    works "a tool that SIG$number ends while it writes leaves no file" \
        sh -c \
        'ulimit -c 0; exec /usr/bin/python3 -s - "$1"' - "SIG$number" <<'END'
import glob, os, signal, subprocess, sys, time
number = signal.Signals[sys.argv[1]]
signal.signal(signal.SIGPIPE, signal.SIG_DFL)
for attempt in range(50):
    if os.path.exists("big.out"):
        os.remove("big.out") # the signal before came too late
    run = subprocess.Popen(["ritz-import", "-q", "--stiffness", "big.k.mtx",
                            "--mass", "big.m.mtx", "--dofs", "big.dofs",
                            "-o", "big.out"])
    while run.poll() is None and not glob.glob("big.out.*.part"):
        time.sleep(1e-3)
    run.send_signal(number)
    if run.wait(30) == -number:
        break
left = glob.glob("big.out*")
sys.exit(0 if run.returncode == -number and not left
         else f"ended with {run.returncode}, left {left}")
END
done

# A killed run cannot remove its draft; the next run removes this draft and no
# other.
works 'a killed run leaves a draft, which the next run removes' \
    /usr/bin/python3 -s - <<'END'
import glob, os, signal, subprocess, sys, time
tool = ["ritz-import", "-q", "--stiffness", "big.k.mtx", "--mass", "big.m.mtx",
        "--dofs", "big.dofs", "-o", "big.out"]
for attempt in range(50):
    run = subprocess.Popen(tool)
    while run.poll() is None and not glob.glob("big.out.*.part"):
        time.sleep(1e-3)
    run.kill()
    run.wait(30)
    left = glob.glob("big.out.*.part")
    if left:
        break
open("other.out.1-0.part", "w").close()
subprocess.run(tool, check=True)
after = glob.glob("*.part")
os.remove("big.out")
os.remove("other.out.1-0.part")
sys.exit(0 if left and after == ["other.out.1-0.part"]
         else f"left {left}, then {after}")
END
works 'parallel runs of one target remove no draft of each other' \
    sh -c 'for k in 1 2 3 4; do
        for i in 1 2 3 4 5; do ritz-basis -q guyan bar.h5 -o same.h5 || exit 1
        done & p="$p $!"; done; for k in $p; do wait "$k" || exit 1; done
    rm same.h5'

# --- the demo's model --------------------------------------------------------------

expect 0 'OUTPUT4' ritz-info "$data/dualspin/rotor.op4"
expect 0 '246 x 246 symmetric' ritz-info --directory "$data/dualspin/rotor.op4"
import_body stator -q --port bearing=1 -o stator.h5
# far below what rounding makes of rigid modes
expect 0 '6 rigid, 6 residual' \
    ritz-basis macneal-rubin --up-to-hz 1e-8 stator.h5 -o stator-basis.h5

ls -A | grep -E '\.part|^x|^core' >log && report no 'no leftovers' ||
    report yes 'no leftovers'
printf '1..%d\n' "$count"
