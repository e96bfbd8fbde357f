#!/bin/sh
# Claims as their user meets them. Usage: ritz-claims.sh FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"
mkdir folders
export TMPDIR="$dir/folders"

beam='source nobody
beam b --elements 4 --clamp left --directions 26
run ritz-import --stiffness b.k.mtx --mass b.m.mtx --bulk b.bdf --dofs b.dofs -o b.h5
run ritz-basis macneal-rubin --attach "" --modes 2 b.h5 -o m.h5'

printf '%s\nexpect frequencies_hz[0] as beta 1.8751 rel 1e-4\n' "$beam" >a.claims
expect 0 'ok 1 - a.claims:5 frequencies_hz[0]: 1.8751' ritz-claims a.claims
printf '%s\nexpect frequencies_hz[0] as beta 1.8750 4.7 rel 1e-6\n' "$beam" >b.claims
expect 1 'not ok 1 - b.claims:5 frequencies_hz[0]' ritz-claims b.claims
expect 1 'not ok 2 - b.claims:5 frequencies_hz[1]' ritz-claims b.claims
expect 1 'ritz-claims: 2 of 2 claims do not hold' ritz-claims b.claims
expect 1 'ok 1 - a.claims' ritz-claims a.claims b.claims
json 1 ritz-claims a.claims b.claims
holds 'claims are counted' 'j["holds"] == 1 and j["fails"] == 2 and j["skipped"] == 0'
holds 'and listed' '[c["holds"] for c in j["claims"]] == [True, False, False]'
printf '%s\nexpect frequencies_hz[7] 1 abs 1\nexpect nothing.at.all is 1\n' "$beam" >c.claims
expect 1 'nothing there, 1 expected' ritz-claims c.claims
printf '%s\nexpect frequencies_hz[1] below 4\nexpect frequencies_hz[1] above 3\nexpect method is macneal-rubin\nexpect ok is true\nexpect vectors is 2\n' \
    "$beam" >d.claims
expect 0 '1..5' ritz-claims d.claims
printf 'source nobody\nneed absent.h5\nrun ritz-info absent.h5\nexpect dofs 6 abs 0\n' >e.claims
expect 0 'ok 1 - e.claims:4 expect: not looked at; nobody # skip there is no absent.h5' \
    ritz-claims e.claims
printf 'source nobody\ntext s.yaml\n  scene: s\n  components: {}\ntry ritz-assemble s.yaml -o s.h5\nexpect failure "a scene has 1 to"\n' >f.claims
expect 0 'ok 1 - f.claims:6 failure' ritz-claims f.claims
printf '%s\ntry ritz-info b.h5\nexpect failure "anything"\n' "$beam" >g.claims
expect 1 'it did not fail with a sentence' ritz-claims g.claims

# said(WORDS, TEXT): a file that is not understood
said() {
    printf "$2\n" >x.claims
    expect 1 "$1" ritz-claims x.claims
}
said "x.claims:1: 'expact' is none of source" 'expact a 1 rel 1'
said "x.claims:2: a quote is not closed" 'source a\nrun "ritz-info'
said "x.claims:1: a claim needs a 'source' before it" 'expect a 1 rel 1'
said "x.claims:2: 'ca' is none of rel, abs, below, above" 'source a\nexpect a 1 ca 1'
said "x.claims:2: '1x' is not a number" 'source a\nexpect a 1 rel 1x'
said "x.claims:2: 'x' is not a number" 'source a\nexpect a x rel 1'
said "x.claims:2: 'hz' is none of hertz" 'source a\nexpect a as hz 1 rel 1'
said "x.claims:2: a limit stands alone" 'source a\nexpect a 1 below 1'
said "x.claims:2: no value is given" 'source a\nexpect a rel 1'
said "x.claims:1: what is run is a tool" 'run rm -rf'
said "x.claims:1: what is run is a tool" 'run ritz-/../sh'
said "x.claims:1: there is no tool 'ritz-bases'" 'run ritz-bases'
said "x.claims:1: 'ritz-info nothing.h5' ended with 1: cannot open" 'run ritz-info nothing.h5'
said "x.claims:1: a beam has no '--modes'" 'beam b --modes 2'
said "x.claims:1: 'two' is no number for --elements" 'beam b --elements two'
said "x.claims:1: a beam has 1 to 100000 elements" 'beam b --length 2'
said "x.claims:1: directions are some of 126, not '3'" 'beam b --elements 1 --directions 3'
said "x.claims:1: a beam is clamped none, left, right or both, not 'top'" 'beam b --elements 1 --clamp top'
said "x.claims:1: a beam has a name" 'beam b --elements'
said "x.claims:1: rows are NAME" 'rows r 0'
said "x.claims:1: rows have at most 1000000 grids" 'rows r 1000001'
said "x.claims:1: '11' are not directions" 'rows r 1 11'
said "x.claims:1: the grids of a beam count from 1 or more, not from 9223372036854775807" 'beam b --elements 1 --first-grid 9223372036854775807'
said "x.claims:1: a text has one name" 'text a b'
said "x.claims:1: a source is not named" 'source'
expect 1 "absent.claims" ritz-claims absent.claims
expect 2 'FILE' ritz-claims
printf '\000' >x.claims
expect 1 'x.claims' ritz-claims x.claims

# A claims file is a program. It may run other claims files, which may run none.
printf 'source me\nrun ritz-claims $HERE/a.claims\nexpect holds is 1\n' >outer.claims
expect 0 'ok 1 - outer.claims:3 holds' ritz-claims outer.claims
printf 'source me\ntry ritz-claims $HERE/endless.claims\nexpect failure "may not be run"\n' \
    >endless.claims
printf 'source me\nrun ritz-claims $HERE/endless.claims\nexpect holds is 1\n' >top.claims
expect 0 'ok 1 - top.claims:3 holds' ritz-claims top.claims
printf 'source a\nexpect x[9223372036854775807] 1 1 rel 1\n' >x.claims
expect 1 'x[9223372036854775807]: nothing there' ritz-claims x.claims

# However a run ends, its commands end too, and its folder is removed.
printf 'source nobody\nbeam b --elements 100000\nrun ritz-import --stiffness b.k.mtx --mass b.m.mtx --bulk b.bdf --dofs b.dofs -o b.h5\n' >long.claims
works 'no folder outlives a signal' /usr/bin/python3 -s - <<'END'
import glob, os, signal, subprocess, sys, time
def wait_for(what):
    for attempt in range(3000):
        if what():
            return
        time.sleep(0.01)
    sys.exit("it takes too long")
for number in signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL:
    if number != signal.SIGKILL: # background jobs ignore some
        signal.signal(number, signal.SIG_DFL)
    run = subprocess.Popen(["ritz-claims", "long.claims"],
                           stdout=subprocess.DEVNULL)
    wait_for(lambda: glob.glob("folders/*/answer.json"))
    run.send_signal(number)
    if run.wait(60) != -number:
        sys.exit(f"{number}: status {run.returncode}")
    wait_for(lambda: not os.listdir("folders"))
END
ls -A folders | grep . >log && report no 'no folder is left' ||
    report yes 'no folder is left'
printf '1..%d\n' "$count"
