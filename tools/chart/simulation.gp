# --- simulation: outputs over time, one below the other ---
# outputs, runs, x_low, x_high; of each output title[], y_low[], y_high[], y_log[]
# (1: its scale is logarithmic). Data: output simulation seconds value.
set xrange [x_low:x_high]
set xlabel 's'
do for [i=1:outputs] {
    bottom = (outputs - i) * 210
    eval panel(76, bottom + 48, wide - 22, bottom + 180)
    # four or five numbers, 1, 2 or 5 of a decade apart
    apart = (y_high[i] - y_low[i]) / 5
    decade = 10.0**floor(log10(apart))
    times = ceil(apart / decade) > 5 ? 10 : ceil(apart / decade) > 2 ? 5 : 2
    few = times * decade
    unset logscale y
    set yrange [y_low[i]:y_high[i]]
    set ytics few
    if (y_log[i] == 1) {
        set logscale y
        # a few powers of ten
        apart = ceil((log10(y_high[i]) - log10(y_low[i])) / 6)
        set ytics 10.0**apart
        unset mytics
        set format y '1e%T'
    } else {
        set format y '% h'
    }
    head = title[i]
    eval heading
    plot for [w=0:runs - 1] data skip 1 \
        using ($1 == i - 1 && $2 == w ? $3 : NaN):\
        ($4 < y_low[i] ? y_low[i] : $4) with lines \
        lw (w == 0 ? 4 : 1.5) dt dash(w) \
        lc rgb (w == 0 && runs > 1 ? pale : colour(w))
}
