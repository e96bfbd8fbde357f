#!/bin/sh
# Run readers under libFuzzer, beginning with the small corpus of corpus.py.
# Usage: fuzz.sh BUILD-FOLDER SECONDS [TARGET]...
# Each TARGET, by default every one, runs for SECONDS. Inputs that reach new
# code are kept in RITZ_FUZZ_CORPUS/TARGET, if that is set, for the next
# campaign; inputs that are findings are kept in BUILD-FOLDER/findings. The
# script ends with a table, and with status 1 if there is a finding.
set -eu
build=$(cd "$1" && pwd)
seconds=$2
shift 2
here=$(cd "$(dirname "$0")" && pwd)
program=$build/tests/ritz_fuzz
[ -x "$program" ] || {
    echo "skipped: $program is not there; Clang's libFuzzer makes it"
    exit 77
}
# shellcheck disable=SC2046 # names are words
[ $# -gt 0 ] || set -- $("$program" --list | cut -d' ' -f1)

# in memory if possible, because files are short-lived
parent=${TMPDIR:-/tmp}
[ ! -w /dev/shm ] || parent=/dev/shm
dir=$(mktemp -d "$parent/ritz-fuzz-XXXXXX")
kept=${RITZ_FUZZ_CORPUS:-$dir/kept}
mkdir -p "$kept" "$build/findings"
trap 'rm -rf "$dir"' EXIT
trap 'exit 129' HUP
trap 'exit 130' INT
trap 'exit 143' TERM
/usr/bin/python3 -s -B "$here/corpus.py" "$dir/corpus"

export RITZ_SYNC=0 OMP_NUM_THREADS=1
export ASAN_OPTIONS="${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=1:\
allocator_may_return_null=1:strict_string_checks=1:handle_abort=1:\
clear_shadow_mmap_threshold=1073741824:quarantine_size_mb=16"
export UBSAN_OPTIONS=print_stacktrace=1
export LSAN_OPTIONS="suppressions=$here/../unit/hdf5.supp:print_suppressions=0"

# fuzz TARGET BYTES LEAKS SILENT: run a target for $seconds on inputs of at most
# BYTES bytes, and print its row of the table. LEAKS 1: look for leaks after
# each input. SILENT 3: drop what tools print.
fuzz() {
    mkdir -p "$dir/$1" "$kept/$1"
    got=0
    (cd "$dir/$1" && "$program" --target="$1" -seed="${RITZ_FUZZ_SEED:-1}" \
        -max_total_time="$seconds" -timeout=20 -rss_limit_mb=2048 \
        -malloc_limit_mb=256 -max_len="$2" -detect_leaks="$3" \
        -close_fd_mask="$4" \
        -print_final_stats=1 -artifact_prefix="$build/findings/$1-" \
        "$kept/$1" "$dir/corpus/$1") >"$dir/log" 2>&1 || got=$?
    runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$dir/log")
    paths=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$dir/log" | tail -n 1)
    [ "$got" = 0 ] && found=0 || found=1
    printf '| %-13s | %10s | %7s | %5s | %8s |\n' "$1" "${runs:--}" \
        "$seconds" "${paths:--}" "$found"
    [ "$got" = 0 ] && return 0
    tail -n 60 "$dir/log" >&2
    return 1
}

printf '| %-13s | %10s | %7s | %5s | %8s |\n' target executions seconds edges \
    findings
echo '|---|---|---|---|---|'
result=0
for target; do
    # HDF5 keeps memory for reuse; only at exit does that differ from a leak
    case $target in
    container | mat-hdf5) fuzz "$target" 200 0 0 || result=1 ;;
    commands | initial | rank-tracks) fuzz "$target" 4096 1 3 || result=1 ;;
    *) fuzz "$target" 4096 1 0 || result=1 ;;
    esac
done
exit $result
