# --- simulation: outputs over time, one below the other ---
# outputs, title[], runs, x_low, x_high. Data: output simulation seconds value.
set xrange [x_low:x_high]
set offsets graph 0, graph 0, graph 0.05, graph 0.05
set xlabel 's'
do for [i=1:outputs] {
    bottom = (outputs - i) * 210
    eval panel(76, bottom + 48, wide - 22, bottom + 180)
    head = title[i]
    eval heading
    plot for [w=0:runs - 1] data skip 1 \
        using ($1 == i - 1 && $2 == w ? $3 : NaN):4 with lines \
        lw (w == 0 ? 4 : 1.5) dt dash(w) \
        lc rgb (w == 0 && runs > 1 ? pale : colour(w))
}
