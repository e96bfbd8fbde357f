#!/bin/sh
# Charts of every kind, hostile names in all of them, and what is refused.
# Usage: chart.sh FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"
. "$here/svg.sh"

# --- usage and files that are none -------------------------------------------

expect 0 'from run records' ritz-chart --list
expect 2 "no chart 'parato', is 'pareto' meant?" ritz-chart parato x -o x.svg
expect 2 "--against takes 'reduce' or 'simulate'" ritz-chart pareto x \
    --against time -o x.svg
expect 2 "--error takes 'relative', 'decibels' or 'both', not 'dB'" \
    ritz-chart response x --error dB -o x.svg
expect 1 "cannot open 'none'" ritz-chart pareto none -o x.svg
: >empty
expect 1 "'empty' is empty" ritz-chart pareto empty -o x.svg
echo 'one two' >words
expect 1 "'words' is no container, no table of --tracks, no collection of" \
    ritz-chart report words -o x.html
printf '{"a":1}\n{"a":\n' >broken.jsonl
expect 1 "'broken.jsonl', line 2: no JSON" ritz-chart pareto broken.jsonl \
    -o x.svg
echo '{"tool":"ritz-basis","method":"m","order":3}' >bare.jsonl
expect 1 'no record has a method, an order and errors' ritz-chart convergence \
    bare.jsonl -o x.svg
expect 1 'no record has a method, an order and errors' ritz-chart report \
    bare.jsonl -o x.html
expect 1 'holds run records, not a table of tracks' ritz-chart tracks \
    bare.jsonl -o x.svg

# line METHOD ORDER ERROR MORE: a record
line() {
    printf '{"method":"%s","order":%s,"errors":{"response-relative":%s},' \
        "$1" "$2" "$3"
    printf '"seconds":{"cpu":%s.5}%s}\n' "$2" "${4-}"
}
line a 3 0.5 >plain.jsonl
line a 4 0.01 >>plain.jsonl
expect 1 "does not end in '.svg'" ritz-chart pareto plain.jsonl -o x.png
expect 1 "no record has an error 'mac', but " \
    ritz-chart pareto plain.jsonl --measure mac -o x.svg
echo '{"method":"a","order":3,"errors":{"mac":0.9}}' >timeless.jsonl
expect 1 'no record says what its model cost' ritz-chart pareto \
    timeless.jsonl -o x.svg
line a 3 0.5 ',"subject":"rotor"' >two.jsonl
line a 3 0.5 ',"subject":"stator"' >>two.jsonl
expect 1 "choose by --subject" ritz-chart pareto two.jsonl -o x.svg
expect 0 '' cat plain.jsonl
for left in x.*; do
    [ ! -e "$left" ] || { ls >log && report no 'nothing is left behind'; }
done
report yes 'nothing is left behind'

command -v gnuplot >/dev/null || {
    echo "1..$count"
    exit 0
}
if [ "$(command -v gnuplot)" != "$bin/gnuplot" ]; then
    expect 1 "gnuplot is not installed: 'x.svg.gp' is there to be drawn by" \
        env PATH="$bin" "$bin/ritz-chart" pareto plain.jsonl -o x.svg
    expect 1 'gnuplot is not installed' \
        env PATH="$bin" "$bin/ritz-chart" report plain.jsonl -o x.html
    works 'no half page' test ! -e x.html
fi

cat >mac.py <<'END'
rows = [line.split("\t") for line in open("mac.svg.tsv")][1:]
cell = {(r[0], r[1]): float(r[2]) for r in rows if len(r) == 4}
assert len(cell) > 20 and cell["0", "0"] > 0.9999
assert all(-1e-12 <= v <= 1 + 1e-12 for v in cell.values())
END

# --- records: hostile names, values that no logarithm shows -------------------

