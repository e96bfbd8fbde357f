#!/bin/sh
# disk.sh FOLDER-OF-THE-TOOLS - a full disk: outputs are complete or absent, and
# so are the lines of records.
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

# --- outputs ------------------------------------------------------------------------

# fails_on_each_disk OUTPUT COMMAND...: on disks with fewer blocks of 512 bytes
# than OUTPUT needs, the command fails and leaves nothing; at most 12 sizes.
fails_on_each_disk() {
    out=$1
    shift
    works "$*" "$@"
    most=$((($(wc -c <"$out") - 1) / 512))
    sizes=$(seq 0 $((most / 11 + 1)) "$most")
    for blocks in $sizes "$most"; do
        got=0
        rm -f "$out"*
        # shellcheck disable=SC2016 # for the inner shell
        sh -c 'ulimit -f "$0"; exec "$@"' "$blocks" "$@" >log 2>&1 || got=$?
        if [ "$got" != 1 ] || [ -n "$(find . -name "$out*")" ]; then
            echo "exit $got with $blocks blocks of 512 bytes" >>log
            report no "$*"
        fi
    done
    report yes "  leaves nothing on disks of up to $most blocks"
}

import_body rotor -q --port bearing=1 --output-at tip=5:1 --units 'kg m s' \
    -o rotor.h5
rotor=$data/dualspin/rotor
fails_on_each_disk copy.h5 ritz-import -q --stiffness "$rotor.op4:KGG" \
    --mass "$rotor.op4:MGG" --bulk "$rotor.bdf" --port bearing=1 -o copy.h5
fails_on_each_disk basis.h5 ritz-basis -q craig-bampton --up-to-hz 30 rotor.h5 \
    -o basis.h5
ritz-basis -q craig-bampton --up-to-hz 30 rotor.h5 -o basis.h5
fails_on_each_disk reduced.h5 ritz-reduce -q rotor.h5 basis.h5 -o reduced.h5
ritz-reduce -q rotor.h5 basis.h5 -o reduced.h5
for format in output4 matlab exudyn xdmf vtu uff 42 chrono container dmig fmu \
    fxbody mbdyn openfast sid simscape; do
    fails_on_each_disk "full.$format" \
        ritz-export -q --force --to $format reduced.h5 -o full.$format
done

# --- records ------------------------------------------------------------------------

# Lines are appended until one does not fit, of which nothing may stay.
for blocks in 3 6 9; do
    while cp full.jsonl before.jsonl 2>/dev/null || : >before.jsonl &&
        sh -c "ulimit -f $blocks; exec ritz-info rotor.h5 -q --record full.jsonl" \
            >log 2>&1; do
        :
    done
    works "a line that does not fit into $blocks blocks is taken back" \
        cmp full.jsonl before.jsonl
    ritz-info rotor.h5 -q --record full.jsonl
done
expect 1 "cannot append to 'full.jsonl': File too large" \
    sh -c 'ulimit -f 1; exec ritz-info rotor.h5 -q --record full.jsonl'
printf '{"half": 1, "of": "a lin' >cut.jsonl
expect 0 '' ritz-info rotor.h5 -q --record cut.jsonl
expect 0 '' ritz-info rotor.h5 -q --record cut.jsonl
/usr/bin/python3 -s - >log.json <<'END'
import json
lines = open("cut.jsonl").read().split("\n")
print(json.dumps([lines[0], *(json.loads(x) for x in lines[1:3]), lines[3]]))
END
holds 'no line is glued to half a line' 'len(j) == 4 and j[3] == "" and
    j[0] == "{\"half\": 1, \"of\": \"a lin" and
    all(r["tool"] == "ritz-info" for r in j[1:3])'
expect 1 'line 1: no JSON' ritz-chart pareto cut.jsonl -o x.svg
expect 1 "cannot append to '/dev/full'" ritz-info rotor.h5 --record /dev/full
expect 0 '"tool"' sh -c 'ritz-info rotor.h5 -q --record /dev/stdout | cat'

find . -name '*.part' -o -name 'x*' -o -name 'core*' >log
[ ! -s log ] && report yes 'no leftovers' || report no 'no leftovers'
printf '1..%d\n' "$count"
