# report.awk RUN ... - a row for each run whose table is in build/: the mean
# number of vectors, the number of the first vector, and the largest error of
# each output against the full model, absolute and relative to the output's
# largest value.
function read_table(file,    n, k, parts) {
    n = 0
    while ((getline line <file) > 0) {
        k = split(line, parts, "\t")
        if (n == 0) {
            sub(/^# /, parts[1])
            for (j = 1; j <= k; j++)
                name[j] = j == 1 ? "seconds" : parts[j]
            columns = k
        } else
            for (j = 1; j <= k; j++)
                value[n, name[j]] = parts[j]
        n++
    }
    close(file)
    return n - 1
}
function full_of(run,    stem) {
    stem = run
    sub(/-(fixed|switched)-.*$/, "", stem)
    sub(/-[0-9.]+$/, "", stem)
    return "build/" stem "-full.tsv"
}
function order_of(run) {
    sub(/^turn-fixed-/, "", run)
    return run + 2 # static vectors of two forces
}
function compare(run,    count, k, o, v, worst, size, at, first, outputs) {
    split(run ~ /^plane/ ? "x y vx" : "x y turn", outputs, " ")
    count = read_table(full_of(run))
    for (k = 1; k <= count; k++)
        for (o = 1; o <= 3; o++)
            right[k, o] = value[k, outputs[o]]
    delete value
    delete name
    read_table("build/" run ".tsv")
    line = ""
    for (o = 1; o <= 3; o++) {
        worst = size = at = 0
        for (k = 1; k <= count; k++) {
            e = value[k, outputs[o]] - right[k, o]
            e = e < 0 ? -e : e
            v = right[k, o] < 0 ? -right[k, o] : right[k, o]
            if (e > worst) {
                worst = e
                at = value[k, "seconds"]
            }
            size = v > size ? v : size
        }
        line = line sprintf("  %9.3e %8.2e", worst, worst / size)
    }
    first = 0
    for (k = 1; k <= count && first == 0; k++)
        first = value[k, "leading vector"]
    if (run ~ /fixed/)
        printf "%-28s %6.2f      -%s\n", run, order_of(run), line
    else {
        last = value[count, "seconds"]
        step = run ~ /^plane-d/ ? 0.00025 : run ~ /^beam/ ? 0.0005 : 0.001
        printf "%-28s %6.2f %6d%s\n", run,
            value[count, "vector-steps"] / (last / step), first, line
    }
    delete value
    delete name
    delete right
}
BEGIN {
    printf "%-28s %6s %6s  %s\n", "run", "mean", "first",
        "largest error of x, y, then vx or rotation: as it is, and relative"
    for (a = 1; a < ARGC; a++)
        compare(ARGV[a])
    exit
}
