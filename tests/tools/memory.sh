#!/bin/sh
# memory.sh FOLDER-OF-THE-TOOLS - a limit of memory decides where data are held
# and what is refused, and no bit of the results.
. "$(dirname "$0")/tap.sh"

unset TMPDIR # may be in memory, where a basis is not put

# lattice N: N x N x N masses of one, springs of one to the next ones and to the
# ground
lattice() {
    awk -v n="$1" 'BEGIN {
        all = n * n * n
        print "%%MatrixMarket matrix coordinate real symmetric"
        print all, all, all + 3 * n * n * (n - 1)
        for (k = 0; k < all; k++) {
            print k + 1, k + 1, 7 + k / all
            if (k % n < n - 1)
                print k + 2, k + 1, -1
            if (int(k / n) % n < n - 1)
                print k + n + 1, k + 1, -1
            if (k < all - n * n)
                print k + n * n + 1, k + 1, -1
        }
    }' >K.mtx
    awk -v n="$1" 'BEGIN {
        all = n * n * n
        print "%%MatrixMarket matrix coordinate real symmetric"
        print all, all, all
        for (k = 1; k <= all; k++)
            print k, k, 1
    }' >M.mtx
    awk -v n="$1" 'BEGIN { for (k = 1; k <= n * n * n; k++) print k, 0 }' >dofs
}

# refused COMMAND...: with 10 MB; sets $named to the number of MiB that the
# sentence says is needed in all.
refused() {
    expect 1 'MiB are allowed (--memory)' "$@" --memory 0010M -o not.h5
    named=$(sed -n 's/.* in use, \([0-9]*\) MiB in all: .*/\1/p' log)
    works '  writes nothing' test ! -e not.h5
}

# passes OUTPUT COMMAND...: with the number named, which after a step that does
# not know later ones may be refused again, but not often. Sets $named.
passes() {
    output=$1
    shift
    for attempt in 1 2 3 4 5 6 7 8 9 10 11 12; do
        got=0
        "$@" --memory "$(printf '%04dM' "$named")" -o "$output" >log 2>&1 ||
            got=$?
        [ "$got" = 1 ] || break
        named=$(sed -n 's/.* in use, \([0-9]*\) MiB in all: .*/\1/p' log)
    done
    [ "$got" = 0 ] && verdict=yes || verdict=no
    report "$verdict" "$* with what is named"
}

# alike FILE FILE: but for the limit in the command that they hold, and for
# checksums of that.
alike() {
    works "  has the bits that it has without a limit" \
        test "$(cmp -l "$1" "$2" | wc -l)" -le 24
}

lattice 18
expect 0 '' ritz-import -q --stiffness K.mtx --mass M.mtx --dofs dofs \
    --input a=1:0 --output-at x=9:0 -o full.h5
for method in macneal-rubin krylov; do
    mkdir -p with without
    (cd without && ritz-basis -q $method --modes 60 ../full.h5 \
        --memory 0020G -o basis.h5)
    cd with
    refused ritz-basis $method --modes 60 ../full.h5
    passes basis.h5 ritz-basis -q $method --modes 60 ../full.h5
    cd ..
    alike without/basis.h5 with/basis.h5
done

# --- on disk ------------------------------------------------------------------

(cd without && ritz-basis -q macneal-rubin --modes 150 ../full.h5 \
    --memory 0020G -o basis.h5)
cd with
refused ritz-basis macneal-rubin --modes 150 ../full.h5
passes basis.h5 ritz-basis macneal-rubin --modes 150 ../full.h5
cp log said
works '  the basis was on disk' grep -q 'held what memory did not' said
cd ..
expect 1 'cannot be written to' env TMPDIR=/nowhere ritz-basis macneal-rubin \
    --modes 150 full.h5 --memory "$((named + 2))M" -o not.h5

# --- reduction ----------------------------------------------------------------

cp without/basis.h5 basis.h5
(cd without && ritz-reduce -q ../full.h5 ../basis.h5 --memory 0020G -o small.h5)
cd with
refused ritz-reduce ../full.h5 ../basis.h5
passes small.h5 ritz-reduce -q ../full.h5 ../basis.h5
cd ..
alike without/small.h5 with/small.h5
echo "1..$count"