evil='x_{y}^2 @a &b ~c \\\\n <b onload=1> '"it's"' \"q\" `date` %s é'
{
    line "$evil" 2 0.5 ',"feasible":false'
    line "$evil" 4 0 ',"chosen":true,"why":"<script>alert(1)</script>"'
    line plain 3 1e-3 ',"runner_up":true,"subject":null'
    line plain 5 -1
    line plain 6 null
    line plain 7 1e-30
    line plain 8 1e30
} >runs.jsonl
for kind in pareto convergence; do
    expect 0 '' ritz-chart -q $kind runs.jsonl -o $kind.svg
    well $kind.svg
    expect 0 "&lt;b onload=1&gt;" cat $kind.svg
    expect 0 'stand at the foot. 1 is not known and left out' \
        cat $kind.svg
    expect 0 'chosen: x_{y}^2 @a' cat $kind.svg
    mv $kind.svg first.svg && mv $kind.svg.tsv first.tsv
    mv $kind.svg.gp first.gp
    expect 0 '' ritz-chart -q $kind runs.jsonl -o $kind.svg
    same "$kind has the same bytes again" first.svg $kind.svg
    same '  and its data' first.tsv $kind.svg.tsv
    same '  and its script' first.gp $kind.svg.gp
done
expect 0 'order	method' cat pareto.svg.tsv
i=0
while [ $i -lt 3000 ]; do
    i=$((i + 1))
    line "method$((i % 30))" $i "1e-$((1 + i % 7))"
done >many.jsonl
expect 0 '' ritz-chart -q pareto many.jsonl -o many.svg
expect 0 '' ritz-chart -q report runs.jsonl -o evil.html
expect 1 '' grep -F -e '<script>alert' -e '<b onload' evil.html
expect 0 'Why: &lt;script&gt;alert(1)&lt;/script&gt;' cat evil.html
evil_file="it's <i> & \$(x) \"q\" é.jsonl"
cp runs.jsonl "$evil_file"
expect 0 '' ritz-chart -q pareto "$evil_file" -o "it's <i> & é.svg"
well "it's <i> & é.svg"
expect 0 '' ritz-chart -q report "$evil_file" -o "it's <i> & é.html"
expect 1 '' grep -F -e "it's <i>" "it's <i> & é.html"

# --- lines of equal error, and the best at each order -------------------------

line a 3 0.2 >>plain.jsonl
line b 3 0.05 ',"tolerance":{"response-relative":0.003}' >>plain.jsonl
expect 0 '' ritz-chart -q pareto plain.jsonl -o levels.svg
expect 0 '' ritz-chart -q convergence plain.jsonl -o best.svg
for words in 'equal error' tolerance '10 %: model uncertainty'; do
    expect 0 ">$words</text>" cat levels.svg
done
expect 0 '' /usr/bin/python3 -s - <<'END'
import re
from words import words
said = words("levels.svg")
# decades from 1 to 1e-3 are as far apart as each other, and each says at its
# right end how much it is, as does the tolerance in between
at = {text: y for text, x, y, high in said}
step = [at[b] - at[a] for a, b in
        zip(["100 %", "10 %", "1 %"], ["10 %", "1 %", "0.1 %"])]
assert max(step) - min(step) < 0.5 and min(step) > 30, step
assert at["1 %"] < at["0.3 %"] < at["0.1 %"]
drawing = open("levels.svg").read()
line = [float(y) for a, y, b, z in re.findall(
    r"M([\d.]+),([\d.]+) L([\d.]+),([\d.]+)", drawing)
    if y == z and float(b) - float(a) > 300]
assert all(any(abs(y - at[w]) < 8 for y in line) for w in
           ("100 %", "10 %", "1 %", "0.1 %", "0.3 %")), line
rows = [r.split("\t") for r in open("best.svg.tsv").read().splitlines()]
best = [(r[3], r[4]) for r in rows if r[:3] == ["0", "0", "5"]]
assert best == [("3", "0.2"), ("4", "0.01")], best
END

# --- words that do not cover each other, and marks that are told apart 

