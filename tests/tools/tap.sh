# What test scripts of the tools share; sourced with FOLDER-OF-THE-TOOLS as $1.
# They then stand in an empty folder that goes away, the tools in the path;
# $here is where the scripts are, $data where models are.
# shellcheck shell=sh disable=SC2034 # for those who source it
set -eu
bin=$(cd "$1" && pwd)
here=$(cd "$(dirname "$0")" && pwd)
data=$(cd "${RITZ_DATA:-$here/../../data}" && pwd)
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
PATH=$bin:$PATH
count=0

# report NUMBER-IS-OK NAME: one TAP line; the log explains a failure.
report() {
    count=$((count + 1))
    if [ "$1" = yes ]; then
        printf 'ok %d - %s\n' "$count" "$2"
        return
    fi
    printf 'not ok %d - %s\n' "$count" "$2"
    sed 's/^/# /' log
    exit 1
}

# works NAME COMMAND...: the command succeeds.
works() {
    what=$1
    shift
    if "$@" >log 2>&1; then
        report yes "$what"
    else
        report no "$what"
    fi
}

# expect STATUS WORDS COMMAND...: the command exits so and says so.
expect() {
    want=$1 words=$2 got=0
    shift 2
    "$@" >log 2>&1 || got=$?
    if [ "$got" = "$want" ] && { cat log; echo; } | grep -qF -e "$words"; then
        report yes "$*"
    else
        echo "exit $got, not $want, or no '$words' above" >>log
        report no "$*"
    fi
}

# at_step SIGNAL STEP COMMAND...: the command gets the signal when it shows the
# step of its work; its status is 128 + N if signal N ends it. at_step.py has
# other actions.
at_step() { /usr/bin/python3 -s "$here/at_step.py" "$@"; }

# holds NAME PYTHON: the expression is true of j, the JSON object in log.json.
holds() {
    works "$1" /usr/bin/python3 -s - "$2" <<'END'
import json, math, sys
j = json.load(open("log.json"))
def near(a, b, tolerance):
    return len(a) == len(b) and all(
        abs(x - y) <= tolerance * max(abs(y), 1.0) for x, y in zip(a, b))
sys.exit(0 if eval(f"({sys.argv[1]})") else f"{sys.argv[1]} fails of {j}")
END
}

# json STATUS COMMAND...: --json gives one object, whatever the status.
json() {
    want=$1 got=0
    shift
    "$@" --json >log.json 2>log || got=$?
    [ "$got" = "$want" ] || echo "exit $got, not $want" >>log
    [ "$got" = "$want" ] && verdict=yes || verdict=no
    report "$verdict" "$* --json"
    holds "  is one object with the keys of every tool" \
        'all(k in j for k in ("tool", "version", "ok", "output", "warnings"))
         and j["ok"] == ('"$want"' == 0)'
}

# same NAME FILE FILE: byte for byte.
# Not in the log, which may be one of them.
same() {
    cmp "$2" "$3" >differ 2>&1 && report yes "$1" || report no "$1"
}
