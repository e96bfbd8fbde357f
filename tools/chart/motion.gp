# --- motion: a body deformed and stressed, two panels beside each other ---
# panels, across, panel_wide, panel_high; of each panel title[], x_low[],
# x_high[], y_low[], y_high[]; classes, class_colour[], class_wide[]. Data: panel
# class x y dx dy, lines from a point; class 0 is the body at rest.
unset border
unset tics
unset grid
do for [i=1:panels] {
    left = ((i - 1) % across) * panel_wide
    bottom = body - panel_high * (1 + (i - 1) / across)
    eval panel(left + 8, bottom + 4, left + panel_wide - 8, \
        bottom + panel_high - 26)
    set xrange [x_low[i]:x_high[i]]
    set yrange [y_low[i]:y_high[i]]
    head = title[i]
    eval heading
    plot for [k=0:classes - 1] data skip 1 \
        using ($1 == i - 1 && $2 == k ? $3 : NaN):4:5:6 with vectors nohead \
        lw class_wide[k + 1] lc rgb value(class_colour[k + 1])
}
