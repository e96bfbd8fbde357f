# One response of the full model and of several reduced ones, the errors below:
# gnuplot -e "out='x.svg'; full='full.tsv'; prefix='build/small-';
#             names='inputs outputs'; title='...'" FILE
# Columns of the data: hertz, magnitude, phase in degrees.

set terminal svg size 760, 640 dynamic font "Helvetica,13" \
    background rgb "white" linewidth 1.2
set output out
array colours[3] = ["#b2182b", "#2166ac", "#1b7837"]
polar(m, d) = m * exp({0, 1} * d * pi / 180.0)
file(k) = prefix . word(names, k) . ".tsv"
both(k) = "< paste " . full . " " . file(k)
set logscale xy
set grid lc rgb "#dddddd" lt 1
set format y "10^{%L}"
stats full using 1:2 name "S" nooutput
set xrange [S_min_x:S_max_x]
set multiplot
set lmargin at screen 0.12
set rmargin at screen 0.97

set tmargin at screen 0.90
set bmargin at screen 0.45
set label 1 title at screen 0.12, 0.96 font ",15"
set key at screen 0.97, 0.985 right top horizontal maxcols 2 samplen 2 font ",12"
set ylabel "|seen / push|" offset 1
set format x ""
set yrange [S_min_y * 0.3:S_max_y * 3]
plot full using 1:2 with lines lw 5 lc rgb "#bdbdbd" title "full model", \
    for [k = 1:words(names)] file(k) using 1:2 with lines lw 1.4 \
        lc rgb colours[k] title word(names, k)
unset label 1

set tmargin at screen 0.40
set bmargin at screen 0.10
set ylabel "|error| / max |full|" offset 1
set xlabel "Hz"
set format x "%g"
set yrange [1e-12:10]
unset key
plot for [k = 1:words(names)] both(k) \
    using 1:(abs(polar($2, $3) - polar($5, $6)) / S_max_y) with lines lw 1.2 \
        lc rgb colours[k] notitle
unset multiplot
