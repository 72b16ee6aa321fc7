# gnuplot figures.gp
set terminal svg size 760,480 background 'white'
set logscale xy
set grid
set key outside top center horizontal
set format y '%g'
set offsets graph 0.1, graph 0.2, graph 0.05, 0
set ylabel 'largest error of the critical index over faults and load steps'
$series0 << END
0.28773856399999997 0.12418991675974933 "80 m"
0.59344254500000004 0.16544815704737881 "40 m"
1.543178648 0.23639861582783572 "20 m"
3.6011552710000005 0.27335502954681801 "10 m (screening)"
7.5773754450000004 0.28630709527980769 "5 m"
21.797092675999998 0.30761386660241641 "2.5 m"
END
$series1 << END
22.377972048 9.9999999999999995e-07 "400 x 80 x 80 m"
END
set output 'pareto.svg'
set xlabel 'operator and one case, s'
plot $series0 using 1:2 with linespoints pt 7 lc 1 title "cells, plane strain", $series0 using 1:2:3 with labels offset 0,0.8 font ',9' tc lt 1 notitle, \
  $series1 using 1:2 with linespoints pt 7 lc 2 title "cells, 3D", $series1 using 1:2:3 with labels offset 0,0.8 font ',9' tc lt 2 notitle
$series0 << END
32 0.31091491672055271 "80 m"
16 0.48774274036851273 "40 m"
8 0.24372084819539697 "20 m"
4 0.075890187916975271 "10 m (screening)"
2 0.037772249195014762 "5 m"
1 0.015380221646523085 "2.5 m"
END
$series1 << END
1 9.9999999999999995e-07 "400 x 80 x 80 m"
END
$series2 << END
16 0.061823011255476512 "1 year"
8 0.030231826572978626 "183 days"
4 0.0077522447009287232 "91.3 days"
2 0.0023020156460499264 "45.7 days"
1 0.00065029291242668652 "22.8 days"
END
set output 'convergence.svg'
set xlabel 'cell or step, in units of the finest'
plot $series0 using 1:2 with linespoints pt 7 lc 1 title "cells, plane strain", $series0 using 1:2:3 with labels offset 0,0.8 font ',9' tc lt 1 notitle, \
  $series1 using 1:2 with linespoints pt 7 lc 2 title "cells, 3D", $series1 using 1:2:3 with labels offset 0,0.8 font ',9' tc lt 2 notitle, \
  $series2 using 1:2 with linespoints pt 7 lc 3 title "salt steps", $series2 using 1:2:3 with labels offset 0,0.8 font ',9' tc lt 3 notitle
