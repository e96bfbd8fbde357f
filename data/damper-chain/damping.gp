# Damping ratios over one c for all three dampers: gnuplot -e "out='FILE'".
set terminal svg size 900,420 dynamic enhanced font "sans-serif,12" \
    background "white"
set output out
set datafile separator "\t"
set multiplot layout 1,2
set xlabel "c of each damper, N s/m"
set ylabel "damping ratio, %"
set grid linecolor "#dddddd"
set key below
set xrange [0:4000]
set yrange [0:*]
do for [mode = 1:2] {
    set title sprintf("mode %d", mode)
    file(model) = sprintf("build/%s-mode%d.tsv", model, mode)
    plot file("full") using 1:(100 * $3) skip 1 with lines linewidth 4 \
             linecolor "#999999" title "full, 30 masses", \
         file("ritz") using 1:(100 * $3) skip 1 with lines linewidth 1.5 \
             linecolor "#0060ad" title "8 modes + 3 static vectors", \
         file("truncated") using 1:(100 * $3) skip 1 with lines linewidth 1.5 \
             dashtype 2 linecolor "#dd181f" title "11 modes alone"
}
unset multiplot
