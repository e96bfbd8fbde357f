#!/bin/sh
# make-matrices.sh FOLDER - matrices, libraries and forces of the simulations of
# McDaniel (2000), chapter 6: see SOURCE.md.
set -eu
folder=$1

# Simulations A to D: a mass on springs and dashpots in the plane, directions
# as libraries, and forces along directions that change with time.
awk -v folder="$folder" '
function diagonal(name, value) {
    file = folder "/plane." name ".mtx"
    print "%%MatrixMarket matrix coordinate real symmetric\n2 2 2" >file
    print "1 1 " value "\n2 2 " value >file
}
function library(name, count, degrees,    k) {
    file = folder "/" name ".mtx"
    print "%%MatrixMarket matrix array real general\n2 " count >file
    for (k = 1; k <= count; k++)
        printf "%.17g\n%.17g\n", cos(degrees[k] * pi / 180),
            sin(degrees[k] * pi / 180) >file
}
# Directions X, Y until t1, none until t2, and -Y from there on.
function force(name, x, y, t1, t2, seconds, step,    k, t, s, f) {
    for (k = 0; k <= seconds / step + 0.5; k++) {
        t = k * step
        s = t < t1 - step / 2 ? 1 : t < t2 - step / 2 ? 0 : -1
        f = 10 * sin(10 * pi * t)
        printf "%.6g\t%.17g\n", t, s == 0 ? 0 : x * f >(folder "/" name "-x.tsv")
        printf "%.6g\t%.17g\n", t, s * y * f >(folder "/" name "-y.tsv")
    }
}
BEGIN {
    pi = atan2(0, -1)
    diagonal("K", 500); diagonal("M", 5); diagonal("D", 15)
    print "1 1\n1 2" >(folder "/plane.dofs")
    split("45 -45 60 -30", a); library("a", 4, a)
    split("45 60 -30", b); library("b", 3, b)
    for (n = 2; n <= 10; n++) {
        for (k = 1; k <= 2 ^ (n + 1); k++)
            d[k] = 90 - (k - 1) * 90 / 2 ^ n
        library("density" n, 2 ^ (n + 1), d)
    }
    r = sqrt(0.5)
    force("a", r, r, 2, 6, 10, 0.001)
    force("c", r, r, 2, 2.5, 10, 0.001)
    force("d3", 0.9397, 0.3420, 0, 0.2, 3, 0.00025)
}'

# 6.3: a cantilever of ten frame elements, clamped at node 1, dofs x, y and
# rotation of nodes 2 to 11, and the force at its end: across until 0.5 s, along
# from 1 s to 1.5 s, again every 2 s. `turn` is the same with a stiff section,
# the force across until 4 s and along until 8 s, again every 8 s.
awk -v folder="$folder" '
function add(matrix, i, j, value) {
    if (i > 0 && j > 0 && i >= j)
        matrix[i, j] += value
}
# Rows 1, 2, 3 and 4, 5, 6 of the element that ends at node e + 1.
function place(matrix, e, i, j, value) {
    add(matrix, 3 * (e - 2) + i, 3 * (e - 2) + j, value)
    if (i != j)
        add(matrix, 3 * (e - 2) + j, 3 * (e - 2) + i, value)
}
function write(matrix, name,    i, j, count, file) {
    file = folder "/" name ".mtx"
    for (j = 1; j <= n; j++)
        for (i = j; i <= n; i++)
            count += (i, j) in matrix
    print "%%MatrixMarket matrix coordinate real symmetric\n" n, n, count >file
    for (j = 1; j <= n; j++)
        for (i = j; i <= n; i++)
            if ((i, j) in matrix)
                printf "%d %d %.17g\n", i, j, matrix[i, j] >file
}
BEGIN {
    pi = atan2(0, -1)
    n = 30; l = 1; rho = 1000; A = 0.01; E = 1.5e6; I = 1e-5; I_turn = 1
    split("12 6 -12 6 4 -6 2 12 -6 4", k)
    split("156 22 54 -13 4 13 -3 156 -22 4", m)
    split("2 2 2 2 3 3 3 5 5 6", row); split("2 3 5 6 3 5 6 5 6 6", col)
    split("0 1 0 1 2 1 2 0 1 2", power)
    for (e = 1; e <= 10; e++) {
        place(K, e, 1, 1, E * A / l); place(K, e, 4, 1, -E * A / l)
        place(K, e, 4, 4, E * A / l)
        place(S, e, 1, 1, E * A / l); place(S, e, 4, 1, -E * A / l)
        place(S, e, 4, 4, E * A / l)
        place(M, e, 1, 1, rho * A * l / 3); place(M, e, 4, 1, rho * A * l / 6)
        place(M, e, 4, 4, rho * A * l / 3)
        for (t = 1; t <= 10; t++) {
            place(K, e, col[t], row[t], k[t] * E * I / l ^ (3 - power[t]))
            place(S, e, col[t], row[t], k[t] * E * I_turn / l ^ (3 - power[t]))
            place(M, e, col[t], row[t], m[t] * rho * A * l ^ (1 + power[t]) / 420)
        }
    }
    write(K, "beam.K"); write(M, "beam.M"); write(S, "turn.K")
    for (j = 2; j <= 11; j++)
        print j " 1\n" j " 2\n" j " 6" >(folder "/beam.dofs")
    for (s = 0; s <= 8000; s++) {
        t = s * 0.0005; p = t % 2; f = 10 * sin(10 * pi * t)
        g = p < 0.49975 ? f : 0
        h = p > 0.99975 && p < 1.49975 ? f : 0
        printf "%.6g\t%.17g\n", t, g >(folder "/across.tsv")
        printf "%.6g\t%.17g\n", t, h >(folder "/along.tsv")
    }
    for (s = 0; s <= 16000; s++) {
        t = s * 0.001; f = 10 * sin(10 * pi * t)
        across = s % 8000 < 4000
        printf "%.6g\t%.17g\n", t, across ? f : 0 >(folder "/turn-across.tsv")
        printf "%.6g\t%.17g\n", t, across ? 0 : f >(folder "/turn-along.tsv")
    }
}'
