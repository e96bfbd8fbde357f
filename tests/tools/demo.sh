#!/bin/sh
# demo.sh FOLDER-OF-THE-TOOLS - the demonstration's Makefile as its user meets
# it: it ends, twice with the same bytes whatever -j, and then has nothing to do.
set -eu
bin=$(cd "$1" && pwd)
here=$(cd "$(dirname "$0")" && pwd)
data=${RITZ_DATA:-$here/../../data}/dualspin
command -v gnuplot >/dev/null || {
    echo "ok 1 - the demonstration runs # SKIP gnuplot is not installed"
    echo '1..1'
    exit 0
}
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
count=0

# holds SENTENCE COMMAND...: the command succeeds.
holds() {
    sentence=$1
    shift
    count=$((count + 1))
    if "$@" >"$dir/log" 2>&1; then
        echo "ok $count - $sentence"
    else
        echo "not ok $count - $sentence"
        tail -n 20 "$dir/log" | sed 's/^/# /'
        exit 1
    fi
}

# of all methods the fit takes a minute
methods=craig-bampton,macneal-rubin
for jobs in 1 4; do
    mkdir "$dir/$jobs"
    cp "$data"/*.bdf "$data"/*.op4 "$data"/*.yaml "$data"/*.gp "$data"/*.awk \
        "$data"/*.py \
        "$data/Makefile" "$dir/$jobs"
    holds "the demonstration runs with -j $jobs" \
        make -C "$dir/$jobs" -j "$jobs" BIN="$bin" METHODS="$methods"
done
for file in system.h5 rotor-verified.h5 full-60-response.h5 report.txt \
    rotor.op4 rotor-exudyn.hdf5; do
    holds "$file has the same bytes both times" \
        cmp "$dir/1/build/$file" "$dir/4/build/$file"
done
for picture in response-60 response-180 response-300 overview tolerances; do
    holds "$picture.svg is drawn" \
        grep -q '</svg>' "$dir/4/build/$picture.svg"
done
holds "the page has a verdict and nine pictures" sh -c \
    "[ \$(grep -c '<figure' '$dir/4/build/report.html') -ge 9 ] &&
     grep -q 'Which method' '$dir/4/build/report.html'"
holds "nothing is left half written" \
    sh -c "! ls '$dir'/4/build/*.part '$dir'/1/build/*.part 2>/dev/null"
# the table and the pictures' names are printed each time; no tool runs again
holds "a second make has nothing to do" sh -c \
    "make -C '$dir/4' BIN='$bin' METHODS='$methods' >'$dir/again' && ! grep -q ritz- '$dir/again'"
echo "1..$count"