i=0
while [ $i -lt 240 ]; do
    method=$((i % 20))
    order=$((3 + 3 * (i / 20)))
    more=''
    [ $i -ne 63 ] || more=',"chosen":true'
    [ $i -ne 64 ] || more=',"runner_up":true'
    line "method$method" $order "$((1 + i * 7 % 9))e-$((1 + order / 6))" \
        ',"tolerance":{"response-relative":0.003},"feasible":true'"$more"
    i=$((i + 1))
done | sed 's/"cpu":\([0-9]*\).5/"cpu":0.\1/' >dense.jsonl
for kind in pareto convergence; do
    expect 0 '' ritz-chart -q $kind dense.jsonl -o dense-$kind.svg
    expect 0 '' /usr/bin/python3 -s - $kind <<'END'
import re, sys
from words import words
said = [t for t, x, y, high in words(f"dense-{sys.argv[1]}.svg")]
assert "chosen: method3, 12" in said and "runner-up: method4, 12" in said, said
# orders stand beside the front, and in no other chart
orders = {t for t in said if re.fullmatch(r"18|24|36", t)}
assert bool(orders) == (sys.argv[1] == "pareto"), said
script = open(f"dense-{sys.argv[1]}.svg.gp").read()
sign = re.findall(r"points pt (\d+) ps 0.9 lw 1.6 lc rgb (c\d)", script)[:20]
assert len(set(sign)) == 20, sign
blue = [p for p, c in sign if c in ("c1", "c6")][:2]
assert blue[0] != blue[1]
END
done

# points of one method that hide each other are one: the lowest of a square
i=0
while [ $i -lt 900 ]; do
    i=$((i + 1))
    line crowd $((1000 + i % 30)) "0.01$((100 + i % 90))"
done >crowd.jsonl
line crowd 2000 1e-5 >>crowd.jsonl
expect 0 '' ritz-chart -q convergence crowd.jsonl -o crowd.svg
expect 0 '' /usr/bin/python3 -s - <<'END'
rows = [r.split("\t") for r in open("crowd.svg.tsv").read().splitlines()[1:]]
drawn = [(float(r[3]), float(r[4])) for r in rows if r[2:3] == ["0"]]
assert 2 <= len(drawn) < 30 and (2000.0, 1e-5) in drawn, drawn
assert min(y for x, y in drawn if x < 2000) == 0.011
END

# a name that gnuplot would run is a name
expect 0 '' ritz-chart -q pareto plain.jsonl -o '|touch ran;.svg'
expect 0 '' ritz-chart -q pareto plain.jsonl -o '< touch ran;.svg'
expect 0 '</svg>' cat '|touch ran;.svg'
well '|touch ran;.svg'
works 'no name of a picture is a command' test ! -e ran

# --- containers ---------------------------------------------------------------

expect 0 '' import_body stator --port bearing=1 --input 'a_b<&=1:6' \
    --output-at "it's {x}=5:6" -o stator.h5
expect 0 '' ritz-basis craig-bampton --modes 8 --attach bearing stator.h5 \
    -o basis.h5
expect 0 '' ritz-reduce stator.h5 basis.h5 -o reduced.h5
expect 0 '' ritz-frf --from-hz 1 --to-hz 40 --points 200 stator.h5 \
    --damping 'modal 0.01' -o full.h5
expect 0 '' ritz-frf --points-of full.h5 reduced.h5 --damping 'modal 0.01' \
    -o response.h5
expect 0 '' ritz-frf --from-hz 2 --to-hz 3 --points 7 reduced.h5 \
    --damping 'modal 0.01' -o apart.h5
expect 0 '' ritz-chart response full.h5 response.h5 -o response.svg
well response.svg
expect 0 "it's {x} / a_b&lt;&amp;: error at most" cat response.svg
expect 0 '' ritz-chart response full.h5 apart.h5 -o apart.svg
expect 0 "it's {x} / a_b&lt;&amp;</text>" cat apart.svg
expect 1 "no channel 'x': say OUTPUT/INPUT, such as 'it's {x}/a_b<&', or" \
    ritz-chart response full.h5 --channel x -o x.svg
