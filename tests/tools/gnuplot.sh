#!/bin/sh
# How tools run gnuplot: names are text and never commands, a user's settings
# have no effect, and gnuplot ends with the tool that started it.
# Usage: gnuplot.sh FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"
. "$here/svg.sh"

command -v gnuplot >/dev/null || {
    echo '1..0 # SKIP gnuplot is not installed'
    exit 0
}

# Names that gnuplot, a shell, printf, markup or a terminal could interpret;
# none has a slash, which would make it a path.
cat >names.py <<'END_OF_NAMES'
names = ["|touch ran;", "<touch ran;", "`touch ran`", "$(touch ran)",
         "x';system('touch ran');y='", "'first", "two''quotes", "'''", '"q',
         "a\\b\\n\\", "@{}^_~a", "%s%n%d%%", "a&b<c>d", "]]>", "a]]>b",
         "&#x0;&#x41;", "&&&&&&&&", "!touch ran", "# x", "é\u20ac\U0001f600"]
bytes_ = [b"new\nline", b"tab\tand\rreturn", b"\x01\x1b[31m\x7f", b"\xff\xfe",
          b"\xed\xa0\x80", b"\xef\xbf\xbe", b"\xc0\xafa", b"\xc2\x85",
          b"a\xe2\x82"]
END_OF_NAMES

cat >inside.py <<'END_OF_INSIDE'
"""Pictures on a page are XML, and names add no markup to it."""
import re, sys, xml.etree.ElementTree as xml
page = open(sys.argv[1], encoding="utf-8").read()
body = page[page.index("<body"):]
found = re.findall(r"<svg class=\"picture\".*?</svg>", body, re.S)
assert len(found) >= int(sys.argv[2]), len(found)
for picture in found:
    for node in xml.fromstring(picture).iter():
        assert not node.tag.endswith("script")
        assert not any(k.startswith("on") for k in node.attrib)
assert page.count("<script>") == 1
END_OF_INSIDE

line() {
    printf '{"method":"%s","order":%s,"errors":{"response-relative":%s},' \
        "$1" "$2" "$3"
    printf '"seconds":{"cpu":%s.5}}\n' "$2"
}
line a 3 0.5 >plain.jsonl
line b 4 0.01 >>plain.jsonl

# --- names of pictures --------------------------------------------------------

cat >pictures.py <<'END_OF_PICTURES'
import os, subprocess, sys, xml.etree.ElementTree as xml
from names import names, bytes_
for name in [n.encode() for n in names] + bytes_:
    path = name + b".svg"
    run = subprocess.run([b"ritz-chart", b"-q", b"pareto", b"plain.jsonl",
                          b"-o", path], capture_output=True)
    assert run.returncode == 0 and not run.stderr, (name, run.stderr)
    xml.parse(open(path, "rb"))
    # the script that is kept draws the same file again
    os.remove(path)
    run = subprocess.run([b"gnuplot", b"-d", b"./" + path + b".gp"],
                         capture_output=True)
    assert run.returncode == 0 and not run.stderr, (name, run.stderr)
    assert os.path.getsize(path) > 1000, name
    for end in b"", b".tsv", b".gp":
        os.remove(path + end)
    report = name + b".html"
    run = subprocess.run([b"ritz-chart", b"-q", b"report", b"plain.jsonl",
                          b"-o", report], capture_output=True)
    assert run.returncode == 0 and not run.stderr, (name, run.stderr)
    os.remove(report)
    assert not os.path.exists("ran"), name
    assert not any(b"part" in n for n in os.listdir(b".")), name
END_OF_PICTURES
expect 0 '' /usr/bin/python3 -s pictures.py

# --- names in pictures --------------------------------------------------------

cat >records.py <<'END_OF_RECORDS'
import json
from names import names
with open("evil.jsonl", "w") as out:
    for k, name in enumerate(names):
        for order in 2 + k, 30 + k:
            print(json.dumps({"method": name, "order": order, "errors": {
                "response-relative": 10.0 ** -(1 + k % 5), "]]>\t\n'": 0.1},
                "tolerance": {"response-relative": 0.003}, "chosen": k == 3,
                "seconds": {"cpu": 0.5 + order}, "why": name,
                "command": name}), file=out)
END_OF_RECORDS
cat >drawn.py <<'END_OF_DRAWN'
"""Each name appears unchanged in the legend or the title."""
import sys, xml.etree.ElementTree as xml
from names import names
text = ["".join(node.itertext()) for node in xml.parse(sys.argv[1]).iter()
        if node.tag.endswith("text")]
wanted = names if len(sys.argv) < 3 else sys.argv[2:]
for name in wanted:
    # gnuplot writes a space as a non-breaking space
    assert any(name.strip() in t.replace("\u00a0", " ") for t in text), \
        (name, text)
END_OF_DRAWN
/usr/bin/python3 -s records.py
for kind in pareto convergence; do
    expect 0 '' ritz-chart -q $kind evil.jsonl -o $kind.svg
    well $kind.svg
    expect 0 '' /usr/bin/python3 -s drawn.py $kind.svg
done
# each point of the front is labelled with its order, whatever its method is
# called
{
    line '\"' 2 0.5
    line '\"' 40 0.001
} >quote.jsonl
expect 0 '' ritz-chart -q pareto quote.jsonl -o quote.svg
expect 0 '' /usr/bin/python3 -s drawn.py quote.svg 2 40
expect 0 '' ritz-chart -q report evil.jsonl -o evil.html
expect 0 '' /usr/bin/python3 -s inside.py evil.html 2

