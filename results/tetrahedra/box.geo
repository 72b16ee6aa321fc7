// The body and the fault of box.json, in tetrahedra: as many jumps, and nearly as many unknowns.
SetFactory("OpenCASCADE");
Box(1) = {-2500, 0, -3000, 5000, 1500, 3000};
Point(101) = {0, 0, -2750};  Point(102) = {0, 1500, -2750};  Point(103) = {0, 1500, -1300};  Point(104) = {0, 0, -1300};
For k In {0 : 3}
  Line(101 + k) = {101 + k, 101 + (k + 1) % 4};
EndFor
Curve Loop(101) = {101 : 104};
Plane Surface(101) = {101};
BooleanFragments{ Volume{1}; Delete; }{ Surface{101}; Delete; }

e = 1;
Physical Volume("rock") = Volume{:};
Physical Surface("F1") = Surface In BoundingBox{-e, -e, -2750 - e, e, 1500 + e, -1300 + e};
Physical Surface("west") = Surface In BoundingBox{-2500 - e, -e, -3000 - e, -2500 + e, 1500 + e, e};
Physical Surface("east") = Surface In BoundingBox{2500 - e, -e, -3000 - e, 2500 + e, 1500 + e, e};
Physical Surface("front") = Surface In BoundingBox{-2500 - e, -e, -3000 - e, 2500 + e, e, e};
Physical Surface("back") = Surface In BoundingBox{-2500 - e, 1500 - e, -3000 - e, 2500 + e, 1500 + e, e};
Physical Surface("base") = Surface In BoundingBox{-2500 - e, -e, -3000 - e, 2500 + e, 1500 + e, -3000 + e};

// Cells grow with their distance from the fault.
Field[1] = MathEval;
Field[1].F = "40 + 0.091 * Sqrt(x*x + ((Abs(z + 2025) - 725) + Abs(Abs(z + 2025) - 725))^2 / 4)";
Background Field = 1;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.Optimize = 1;
