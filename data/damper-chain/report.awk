# report.awk MODEL-poles.tsv... MODEL-mode1.tsv... MODEL-mode2.tsv... - the first
# oscillating poles of each model side by side; where c is best, and what the
# first model, which is the full one, makes of that c.
BEGIN { FS = "\t" }

FNR == 1 {
    for (k in column)
        delete column[k]
    for (k = 1; k <= NF; k++)
        column[$k] = k
    poles = FILENAME ~ /-poles.tsv$/
    if (poles)
        models++
    else
        scans++
    next
}

poles && $column["imaginary"] > 0 {
    mode = ++count[models]
    w[models, mode] = $column["rad_per_s"]
    zeta[models, mode] = 100 * $column["zeta"]
}

!poles {
    ratio[scans, $column["c"]] = $column["zeta"]
    if ($column["zeta"] > top[scans]) {
        top[scans] = $column["zeta"]
        best[scans] = $column["c"]
    }
}

END {
    print "              full model          8 modes + 3 static    " \
          "11 modes alone"
    print "mode        rad/s    zeta %       rad/s    zeta %       " \
          "rad/s    zeta %"
    for (mode = 1; mode <= 4; mode++) {
        printf "%4d", mode
        for (k = 1; k <= models; k++)
            printf "%13.7g%10.5f", w[k, mode], zeta[k, mode]
        printf "\n"
    }
    print ""
    print "Best c of all three dampers, zeta % there, and of the full model " \
          "with that c:"
    for (mode = 1; mode <= 2; mode++) {
        printf "%4d", mode
        first = (mode - 1) * models + 1
        for (s = first; s < first + models; s++)
            printf "%7d%8.3f%8.3f", best[s], 100 * top[s],
                100 * ratio[first, best[s]]
        printf "\n"
    }
}
