# Composite tolerance against orders of the components and worst error of a kept
# mode, from the table of ritz-compare --tolerance-table.
#
#     gnuplot -e "table='tolerances.tsv'; out='tolerances.svg'" tolerances.gp
set terminal svg size 760,480 font 'sans,13' background 'white'
set output out
set datafile separator tab
set datafile missing 'nan'
set key outside top center horizontal
set logscale x
set logscale y2
set format x '10^{%L}'
set format y2 '10^{%L}'
set xlabel 'composite tolerance'
set ylabel 'coordinates'
set y2label 'worst relative error at listed configurations'
set ytics nomirror
set y2tics
set grid x y
set yrange [0:*]
plot table using 1:2 skip 1 with linespoints lw 2 pt 7 lc '#333333' \
         title 'all components', \
     table using 1:3 skip 1 with linespoints lw 2 pt 5 lc '#3465a4' \
         title 'system', \
     table using 1:5 skip 1 axes x1y2 with linespoints lw 2 pt 9 dt 2 \
         lc '#cc0000' title 'kept modes, frequency', \
     table using 1:7 skip 1 axes x1y2 with linespoints lw 2 pt 11 dt 3 \
         lc '#4e9a06' title 'response in the band'
