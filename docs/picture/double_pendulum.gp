# gnuplot -e "folder='DATA-FOLDER'" docs/picture/double_pendulum.gp > docs/double_pendulum.svg
set terminal svg size 860,420 font "sans-serif,13" background rgb "white"
set xlabel "time, s"
set ylabel "angle, rad"
set key bottom left
set grid lc rgb "#dddddd"
set style fill solid 0.55 noborder
set xrange [0:3]
plot folder."/boxes.dat" using (($1+$2)/2):(($3+$4)/2):1:2:3:4 with boxxyerror lc rgb "#4477aa" title "first angle, proved", \
     folder."/boxes.dat" using (($1+$2)/2):(($5+$6)/2):1:2:5:6 with boxxyerror lc rgb "#ee6677" title "second angle, proved", \
     folder."/samples.dat" using 1:2 with points pt 7 ps 0.12 lc rgb "#112244" title "simulated pendulums", \
     folder."/samples.dat" using 1:3 with points pt 7 ps 0.12 lc rgb "#112244" notitle
