# --- every chart: paper, colours, axes ---
# Above stand the names of the files, colours, sizes in pixels, the legend and
# the numbers of this picture.
foot = (keys > 0 ? 20 + 22 * ceil(keys / real(columns)) : 0) \
    + (strlen(note) > 0 ? 22 : 0)
high = body + foot
reset
set encoding utf8
set micro
set terminal svg size wide, high dynamic enhanced font 'sans,13' \
    background paper
# if `out` is empty, gnuplot writes to its standard output
if (strlen(out) > 0) { set output out }
set datafile separator tab
set datafile missing 'nan'
set datafile commentschars ''
set style fill solid 1 noborder
set border 3 lc rgb muted
set tics scale 0.6 nomirror font ',12' tc rgb muted
set grid lc rgb grid lt 1 lw 0.8
set xlabel noenhanced offset 0,0.4 tc rgb ink
set ylabel noenhanced tc rgb ink
unset key

# Colour and mark of series k: eight colours and five marks. Colours that are
# alike, such as the two blues, have other marks, and a colour that comes again
# has the next mark.
mark(k) = int(word('7 5 9 13 11', \
    1 + (int(word('0 1 2 3 4 3 1 2', 1 + k % 8)) + k / 8) % 5))
colour(k) = value(sprintf('c%d', 1 + k % 8))
dash(k) = k < 2 ? 1 : k

# Margins of a panel, in pixels from the lower left corner above the legend,
# and the words above it.
panel(left, bottom, right, top) = sprintf( \
    'set lmargin at screen %f; set rmargin at screen %f; ' . \
    'set bmargin at screen %f; set tmargin at screen %f', \
    left / real(wide), right / real(wide), \
    (foot + bottom) / real(high), (foot + top) / real(high))
heading = "unset label; unset arrow; set label 1 head at graph 0, graph 1 " . \
    "offset 0,0.9 noenhanced font ',14' tc rgb ink"
set multiplot
