# --- mac: how like the modes of two models are ---
# across, down (modes), cell (pixels), left, head, xlabel, ylabel, names of
# modes column_name[] and row_name[], numbered. Data: column row mac tip.
# One colour, the more of it the more alike.
eval panel(left, body - 40 - cell * down, left + cell * across, body - 40)
eval heading
set xlabel xlabel
set ylabel ylabel
set xrange [-0.5:across - 0.5]
set yrange [down - 0.5:-0.5]
unset grid
set tics scale 0
set xtics rotate by 60 right noenhanced font ',11' ()
set ytics noenhanced font ',11' ()
few = int(ceil(15.0 / cell))
do for [k=1:across:few] {
    set xtics add (column_name[k] k - 1)
}
do for [k=1:down:few] {
    set ytics add (row_name[k] k - 1)
}
shade(x) = (int(239.5 * (1 - x)) << 24) + int('0x' . c1[2:*])
# the scale of the colour, from 1 at its top down to 0
do for [k=0:10] {
    top = body - 41 - 10 * k
    set object k + 1 rectangle \
        from screen (left + cell * across + 18.0) / wide, \
        screen real(top - 10) / high \
        to screen (left + cell * across + 30.0) / wide, \
        screen real(top) / high \
        fc rgb sprintf('#%02x%s', int(239.5 * k / 10), c1[2:*]) \
        fs solid noborder
    if (k % 5 == 0) {
        set label sprintf('%g', 1 - k / 10.0) \
            at screen (left + cell * across + 36.0) / wide, \
            screen (top - 5.0) / high noenhanced font ',11' tc rgb muted
    }
}
number(a, b) = numbered && $3 >= a && $3 < b ? $1 : NaN
plot data skip 1 using 1:2:(0.48):(0.48):(shade($3)) with boxxyerror \
        lc rgb variable, \
    data skip 1 using 1:2:4 with labels noenhanced hypertext point pt 7 \
        ps 0.1 lc rgb '#ff' . c1[2:*], \
    data skip 1 using (number(0.5, 2)):2:(sprintf('%.2f', $3)) with labels \
        font ',10' tc rgb paper, \
    data skip 1 using (number(0.005, 0.5)):2:(sprintf('%.2f', $3)) \
        with labels font ',10' tc rgb ink
