# --- pareto and convergence: errors against time or order ---
# panels, title[], low and high of both axes, tolerance[] (0: none), xlabel,
# seconds, lines (of each method), methods. Data: area series style x y tip
# word order method, with styles 0 meets, 1 misses, 2 chosen, 3 runner-up, 4
# front, 5 line.
percent(e) = e >= -5 && e <= 1 ? sprintf('%g %%%%', 10.0**(e + 2)) \
    : sprintf('1e%d', e)
level(v) = v >= 0.0995 ? sprintf('%.0f %%', 100 * v) \
    : v >= 1e-4 ? sprintf('%.2g %%', 100 * v) : sprintf('%.1e', v)
uncertain = 0.1
do for [p=1:panels] {
    left = (p - 1) % across * 490
    bottom = ((panels - 1) / across - (p - 1) / across) * 380
    eval panel(left + 58, bottom + 58, left + 434, bottom + 338)
    head = title[p]
    eval heading
    set xlabel xlabel
    if (seconds) {
        set logscale x
        set xrange [x_low[p]:x_high[p]]
        set format x '%.0s %cs'
        if (x_high[p] / x_low[p] < 150) {
            set xtics ()
            do for [e=floor(log10(x_low[p])):floor(log10(x_high[p]))] {
                do for [m in '1 2 5'] { set xtics add (m * 10.0**e) }
            }
        } else {
            set xtics autofreq
        }
    } else {
        set xrange [0:x_high[p]]
    }
    set logscale y
    set logscale y2
    set yrange [y_low[p]:y_high[p]]
    set y2range [y_low[p]:y_high[p]]
    set grid noytics xtics
    unset mxtics
    unset mytics
    # lines of equal error: one at each decade, or at few of many; how much it
    # is stands at its right end, unless another level stands there
    first = ceil(log10(y_low[p]) - 1e-9)
    last = floor(log10(y_high[p]) + 1e-9)
    step = last - first > 12 ? 1 + (last - first) / 8 : 1
    tall = log10(y_high[p] / y_low[p])
    near(a, b) = b > 0 && abs(log10(a / b)) / tall * 280 < 14
    shown = y_low[p] <= uncertain && uncertain <= y_high[p]
    set ytics ()
    set y2tics () font ',11' tc rgb muted
    set format y '10^{%L}'
    do for [e=first:last:step] {
        set ytics add (10.0**e)
        set arrow from graph 0, first 10.0**e to graph 1, first 10.0**e \
            nohead lw 1 lc rgb pale
        if (!near(10.0**e, tolerance[p]) && \
            !(shown && near(10.0**e, uncertain))) {
            set y2tics add (percent(e) 10.0**e)
        }
    }
    if (shown) {
        set arrow from graph 0, first uncertain to graph 1, first uncertain \
            nohead lw 1.4 dt 2 lc rgb ink
        if (!near(uncertain, tolerance[p])) {
            set label level(uncertain) at graph 1, first uncertain \
                offset 0.9,0 noenhanced font ',11' tc rgb ink
        }
    }
    if (tolerance[p] > 0) {
        set arrow from graph 0, first tolerance[p] \
            to graph 1, first tolerance[p] nohead lw 1.6 lc rgb alarm
        set label level(tolerance[p]) at graph 1, first tolerance[p] \
            offset 0.9,0 noenhanced font ',11' tc rgb alarm
    }
    at(k) = $1 == p - 1 && $3 == k ? $4 : NaN
    plot NaN notitle, \
        data skip 1 using (at(4)):5 with steps lw 2 lc rgb muted, \
        for [s=0:lines * methods - 1] data skip 1 \
            using ($2 == s ? at(5) : NaN):5 with lines lw 1.8 \
            lc rgb colour(s), \
        data skip 1 using (at(2)):5 with points pt 6 ps 2.4 lw 2.4 \
            lc rgb alarm, \
        data skip 1 using (at(3)):5 with points pt 6 ps 2.2 lw 1.6 \
            lc rgb ink, \
        for [s=0:methods - 1] for [f=0:1] data skip 1 \
            using ($2 == s ? at(f) : NaN):5:6 with labels noenhanced \
            hypertext point pt mark(s) - f ps 1 lw 1.6 lc rgb colour(s), \
        data skip 1 using (at(4)):5:7 with labels right noenhanced \
            offset -0.7,-0.6 font ',11' tc rgb muted
}
