// A penny-shaped crack of 100 m across x in a cube of 1200 m; cells are smallest at its rim.
SetFactory("OpenCASCADE");
h = 14; rate = 0.5; rim = 0.3;   // m on the crack; how sizes grow away from it; of h at the rim
Box(1) = {-600, -600, -600, 1200, 1200, 1200};
Disk(20) = {0, 0, 0, 100};
Rotate {{0, 1, 0}, {0, 0, 0}, Pi/2} { Surface{20}; }
BooleanFragments{ Volume{1}; Delete; }{ Surface{20}; Delete; }
Physical Volume("rock") = {1};
Physical Surface("crack") = {20};
outside() = Surface In BoundingBox {-601, -601, -601, 601, 601, 601};
outside() -= {20};
Physical Surface("outside") = {outside()};
Field[1] = MathEval;
Field[1].F = Sprintf("%g * (1 - (1 - %g) * Exp(-(Fabs(Sqrt(y*y+z*z)-100)+Fabs(x))/40)) + %g * Sqrt(x*x + ((Sqrt(y*y+z*z)-100)+Fabs(Sqrt(y*y+z*z)-100))^2/4)", h, rim, rate);
Background Field = 1;
Mesh.CharacteristicLengthExtendFromBoundary = 0;
Mesh.CharacteristicLengthFromPoints = 0;
