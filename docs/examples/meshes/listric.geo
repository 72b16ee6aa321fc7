// A reservoir that a listric fault F1 offsets by 80 m, and a branch F2 that ends at it: a T.
//
//   gmsh -3 listric.geo -format msh41 -o listric.msh
//
// A section in x (east) and z (up) is drawn first and then pulled along y, the strike. Units: m.

W = 2500; D = 3000; L = 1200;            // half the width, depth, length along strike
top_west = -2000; base_west = -2200;     // the reservoir, either side of F1
top_east = -2080; base_east = -2280;
tip_up = -1500; tip_down = -2600;        // where F1 ends in the rock
junction = -2140; tip_branch = -1700;    // where F2 ends: below at F1, above in the rock
h = 70; coarse = 600;                    // size of cells at the junction and far away

Macro Listric                            // x of F1 at the depth z: steep above, flat below
  x = -300 + 1200 * (z / D)^2;
Return

// ---- The section: points and lines down F1, which the rock goes on along to the surface and the
// base (the names at the end say which part is a fault),
depths[] = {0, tip_up, top_west, top_east, junction, base_west, base_east, tip_down, -D};
For i In {0 : 8}
  z = depths[i]; Call Listric;
  f[i] = newp; Point(f[i]) = {x, 0, z};
EndFor
For i In {0 : 7}
  For k In {1 : 3}                       // curved: more points between
    z = depths[i] + k / 4 * (depths[i + 1] - depths[i]); Call Listric;
    p[k] = newp; Point(p[k]) = {x, 0, z};
  EndFor
  down[i] = newl; Spline(down[i]) = {f[i], p[1], p[2], p[3], f[i + 1]};
EndFor

// up F2, which leans the other way, from F1 to the surface,
z = junction; Call Listric;
x_junction = x;                          // on a line of its own: a macro runs at the end of its line
rises[] = {top_east, tip_branch, 0};
For i In {0 : 2}
  b[i] = newp; Point(b[i]) = {x_junction + 0.5 * (rises[i] - junction), 0, rises[i]};
EndFor
up[0] = newl; Line(up[0]) = {f[4], b[0]};
up[1] = newl; Line(up[1]) = {b[0], b[1]};
up[2] = newl; Line(up[2]) = {b[1], b[2]};

// and the horizons, with the sides of the body: 101 to 104 in the west, 201 to 204 in the east.
Point(101) = {-W, 0, 0};  Point(102) = {-W, 0, top_west};  Point(103) = {-W, 0, base_west};  Point(104) = {-W, 0, -D};
Point(201) = { W, 0, 0};  Point(202) = { W, 0, top_east};  Point(203) = { W, 0, base_east};  Point(204) = { W, 0, -D};
Line(301) = {101, f[0]};  Line(302) = {102, f[2]};  Line(303) = {103, f[5]};  Line(304) = {104, f[8]};
Line(401) = {b[2], 201};  Line(402) = {b[0], 202};  Line(403) = {f[6], 203};  Line(404) = {f[8], 204};
Line(311) = {101, 102};   Line(312) = {102, 103};   Line(313) = {103, 104};
Line(411) = {201, 202};   Line(412) = {202, 203};   Line(413) = {203, 204};
Line(501) = {f[0], b[2]}; Line(502) = {f[3], b[0]};   // of the wedge between F1 and F2

// West of F1, of the wedge, and east of both: overburden, reservoir, underburden.
Curve Loop(1) = {301, down[0], down[1], -302, -311};           Plane Surface(1) = {1};
Curve Loop(2) = {302, down[2], down[3], down[4], -303, -312};  Plane Surface(2) = {2};
Curve Loop(3) = {303, down[5], down[6], down[7], -304, -313};  Plane Surface(3) = {3};
Curve Loop(4) = {501, -up[2], -up[1], -502, -down[2], -down[1], -down[0]};  Plane Surface(4) = {4};
Curve Loop(5) = {502, -up[0], -down[3]};                       Plane Surface(5) = {5};
Curve Loop(6) = {401, 411, -402, up[1], up[2]};                Plane Surface(6) = {6};
Curve Loop(7) = {402, 412, -403, -down[5], -down[4], up[0]};   Plane Surface(7) = {7};
Curve Loop(8) = {403, 413, -404, -down[7], -down[6]};          Plane Surface(8) = {8};

// ---- Along strike: what each line and surface becomes is kept for the names.
made[] = Extrude {0, L, 0} { Point{f[4]}; };  line_of_junction = made[1];
For i In {1 : 6}
  made[] = Extrude {0, L, 0} { Line{down[i]}; };  f1[] += {made[1]};   // between its tips
EndFor
For i In {0 : 1}
  made[] = Extrude {0, L, 0} { Line{up[i]}; };    f2[] += {made[1]};
EndFor
For l In {311 : 313}
  made[] = Extrude {0, L, 0} { Line{l}; };        west[] += {made[1]};
  made[] = Extrude {0, L, 0} { Line{l + 100}; };  east[] += {made[1]};
EndFor
For l In {304 : 404 : 100}
  made[] = Extrude {0, L, 0} { Line{l}; };        base[] += {made[1]};
EndFor
For s In {1 : 8}
  made[] = Extrude {0, L, 0} { Surface{s}; };
  back[] += {made[0]}; body[s] = made[1];
EndFor

// ---- The names that a scene refers to. A surface without one is rock on both sides.
Physical Volume("overburden") = {body[1], body[4], body[6]};
Physical Volume("reservoir west") = {body[2]};
Physical Volume("reservoir wedge") = {body[5]};
Physical Volume("reservoir east") = {body[7]};
Physical Volume("underburden") = {body[3], body[8]};
Physical Surface("F1") = {f1[]};
Physical Surface("F2") = {f2[]};
Physical Surface("west") = {west[]};
Physical Surface("east") = {east[]};
Physical Surface("base") = {base[]};
Physical Surface("front") = {1 : 8};
Physical Surface("back") = {back[]};

// ---- Sizes: h within 300 m of the junction, growing away from it.
Field[1] = Distance;
Field[1].CurvesList = {line_of_junction};
Field[2] = Threshold;
Field[2].InField = 1;
Field[2].DistMin = 300;  Field[2].SizeMin = h;
Field[2].DistMax = 2500; Field[2].SizeMax = coarse;
Background Field = 2;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.Optimize = 1;                       // fewer flat cells
