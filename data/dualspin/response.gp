# Responses of the gyroscope to the bearing torque, full model and reduced, and
# the error below: gnuplot -e "angles='60 180 300'; order='46'; out='overview.svg'" FILE
#
# Columns of the data: hertz, magnitude and phase in degrees, first of the full
# model, then of the reduced one at the same frequencies.

n = words(angles)
set terminal svg size 560 * n, 640 dynamic font "Helvetica,13" \
    background rgb "white" linewidth 1.2
set output out
set multiplot
set logscale xy
set xrange [0.05:10]
set grid lc rgb "#dddddd" lt 1
set format y "10^{%L}"
set key horizontal samplen 2 font ",12"

polar(m, d) = m * exp({0, 1} * d * pi / 180.0)
files(a) = sprintf("< paste build/full-%s-response.tsv " . \
    "build/reduced-%s-response.tsv", a, a)

do for [k = 1:n] {
    a = word(angles, k)
    set lmargin at screen (k - 1 + 0.15) / n
    set rmargin at screen (k - 0.02) / n

    stats files(a) using 2 name "S" nooutput
    set tmargin at screen 0.90
    set bmargin at screen 0.43
    set label 1 sprintf("clock angle %s degrees", a) \
        at screen (k - 0.435) / n, 0.975 center font ",15"
    set key at screen (k - 0.02) / n, 0.935 right
    set ylabel "gyro / torque on rotor  [rad/(N m)]" offset 1
    unset xlabel
    set format x ""
    set yrange [S_min * 0.3:S_max * 3]
    plot files(a) \
        using 1:2 with lines lw 5 lc rgb "#9ecae1" title "full model, 296 dofs", \
        "" using 1:5 with lines lw 1.4 lc rgb "#b2182b" title sprintf("reduced, %s dofs", order)
    unset label 1

    set tmargin at screen 0.36
    set bmargin at screen 0.10
    set ylabel "|error| / max |full|" offset 1
    set xlabel "Hz"
    set format x "%g"
    set yrange [1e-13:1]
    plot files(a) using 1:(abs(polar($2, $3) - polar($5, $6)) / S_max) \
        with lines lw 1 lc rgb "#b2182b" notitle
}
unset multiplot
