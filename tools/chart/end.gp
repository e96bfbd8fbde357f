# --- every chart: the legend, and a note under it ---
unset label
unset arrow
unset object
unset tics
unset border
unset xlabel
unset ylabel
unset y2label
unset logscale
unset grid
set lmargin at screen 0
set rmargin at screen 1
set bmargin at screen 0
set tmargin at screen (keys > 0 ? (foot - 10) / real(high) : 1)
set xrange [0:1]
set yrange [0:1]
set key inside top center horizontal maxcols columns Left reverse noenhanced \
    font ',12' tc rgb ink samplen 2.2 spacing 1.25
if (strlen(note) > 0) {
    set label note at screen 0.5, screen 11.0 / high center noenhanced \
        font ',11' tc rgb muted
}
legend = 'plot NaN notitle'
do for [k=1:keys] {
    legend = legend . sprintf(', NaN %s title key_name[%d]', key_sign[k], k)
}
eval legend
unset multiplot
