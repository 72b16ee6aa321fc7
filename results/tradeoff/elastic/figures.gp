# gnuplot figures.gp
set terminal svg size 760,480 background 'white'
set logscale xy
set grid
set key outside top center horizontal
set format y '%g'
set offsets graph 0.1, graph 0.2, graph 0.05, 0
set ylabel 'largest error of the critical index over faults and load steps'
$series0 << END
0.048257622 0.22513845964549406 "80 m"
0.071366993000000004 0.17769909241812054 "40 m"
0.126726055 0.070692738044391579 "20 m"
0.15996011700000001 0.027063074123134134 "10 m (screening)"
0.36709933700000003 0.014085432057856062 "5 m"
0.88903708000000004 0.0086180620076397041 "2.5 m"
END
$series1 << END
3.606479481 0.2175714400778398 "400 x 80 x 80 m"
10.256638534 0.16995745550957975 "200 x 40 x 40 m"
65.098954284000001 0.064353135324144328 "100 x 20 x 20 m (standard)"
END
set output 'pareto.svg'
set xlabel 'operator and one case, s'
plot $series0 using 1:2 with linespoints pt 7 lc 1 title "cells, plane strain", $series0 using 1:2:3 with labels offset 0,0.8 font ',9' tc lt 1 notitle, \
  $series1 using 1:2 with linespoints pt 7 lc 2 title "cells, 3D", $series1 using 1:2:3 with labels offset 0,0.8 font ',9' tc lt 2 notitle
$series0 << END
32 0.22066442393845387 "80 m"
16 0.17322505671108035 "40 m"
8 0.064353135324144328 "20 m"
4 0.020723471403118032 "10 m (screening)"
2 0.0077458293378914744 "5 m"
1 0.0022784592874756093 "2.5 m"
END
$series1 << END
4 0.17161444943280513 "400 x 80 x 80 m"
2 0.12400046486454508 "200 x 40 x 40 m"
1 9.9999999999999995e-07 "100 x 20 x 20 m (standard)"
END
set output 'convergence.svg'
set xlabel 'cell or step, in units of the finest'
plot $series0 using 1:2 with linespoints pt 7 lc 1 title "cells, plane strain", $series0 using 1:2:3 with labels offset 0,0.8 font ',9' tc lt 1 notitle, \
  $series1 using 1:2 with linespoints pt 7 lc 2 title "cells, 3D", $series1 using 1:2:3 with labels offset 0,0.8 font ',9' tc lt 2 notitle
