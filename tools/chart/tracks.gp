# --- tracks: frequencies of modes over configurations ---
# tracks, x_low, x_high, y_high, xlabel, swept (x is a setting; else a number),
# doubt. Data: track x hertz mac tip mode configuration.
eval panel(62, 58, 702, body - 40)
head = 'Modes over configurations'
eval heading
set xlabel xlabel
set ylabel 'Hz'
set xrange [x_low:x_high]
set yrange [0:y_high]
if (!swept) { set xtics 1 }
if (x_low == x_high) {
    set xrange [x_low - 0.5:x_high + 0.5]
    unset xtics
}
plot for [k=1:tracks] data skip 1 using ($1 == k ? $2 : NaN):3 \
        with lines lw 1.6 lc rgb colour(k - 1), \
    for [k=1:tracks] data skip 1 using ($1 == k ? $2 : NaN):3:5 \
        with labels noenhanced hypertext point pt mark(k - 1) ps 0.55 \
        lc rgb colour(k - 1), \
    data skip 1 using ($4 < doubt ? $2 : NaN):3 with points pt 6 ps 1.2 \
        lw 1.4 lc rgb alarm
