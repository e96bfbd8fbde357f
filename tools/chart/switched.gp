# --- switched: vectors over time, and the error below ---
# runs, x_low, x_high, most, y_low, y_high. Data: simulation seconds vectors
# error; vectors are those of the interval that ends at that time.
set xrange [x_low:x_high]
eval panel(76, body - 180, wide - 22, body - 40)
set yrange [0:most * 1.08 + 0.5]
head = 'Vectors'
eval heading
plot for [w=0:runs - 1] data skip 1 using ($1 == w ? $2 : NaN):3 \
    with fsteps lw 1.6 dt dash(w) lc rgb colour(w)
eval panel(76, 48, wide - 22, body - 236)
set xlabel 's'
set logscale y
set yrange [y_low:y_high]
set format y '10^{%L}'
head = 'Error of the worst output, of its largest value'
eval heading
plot for [w=0:runs - 1] data skip 1 using ($1 == w ? $2 : NaN):4 \
    with lines lw 1.6 dt dash(w) lc rgb colour(w)
