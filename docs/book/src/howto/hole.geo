// A plate with a hole, 100 mm x 60 mm, lengths in mm
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 100, 60};
Disk(2) = {50, 30, 0, 10};
BooleanDifference(3) = { Surface{1}; Delete; }{ Surface{2}; Delete; };
Physical Surface("plate") = {3};
Physical Curve("left") = Curve In BoundingBox {-1, -1, -1, 1, 61, 1};
Physical Curve("right") = Curve In BoundingBox {99, -1, -1, 101, 61, 1};
Mesh.MeshSizeMin = 2;
Mesh.MeshSizeMax = 2;
