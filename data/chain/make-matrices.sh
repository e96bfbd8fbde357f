#!/bin/sh
# make-matrices.sh - write chain.K.mtx, chain.M.mtx, chain.D.mtx and chain.dofs:
# ten unit masses in a row on unit springs, the first spring on ground, with
# D = K / 100. Lower triangles.
set -eu
cd "$(dirname "$0")"
masses=10

# matrix FILE DIAGONAL LAST BELOW: the last mass hangs on one spring only
matrix() {
    awk -v n="$masses" -v diagonal="$2" -v last="$3" -v below="$4" 'BEGIN {
        print "%%MatrixMarket matrix coordinate real symmetric"
        print n, n, below == 0 ? n : 2 * n - 1
        for (j = 1; j <= n; j++) {
            print j, j, j < n ? diagonal : last
            if (j < n && below != 0)
                print j + 1, j, below
        }
    }' >"$1"
}

matrix chain.K.mtx 2 1 -1
matrix chain.M.mtx 1 1 0
matrix chain.D.mtx 0.02 0.01 -0.01
awk -v n="$masses" 'BEGIN { for (j = 1; j <= n; j++) print j, 1 }' >chain.dofs
