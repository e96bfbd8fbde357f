# --- hankel: values of modes as bars ---
# rankings, count, head, xlabel, ylabel. Data: mode, label, then the value and
# the tip of each ranking.
eval panel(84, 96, wide - 20, body - 44)
eval heading
set logscale y
set format y '10^{%L}'
set ylabel ylabel
set xlabel xlabel offset 0,1.2
set grid noxtics ytics
unset mytics
set xrange [-0.7:count - 0.3]
set xtics scale 0 rotate by 60 right noenhanced font ',11'
each = 0.8 / rankings
at(c) = $0 + each * (c - 0.5 * (rankings - 1))
set boxwidth 0.94 * each absolute
plot data skip 1 using 0:(NaN):xtic(2) with points, \
    for [c=0:rankings - 1] data skip 1 using (at(c)):(column(2 * c + 3)) \
        with boxes lc rgb colour(c), \
    for [c=0:rankings - 1] data skip 1 \
        using (at(c)):(0.93 * column(2 * c + 3)):2 * c + 4 \
        with labels noenhanced hypertext point pt 7 ps 0.3 lc rgb colour(c)