evil="it''s \"]]>\" &#x0; %s \`touch ran\`\\"
expect 0 '' import_body stator --port bearing=1 --input "$evil=1:6" \
    --output-at "'$evil=5:6" -o stator.h5
expect 0 '' ritz-basis craig-bampton --modes 8 --attach bearing stator.h5 \
    -o basis.h5
expect 0 '' ritz-reduce stator.h5 basis.h5 -o reduced.h5
expect 0 '' ritz-frf --from-hz 1 --to-hz 40 --points 50 stator.h5 \
    --damping 'modal 0.01' -o full.h5
expect 0 '' ritz-frf --points-of full.h5 reduced.h5 --damping 'modal 0.01' \
    -o response.h5
expect 0 '' ritz-rank -q reduced.h5 --damping 'modal 0.01' -o ranking.h5 \
    --chart "rank $evil.svg"
well "rank $evil.svg"
expect 0 '' ritz-simulate reduced.h5 --seconds 0.5 --input "$evil=step" \
    --damping 'modal 0.01' -o run.h5
printf 'track\tconfiguration\tmode\thertz\tmac\n' >tracks.tsv
printf '1\t%s\t1\t%s\t%s\n' '"]]>&#x0;=0' 1.5 nan '"]]>&#x0;=1' 1.7 0.99 \
    >>tracks.tsv
for name in full response ranking reduced stator run; do
    mv $name.h5 "$name $evil.h5"
done
mv tracks.tsv "tracks $evil.tsv"
expect 0 '' ritz-chart response "full $evil.h5" "response $evil.h5" \
    -o response.svg
expect 0 '' /usr/bin/python3 -s drawn.py response.svg "full $evil.h5" "'$evil"
expect 0 '' ritz-chart hankel "ranking $evil.h5" -o hankel.svg
expect 0 '' ritz-chart mac "reduced $evil.h5" "stator $evil.h5" -o mac.svg
expect 0 '' /usr/bin/python3 -s drawn.py mac.svg "reduced $evil.h5"
expect 0 '' ritz-chart simulation "run $evil.h5" -o simulation.svg
expect 0 '' /usr/bin/python3 -s drawn.py simulation.svg "'$evil"
expect 0 '' ritz-chart tracks "tracks $evil.tsv" -o tracks.svg
expect 0 '' /usr/bin/python3 -s drawn.py tracks.svg '"]]>&#x0;'
for kind in response hankel mac simulation tracks; do
    well $kind.svg
done
expect 0 '' ritz-chart report evil.jsonl "full $evil.h5" "response $evil.h5" \
    "ranking $evil.h5" "reduced $evil.h5" "stator $evil.h5" "run $evil.h5" \
    "tracks $evil.tsv" -o all.html
expect 0 '' /usr/bin/python3 -s inside.py all.html 7
works 'no name was a command' test ! -e ran

# --- settings of a user -------------------------------------------------------

mkdir home
printf 'set title "mine"\nset terminal dumb\nset grid\nset logscale x\n' \
    >home/.gnuplot
ritz-chart -q pareto plain.jsonl -o plain.svg
mv plain.svg first.svg
expect 0 '' env HOME="$dir/home" ritz-chart -q pareto plain.jsonl -o plain.svg
same 'settings of a user do not change a picture' first.svg plain.svg
gnuplot -d plain.svg.gp && mv plain.svg first.svg
HOME="$dir/home" gnuplot plain.svg.gp
same '  and without -d neither do they when it is drawn again' first.svg \
    plain.svg

# --- the end of the tool ------------------------------------------------------

mkdir slow
printf '#!/bin/sh\necho $$ >gnuplot.pid\nexec sleep 300\n' >slow/gnuplot
chmod +x slow/gnuplot
cat >end.py <<'END_OF_END'
"""A slow gnuplot ends when a signal ends the tool."""
import os, signal, subprocess, sys, time

def state(pid):
    try:
        with open(f"/proc/{pid}/stat") as file:
            return file.read().rpartition(")")[2].split()[0]
    except FileNotFoundError:
        return ""

def until(what):
    for k in range(2000):
        if what():
            return
        time.sleep(0.01)
    sys.exit("it took longer than 20 s")

def pid_of():
    try:
        return int(open("gnuplot.pid").read())
    except (FileNotFoundError, ValueError):
        return 0

os.environ["PATH"] = os.path.abspath("slow") + ":" + os.environ["PATH"]
kinds = ([["ritz-chart", "pareto", "plain.jsonl", "-o", "slow.svg"],
          ["ritz-chart", "report", "plain.jsonl", "-o", "slow.html"],
          ["ritz-rank", sys.argv[1], "--damping", "modal 0.01",
           "--chart", "slow.svg"]])
for command in kinds:
    for number in signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL:
        run = subprocess.Popen(command, stdout=subprocess.DEVNULL)
        until(lambda: pid_of() and state(pid_of()))
        pid = pid_of()
        run.send_signal(number)
        assert run.wait(timeout=20) == -number
        until(lambda: state(pid) in ("", "Z"))
        os.remove("gnuplot.pid")
        assert not os.path.exists(command[-1])
        assert number == signal.SIGKILL or not any(
            name.endswith(".part") for name in os.listdir("."))
        for name in os.listdir("."):
            if name.startswith("slow."):
                os.remove(name)
END_OF_END
expect 0 '' /usr/bin/python3 -s end.py "reduced $evil.h5"
echo "1..$count"
