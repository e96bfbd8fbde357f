#!/bin/sh
# sparse.sh FOLDER-OF-THE-TOOLS - large sparse state spaces stay sparse in all
# tools, and every method for state spaces reduces one.
. "$(dirname "$0")/tap.sh"

# rod N: heat in a rod of N cells, E x' = A x + B u; the input heats the first
# third, and outputs are cell N / 4 and the mean of the last third.
rod() {
    for matrix in A E; do
        awk -v n="$1" -v m="$matrix" 'BEGIN {
            print "%%MatrixMarket matrix coordinate real symmetric"
            print n, n, 2 * n - 1
            for (k = 1; k <= n; k++) {
                printf "%d %d %.17g\n", k, k, m == "A" ? -2 : 2 / 3
                if (k < n)
                    printf "%d %d %.17g\n", k + 1, k, m == "A" ? 1 : 1 / 6
            }
        }' >"$matrix.mtx"
    done
    awk -v n="$1" 'BEGIN {
        third = int(n / 3)
        print "%%MatrixMarket matrix coordinate real general"
        print n, 1, third
        for (k = 1; k <= third; k++)
            print k, 1, 1
    }' >B.mtx
    awk -v n="$1" 'BEGIN {
        third = int(n / 3)
        print "%%MatrixMarket matrix coordinate real general"
        print 2, n, third + 1
        print 1, int(n / 4), 1
        for (k = n - third + 1; k <= n; k++)
            printf "2 %d %.17g\n", k, 1 / third
    }' >C.mtx
}

# --- three thousand states ------------------------------------------------------

rod 3010
expect 0 'state space, 3010 states' ritz-import \
    --state-space A=A.mtx,B=B.mtx,C=C.mtx,E=E.mtx --input-names heat \
    --output-names middle,end -o rod.h5
expect 0 'A              3010 x 3010, 9028 entries' ritz-info rod.h5
expect 0 'stable: pole at -1.0886e-06 rad/s' ritz-info rod.h5
expect 0 'sparse/A                       sparse' ritz-info --members rod.h5
json 0 ritz-poles rod.h5 --modes 3
# A and E have the eigenvalues -4 q and 1 - 2 q / 3, q = sin(k pi / 6022)^2
holds '  are those of the closed form' 'near([p["real"] * (2 * q / 3 - 1) / 4 / q
    for p, q in zip(j["poles"], [math.sin(k * math.pi / 6022) ** 2
    for k in (1, 2, 3)])], [1, 1, 1], 1e-9)'
json 0 ritz-poles rod.h5 --modes 2 --near-hz 1e-4
holds '  have residuals' 'all(p["residual"] < 1e-9 for p in j["poles"])'
expect 2 'one of the two' ritz-poles rod.h5 --near-hz 1 --up-to-hz 2
expect 0 'sparse response, 20 points' ritz-frf rod.h5 --to-hz 1e-4 --points 20 \
    -o full.h5
expect 0 'all are left of the axis' ritz-check rod.h5

# reduced METHOD OPTION...: the reduced model is stable
reduced() {
    expect 0 '' ritz-basis -q "$@" rod.h5 -o basis.h5
    expect 0 'stable:' ritz-reduce rod.h5 basis.h5 -o small.h5
}
# verified METHOD OPTION...: it is stable, and its response is within 1e-4
verified() {
    reduced "$@"
    json 0 ritz-verify rod.h5 small.h5 --band-hz 0,1e-5 -o verified.h5
    holds "  $1 has the response of 3010 states" '(lambda m:
        m["response-relative"] < 1e-4 and
        0 < m["h-infinity-relative"] < 1 and 0 < m["h2-relative"] < 1)({x["name"]: x["value"] for x in j["measures"]})'
}
verified krylov --modes 24
expect 0 'left and right vectors agree' ritz-basis krylov --modes 4 rod.h5 \
    -o basis.h5
reduced krylov --modes 24 --sides two --shift-hz 0,1e-6,1e-5
reduced tangential --modes 4
reduced tangential --modes 24 --shift-hz 0,3e-7,1e-6,3e-6
verified balanced --modes 8
expect 0 'residuals of Gramians' ritz-basis balanced --modes 8 rod.h5 -o basis.h5
reduced lanczos-one-sided --modes 8 --operator inverse
verified balanced-band --modes 8 --band-hz 0,1e-5
expect 0 'h2-relative' ritz-verify rod.h5 small.h5 \
    --limit-h-infinity 1 --limit-h2 1 -o verified.h5
expect 1 'limits not met' ritz-verify rod.h5 small.h5 --limit-h2 1e-9 \
    -o none.h5
expect 0 'ADI' ritz-rank --by hankel rod.h5 -o ranking.h5
expect 0 'ADI' ritz-rank --by hankel --engine low-rank rod.h5 -o ranking.h5
expect 0 'projection, ' ritz-rank --by hankel --engine projection rod.h5 \
    -o ranking.h5
expect 1 'its engines are dense, low-rank and projection' ritz-rank --by hankel \
    --engine modal rod.h5 -o none.h5
expect 1 'more than 3000' ritz-export --to matlab rod.h5 -o none.mat
expect 0 'A  3010 x 3010' ritz-export --to matrix-market --force rod.h5 \
    -o 'rod-%.mtx'
expect 0 '3010 states' ritz-import --input-names heat \
    --output-names middle,end -o back.h5 \
    --state-space A=rod-A.mtx,B=rod-B.mtx,C=rod-C.mtx,D=rod-D.mtx,E=rod-E.mtx
for file in rod back; do
    ritz-info --json "$file.h5" | grep -A 6 '"checksums"' >"$file.sums"
done
same 'Matrix Market keeps every bit of sparse matrices' rod.sums back.sums
expect 1 'more than 3000' ritz-simulate rod.h5 --seconds 1 \
    --input heat=step -o none.h5

# --- the list of methods ------------------------------------------------------

ritz-basis --list >list
works '--list says which methods take a state space' awk '
    /^[a-z]/ { name = $1 }
    /^  takes / { takes[name] = $0; count++ }
    END {
        split("balanced balanced-band krylov tangential lanczos-one-sided", with)
        for (k in with)
            if (takes[with[k]] !~ /state spaces/)
                exit 1
        exit count < 20 || takes["craig-bampton"] ~ /state spaces/
    }' list

echo "1..$count"
