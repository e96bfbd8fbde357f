#!/bin/sh
# processors.sh [--two] BUILD - the unit tests of a build on the kernels that
# OpenBLAS has for other processors, as far as this one can run them, and on
# reference BLAS: a line each; or, without searches, on two that the number of
# commits picks.
set -eu
two='' kinds='unit|search'
[ "$1" != --two ] || { two=yes kinds=unit; shift; }
build=$(cd "$1" && pwd)
logs=$build/processors
reference=$logs/reference-blas
cores=$(nproc 2>/dev/null || echo 2)

# Names as of OPENBLAS_CORETYPE, and flags of /proc/cpuinfo that they need.
kernels='Prescott pni
Nehalem sse4_2
Sandybridge avx
Haswell avx2 fma
Zen avx2 fma
SkylakeX avx512f avx512cd avx512bw avx512dq avx512vl
Cooperlake avx512f avx512_bf16'

# The kernels that this processor can run, and reference BLAS.
list() {
    flags=" $(sed -n 's/^flags[^:]*: //p' /proc/cpuinfo | head -n 1) "
    echo "$kernels" | while read -r name needs; do
        for flag in $needs; do
            case $flags in
            *" $flag "*) ;;
            *) continue 2 ;;
            esac
        done
        echo "$name"
    done
    echo reference
}

# Two of those on standard input, by turns: neighbours, first and last too.
choose() {
    count=$(git rev-list --count HEAD 2>/dev/null || echo 0)
    awk -v turn="$count" '{ name[NR - 1] = $0 }
        END { print name[2 * turn % NR]; print name[(2 * turn + 1) % NR] }'
}

# Make a folder of libraries that replace OpenBLAS if LD_LIBRARY_PATH names it.
# OpenBLAS is both BLAS and LAPACK. An empty library of its name that loads the
# reference BLAS and LAPACK, stands in for it.
substitute() {
    for name in blas lapack; do
        found=$(ls -d /usr/lib/*/$name/lib$name.so.3 2>/dev/null | head -n 1)
        [ -n "$found" ] || {
            echo "reference BLAS: lib${name}3 is missing" >&2
            return 1
        }
        mkdir -p "$reference"
        ln -sf "$found" "$reference/lib$name.so.3"
    done
    rm -f "$reference/libopenblas.so.0"
    "${CC:-cc}" -shared -nostdlib -Wl,--no-as-needed \
        -Wl,-soname,libopenblas.so.0 -o "$reference/libopenblas.so.0" \
        "$reference/libblas.so.3" "$reference/liblapack.so.3"
}

# The kernels that a program really computes with.
loaded() {
    program=$build/tests/test_linear
    if ldd "$program" | grep -q "$reference/libopenblas"; then
        echo reference
    else
        OPENBLAS_VERBOSE=2 "$program" --list 2>&1 >/dev/null |
            sed -n 's/^Core: //p'
    fi
}

# run NAME: in a shell of its own, as what is exported is for this run alone
run() (
    log=$logs/$1.log
    case $1 in
    reference)
        substitute
        export LD_LIBRARY_PATH="$reference"
        ;;
    *) export OPENBLAS_CORETYPE="$1" ;;
    esac
    # what was asked for is not always what is used
    used=$(loaded)
    [ "$used" = "$1" ] || { echo "$1: the kernels are those of $used"; exit 1; }
    # a call gives up on any processor as on this one
    export RITZ_TEST_ALLOCATIONS=0
    if ctest --test-dir "$build" -L "^($kinds)\$" --no-tests=error -j "$cores" \
        --timeout 600 --output-on-failure >"$log" 2>&1; then
        sed -n "s/^100% tests passed.* out of \(.*\)/$1: \1 tests passed/p" "$log"
    else
        echo "$1: FAILED, see $log:" \
            "$(sed -n 's/^\t *[0-9]* - \([^ ]*\).*/\1/p' "$log" | tr '\n' ' ')"
        exit 1
    fi
)

mkdir -p "$logs"
result=0
for name in $(if [ "$two" ]; then list | choose; else list; fi); do
    run "$name" || result=1
done
exit $result
