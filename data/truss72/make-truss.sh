#!/bin/sh
# make-truss.sh [NAME BAYS free|held] - a plane truss: NAME.k.mtx, NAME.m.mtx,
# NAME.dofs and NAME.bdf, by default 'truss72 17 free'. SOURCE.md says what it
# is; with 'held' the two joints at x = 0 do not move.
set -eu
name=${1:-truss72} bays=${2:-17} left=${3:-free}

# entries WHAT: "ROW COL VALUE" of what each bar adds, dofs counted from 1
entries() {
    awk -v what="$1" -v bays="$bays" '
    function bar(p, q,  i, j, dx, dy, l, b, row, v) {
        dx = int(q / 2) - int(p / 2)
        dy = q % 2 - p % 2
        l = sqrt(dx * dx + dy * dy)
        b[0] = -dx / l; b[1] = -dy / l; b[2] = dx / l; b[3] = dy / l
        row[0] = 2 * p + 1; row[1] = 2 * p + 2
        row[2] = 2 * q + 1; row[3] = 2 * q + 2
        for (i = 0; i < 4; i++)
            for (j = 0; j < 4; j++) {
                if (what == "k") v = EA / l * b[i] * b[j]
                else v = (i + j) % 2 ? 0 : rhoA * l / (i == j ? 3 : 6)
                if (v != 0) printf "%d %d %.17g\n", row[i], row[j], v
            }
    }
    BEGIN {
        EA = 7e6; rhoA = 0.27
        bar(0, 1)
        for (k = 0; k < bays; k++) {
            bar(2 * k, 2 * k + 2)
            bar(2 * k + 1, 2 * k + 3)
            bar(2 * k, 2 * k + 3)
            bar(2 * k + 2, 2 * k + 3)
        }
    }'
}

# sum them, lower triangle, column by column
matrix() {
    entries "$1" | awk -v bays="$bays" -v first="$first" '
    { r = $1 - first; c = $2 - first }
    r >= c && c > 0 { if (!((c, r) in sum)) count++; sum[c, r] += $3 }
    END {
        n = 4 * bays + 4 - first
        print "%%MatrixMarket matrix coordinate real symmetric"
        print n, n, count
        for (c = 1; c <= n; c++)
            for (r = c; r <= n; r++)
                if ((c, r) in sum) printf "%d %d %.17g\n", r, c, sum[c, r]
    }'
}

case $left in
free) first=0 ;;
held) first=4 ;;
*) echo "make-truss.sh: '$left' is neither 'free' nor 'held'" >&2; exit 2 ;;
esac
matrix k >"$name.k.mtx"
matrix m >"$name.m.mtx"
awk -v bays="$bays" -v first="$first" 'BEGIN {
    for (i = first; i < 4 * bays + 4; i++) print int(i / 2) + 1, i % 2 + 1
}' >"$name.dofs"
awk -v bays="$bays" 'BEGIN {
    for (j = 0; j < 2 * bays + 2; j++)
        printf "GRID,%d,,%d.,%d.,0.\n", j + 1, int(j / 2), j % 2
}' >"$name.bdf"
