# --- response: responses over each other, errors to the first below ---
# channels, across, tall (pixels of a cell), curves, strips (1 or 2), decibels
# (the lowest strip has them), x_log, x_low, x_high; of each channel title[],
# singular[], shared[] (it has errors), y_low[], y_high[], and of its strips
# error_low[], error_high[], decibel_low[], decibel_high[].
# Data: channel response value hertz magnitude degrees error decibels tip.
first_colour = curves > 1 ? pale : c1
tone(w) = w == 0 ? first_colour : colour(w - 1)
label_left = "set label 2 words at screen (left + 13.0) / wide, " . \
    "graph 0.5 center rotate by 90 noenhanced tc rgb ink"
at(w) = $1 == c - 1 && $2 == w ? $4 : NaN
if (x_log) { set logscale x }
set xrange [x_low:x_high]
set logscale y
unset mxtics
unset mytics
do for [c=1:channels] {
    left = (c - 1) % across * 490
    base = ((channels - 1) / across - (c - 1) / across) * tall
    below = shared[c] ? strips : 0
    eval panel(left + 64, base + 52 + 153 * below, left + 468, \
        base + tall - 44)
    head = title[c]
    eval heading
    words = singular[c] ? 'singular values' : 'magnitude'
    eval label_left
    set format y '10^{%L}'
    set yrange [y_low[c]:y_high[c]]
    many = ceil(log10(y_high[c] / y_low[c]) / 12)
    few = 10.0**many
    # the lowest number would touch the highest of a strip below it
    set ytics y_low[c] * (below ? few : 1), few
    set format x (below ? '' : '%g')
    set xlabel (below ? '' : 'Hz')
    plot for [w=0:curves - 1] data skip 1 \
            using ($3 == 0 ? at(w) : NaN):5 with lines lc rgb tone(w) \
            lw (w == 0 && curves > 1 ? 6 : 1.6) dt dash(w), \
        for [w=0:curves - 1] data skip 1 \
            using ($3 > 0 ? at(w) : NaN):5 with lines lc rgb tone(w) \
            lw (w == 0 && curves > 1 ? 3 : 0.8) dt dash(w), \
        data skip 1 using (at(-1)):5:9 with labels noenhanced hypertext \
            point pt 6 ps 0.7 lc rgb muted, \
        for [w=0:curves - 1] data skip 1 using ($3 == w ? at(-2) : NaN):5:9 \
            with labels noenhanced hypertext point pt 12 ps 1.1 lw 1.4 \
            lc rgb (w == 0 ? ink : colour(w - 1))
    do for [s=1:below] {
        # the lowest of the strips has frequencies below it
        field = s == 1 && !(decibels && strips == 1) ? 7 : 8
        low = base + 52 + 153 * (below - s)
        words = field == 7 ? 'error / largest' : 'difference, dB'
        from = field == 7 ? error_low[c] : decibel_low[c]
        to = field == 7 ? error_high[c] : decibel_high[c]
        level = field == 7 ? 0.1 : 20 * log10(1.1)
        many = ceil(log10(to / from) / 4)
        head = ''
        eval panel(left + 64, low, left + 468, low + 139)
        eval heading
        eval label_left
        set yrange [from:to]
        few = 10.0**many
        set ytics from * (s < below ? few : 1), few
        if (from <= level && level <= to) {
            set arrow from graph 0, first level to graph 1, first level \
                nohead lw 1.2 dt 2 lc rgb ink
            set label '10 %' at graph 1, first level right offset -0.3,0.6 \
                noenhanced font ',11' tc rgb ink
        }
        set format x (s == below ? '%g' : '')
        set xlabel (s == below ? 'Hz' : '')
        plot for [w=1:curves - 1] data skip 1 \
                using ($3 == 0 ? at(w) : NaN):field with lines lw 1.2 \
                lc rgb tone(w) dt dash(w), \
            for [w=1:curves - 1] data skip 1 \
                using ($3 > 0 ? at(w) : NaN):field with lines lw 0.7 \
                lc rgb tone(w) dt dash(w)
    }
}
