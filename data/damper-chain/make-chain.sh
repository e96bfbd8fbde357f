#!/bin/sh
# make-chain.sh FOLDER - K.mtx, M.mtx and dofs.txt of the chain: see SOURCE.md.
set -eu
awk -v folder="$1" 'BEGIN {
    n = 30
    format = "%%%%MatrixMarket matrix coordinate real symmetric\n%d %d %d\n"
    K = folder "/K.mtx"; M = folder "/M.mtx"; dofs = folder "/dofs.txt"
    printf format, n, n, 2 * n - 1 >K
    printf format, n, n, n >M
    for (i = 0; i < n; i++) {
        k = 1000 + 200 * ((3 * i) % 4)
        next_k = i + 1 < n ? 1000 + 200 * ((3 * i + 3) % 4) : 0
        printf "%d %d %d\n", i + 1, i + 1, k + next_k >K
        if (i > 0)
            printf "%d %d %d\n", i + 1, i, -k >K
        printf "%d %d %.1f\n", i + 1, i + 1, 1 + 0.1 * ((7 * i) % 5) >M
        printf "%d 0\n", i + 1 >dofs
    }
}'