expect 0 '' ritz-chart response full.h5 --channel "it's {x}/a_b<&" \
    -o channel.svg
expect 0 '' ritz-chart mac reduced.h5 stator.h5 -o mac.svg
well mac.svg
expect 0 '' /usr/bin/python3 -s mac.py
expect 0 '' ritz-chart mac basis.h5 stator.h5 -o basis.svg
expect 1 'MAC is of two models, this is one' ritz-chart mac stator.h5 -o x.svg
expect 0 '' ritz-rank -q reduced.h5 --damping 'modal 0.01' -o ranking.h5
expect 0 '' ritz-chart hankel ranking.h5 -o hankel.svg
well hankel.svg
expect 1 "'ranking.h5' holds a ranking, not a response" ritz-chart response \
    ranking.h5 -o x.svg
for kind in pareto convergence; do
    expect 1 "'response.h5' holds a response, not run records" \
        ritz-chart $kind response.h5 -o x.svg
done
expect 1 "'stator.h5' holds a component, not a table of tracks" \
    ritz-chart tracks stator.h5 -o x.svg

expect 0 '' ritz-simulate reduced.h5 --seconds 0.5 --input 'a_b<&=step' \
    --damping 'modal 0.01' -o run.h5
expect 0 '' ritz-simulate reduced.h5 --seconds 0.5 --input 'a_b<&=step' \
    --damping 'modal 0.01' --method trapezoidal --step 0.005 -o step.h5
expect 0 '' ritz-chart simulation run.h5 step.h5 -o simulation.svg
well simulation.svg
expect 0 'step.h5, trapezoidal' cat simulation.svg

# --- tracks -------------------------------------------------------------------

printf 'track\tconfiguration\tmode\thertz\tmac\n' | tee none.tsv >tracks.tsv
printf '1\tx=%s,<y>=1\t1\t%s\t%s\n' 0 1.5 nan 60 1.7 0.99 20 1.6 0.7 \
    >>tracks.tsv
expect 0 '' ritz-chart tracks tracks.tsv -o tracks.svg
well tracks.svg
expect 0 'MAC 0.700: hardly the same mode' cat tracks.svg
expect 1 "none.tsv: no mode is in it" ritz-chart tracks none.tsv -o x.svg
{ cat tracks.tsv && printf '1\ta\tb\n'; } >bad.tsv
expect 1 "bad.tsv: line 5 is no row of tracks" ritz-chart tracks bad.tsv \
    -o x.svg
expect 0 '' ritz-chart report runs.jsonl full.h5 response.h5 reduced.h5 \
    stator.h5 ranking.h5 tracks.tsv -o all.html
for words in 'Speed against accuracy' Convergence 'At equal order' \
    'At equal error' 'Which modes matter' 'Frequency responses' 'Mode shapes' \
    'Modes over configurations' "$(sha256sum full.h5 | cut -d' ' -f1)"; do
    expect 0 "$words" cat all.html
done
# the message names the file that the report cannot use
expect 0 '' ritz-rank --damping 'modal 0.01' stator.h5 -o values.h5
expect 1 "'values.h5': no mode has a value" ritz-chart report full.h5 \
    values.h5 response.h5 -o none.html
expect 1 "'values.h5': no mode has a value" ritz-chart hankel values.h5 \
    -o none.svg
expect 1 "'bare.jsonl': no record has a method" ritz-chart report full.h5 \
    bare.jsonl -o none.html
mv all.html before.html
expect 0 '' ritz-chart report runs.jsonl full.h5 response.h5 reduced.h5 \
    stator.h5 ranking.h5 tracks.tsv -o all.html
same 'a report has the same bytes again' before.html all.html
echo "1..$count"
