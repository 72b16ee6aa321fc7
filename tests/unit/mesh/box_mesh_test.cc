#include "simulator/common/units.h"
#include "tests/unit/mesh/mesh_checks.h"

namespace faultsim {
namespace {

using namespace testing_mesh;

BoxMeshSpec box(std::array<double, 3> from, std::array<double, 3> to, double size,
                double growth = 1) {
  BoxMeshSpec spec;
  spec.from = from, spec.to = to;
  spec.layer_materials = {0};
  spec.fault_names = {"a", "b"};
  spec.sizes = {size, size, size, growth, 0, 0};
  spec.plane_strain = false;
  return spec;
}

TEST(BoxMesh, HasTheSizesOfTheSolverTable) {
  // 5 x 2 x 1 box, plane z = 1/2 from x = 0 to the tip line x = 4.
  const size_t displacement[3] = {615, 3267, 20451}, traction[3] = {120, 432, 1632};
  for (int k = 0; k < 3; ++k) {
    const double h = 0.5 / (1 << k);
    BoxMeshSpec spec = box({0, 0, 0}, {5, 2, 1}, h);
    spec.patches = {{{0, 1, 0.5}, 0, 90 * kDegree, 4, 8}};
    const Mesh mesh = make_mesh(spec);
    check_mesh(mesh);
    EXPECT_EQ(3 * mesh.nodes.size(), displacement[k]);
    EXPECT_EQ(3 * count_split(mesh), traction[k]);
    EXPECT_EQ(count_split(mesh), static_cast<size_t>(4 / h * (2 / h + 1)));
    const FaultSurface& fault = mesh.faults[0];
    EXPECT_NEAR(face_area(fault), 8, 1e-12);
    EXPECT_EQ(fault.nodes[0].normal, Eigen::Vector3d(0, 0, 1));
    EXPECT_EQ(fault.nodes[0].strike, Eigen::Vector3d(0, 1, 0));
    EXPECT_EQ(fault.nodes[0].dip, Eigen::Vector3d(-1, 0, 0));
    EXPECT_NEAR(fault.points.front().x(), 4, 1e-12);  // rows go along dip = -x
  }
}

TEST(BoxMesh, WithoutPatchesIsEven) {
  const Mesh mesh = make_mesh(box({-1, 0, 2}, {1, 3, 3}, 0.5, 1.3));
  check_mesh(mesh);
  EXPECT_EQ(mesh.cells.size(), 4u * 6 * 2);
  for (size_t cell = 0; cell < mesh.cells.size(); ++cell)
    EXPECT_NEAR(cell_volume(mesh, cell), 0.125, 1e-12);
  EXPECT_EQ(mesh.boundary.size(), 2u * (4 * 6 + 4 * 2 + 6 * 2));
  EXPECT_NEAR(volume_by_boundary(mesh), 6, 1e-12);
}

TEST(BoxMesh, BoundaryFacesLieOnTheirSides) {
  BoxMeshSpec spec = box({0, 0, 0}, {2, 3, 4}, 1);
  const Mesh mesh = make_mesh(spec);
  for (const BoundaryFace& face : mesh.boundary) {
    const int side = face.group.index, axis = side / 2;
    const double wanted = side % 2 == 0 ? 0 : spec.to[static_cast<size_t>(axis)];
    for (const int n : face.nodes()) EXPECT_EQ(node(mesh, n)[axis], wanted);
    const Eigen::Vector3d normal =
        (node(mesh, face.places[1]) - node(mesh, face.places[0]))
            .cross(node(mesh, face.places[2]) - node(mesh, face.places[0]));
    EXPECT_GT(normal[axis] * (side % 2 == 0 ? -1 : 1), 0);
  }
}

TEST(BoxMesh, LayersAndBoxRegionsEndOnGridLines) {
  BoxMeshSpec spec = box({0, 0, -10}, {10, 10, 0}, 1);
  spec.layers = {{"", "", 0}, {"", "", 3.3}, {"", "", 7.1}};
  spec.layer_materials = {4, 5, 6};
  spec.regions.resize(2);
  spec.regions[0] = {"", RegionShape::box, {2.2, -5, -7.1}, {6.6, 20, -3.3}};
  spec.regions[1] = {"", RegionShape::box, {6.6, 0, -7.1}, {20, 10, -3.3}};
  const Mesh mesh = make_mesh(spec);
  check_mesh(mesh);
  EXPECT_NEAR(region_volume(mesh, 0), 4.4 * 10 * 3.8, 1e-9);
  EXPECT_NEAR(region_volume(mesh, 1), 3.4 * 10 * 3.8, 1e-9);
  double volume[7] = {};
  for (size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    volume[mesh.material[cell]] += cell_volume(mesh, cell);
    if (mesh.region[cell] >= 0) {
      EXPECT_EQ(mesh.region_fraction[cell], 1);
    }
  }
  EXPECT_NEAR(volume[4], 330, 1e-9);
  EXPECT_NEAR(volume[5], 380, 1e-9);
  EXPECT_NEAR(volume[6], 290, 1e-9);
}

TEST(BoxMesh, DiscFractionsAddUpToTheDisc) {
  BoxMeshSpec spec = box({-100, -100, -60}, {100, 100, 0}, 7, 1.3);
  spec.regions = {{"", RegionShape::disc, {}, {}, {3, -5, -30}, 40, 11}};
  const Mesh mesh = make_mesh(spec);
  check_mesh(mesh);
  const double exact = M_PI * 40 * 40 * 11;
  EXPECT_NEAR(region_volume(mesh, 0), exact, 1e-5 * exact);
  EXPECT_EQ(make_mesh(spec).region_fraction, mesh.region_fraction);
}

TEST(BoxMesh, QuarterOfADiscAtASymmetryCorner) {
  BoxMeshSpec spec = box({0, 0, -60}, {100, 100, 0}, 7, 1.3);
  spec.regions = {{"", RegionShape::disc, {}, {}, {0, 0, -30}, 40, 11}};
  const double exact = M_PI * 40 * 40 * 11 / 4;
  EXPECT_NEAR(region_volume(make_mesh(spec), 0), exact, 1e-5 * exact);
}

TEST(BoxMesh, WithoutPatchesCellsAreFineAtTheRegionsAndGrowAway) {
  BoxMeshSpec spec = box({-20e3, -20e3, -20e3}, {20e3, 20e3, 0}, 200, 1.3);
  spec.regions = {{"", RegionShape::disc, {}, {}, {0, 0, -2000}, 2000, 200}};
  std::vector<Problem> problems;
  const GridLines lines = grid_lines(spec, problems);
  EXPECT_TRUE(problems.empty());
  EXPECT_LT(lines[0].size(), 60u);
  EXPECT_LT(lines[2].size(), 50u);
}

TEST(BoxMesh, TiesOppositeFacesWithoutChains) {
  BoxMeshSpec spec = box({0, 0, 0}, {2, 3, 4}, 1);
  spec.tied = {true, true, false};
  spec.patches = {{{1, 1, 2}, 0, 90 * kDegree, 100, 100}};
  const Mesh mesh = make_mesh(spec);
  check_mesh(mesh);
  std::set<int> roots(mesh.tied_to.begin(), mesh.tied_to.end());
  EXPECT_EQ(roots.size(), 2u * 3 * 6);  // 2 x 3 independent places, 5 levels and one duplicated
  const FaultSurface& fault = mesh.faults[0];
  EXPECT_EQ(fault.nodes.size(), 6u);
  EXPECT_EQ(fault.node_of_point.size(), 12u);
  for (const FaultNode& one : fault.nodes) EXPECT_NEAR(one.area, 1, 1e-12);
  for (const int n : fault.node_of_point) EXPECT_GE(n, 0);
  // A tied plus copy goes to a plus copy.
  for (size_t n = 0; n < mesh.nodes.size(); ++n) {
    const int root = mesh.tied_to[n];
    const bool is_plus = n >= 3u * 4 * 5, root_is_plus = root >= 3 * 4 * 5;
    EXPECT_EQ(is_plus, root_is_plus);
    EXPECT_EQ(mesh.nodes[n].z(), node(mesh, root).z());
  }
}

TEST(BoxMesh, OneCellColumnWithTiesIsASpringSlider) {
  BoxMeshSpec spec = box({0, 0, -2}, {1, 1, 2}, 1);
  spec.tied = {true, true, false};
  spec.patches = {{{0.5, 0.5, 0}, 0, 90 * kDegree, 10, 10}};
  const Mesh mesh = make_mesh(spec);
  check_mesh(mesh);
  EXPECT_EQ(mesh.cells.size(), 4u);
  ASSERT_EQ(mesh.faults[0].nodes.size(), 1u);
  EXPECT_NEAR(mesh.faults[0].nodes[0].area, 1, 1e-14);
}

TEST(BoxMesh, PlaneStrainHasOneCellInYAndAreasPerMetre) {
  BoxMeshSpec spec = box({-20, 0, -20}, {20, 0.5, 20}, 0.25, 1.3);
  spec.plane_strain = true;
  spec.patches = {{{0, 7, 0}, 0, 90 * kDegree, 1, 2}};
  const Mesh mesh = make_mesh(spec);
  check_mesh(mesh);
  EXPECT_EQ(mesh.thickness, 0.5);
  const FaultSurface& fault = mesh.faults[0];
  EXPECT_EQ(fault.nodes.size(), 7u);
  for (const FaultNode& one : fault.nodes) EXPECT_NEAR(one.area, 0.25, 1e-12);
  EXPECT_NEAR(face_area(fault), 2, 1e-12);
  spec.patches = {{{0, 0, 0}, 0, 20 * kDegree, 1, 10}};
  EXPECT_NEAR(face_area(make_mesh(spec).faults[0]), 10, 1e-9);
}

TEST(BoxMesh, RefusesWhatCannotBeMeshed) {
  const auto pointers = [](auto change) {
    BoxMeshSpec spec = box({-10, -10, -10}, {10, 10, 10}, 1);
    spec.patches = {{{0, 0, 0}, 0, 0, 6, 6}};
    change(spec);
    return problem_pointers(spec);
  };
  EXPECT_EQ(pointers([](BoxMeshSpec&) {}), List{});
  EXPECT_EQ(pointers([](BoxMeshSpec& s) { s.sizes.strike = 1e-6; }), List(3, "/mesh"));
  EXPECT_EQ(pointers([](BoxMeshSpec& s) { s.patches[0].center[0] = 11; }), List{"/faults/0"});
  EXPECT_EQ(pointers([](BoxMeshSpec& s) { s.patches[0].center[1] = 14; }), List{"/faults/0"});
  EXPECT_EQ(pointers([](BoxMeshSpec& s) { s.plane_strain = true, s.patches[0].strike = 0.3; }),
            List{"/faults/0/strike"});
  // Two patches of different axes, two that cross, two that overlap on one plane.
  EXPECT_EQ(pointers([](BoxMeshSpec& s) {
              s.patches.push_back({{0, 5, 0}, 90 * kDegree, 0, 2, 2});
            }),
            List{"/faults"});
  EXPECT_EQ(pointers([](BoxMeshSpec& s) {
              s.patches.push_back({{0.5, 0, 0}, 0, 30 * kDegree, 6, 6});
            }),
            List{"/faults/1"});
  EXPECT_EQ(pointers([](BoxMeshSpec& s) {
              s.patches.push_back({{0, 4, 0}, 0, 0, 6, 6});
            }),
            List{"/faults/1"});
  // A plane that leaves through the side of a narrow box.
  EXPECT_EQ(pointers([](BoxMeshSpec& s) {
              s.from[0] = -2, s.to[0] = 2;
              s.patches[0].width = 20, s.patches[0].dip_from_vertical = 40 * kDegree;
            }),
            List{"/faults/0"});
  // Smaller than a cell; a body of too many cells.
  EXPECT_EQ(pointers([](BoxMeshSpec& s) { s.patches[0].width = 0.5; }), List{"/faults"});
  EXPECT_EQ(pointers([](BoxMeshSpec& s) { s.sizes = {0.01, 0.01, 0.01, 1, 0, 0}; }), List{"/mesh"});
  // Regions.
  EXPECT_EQ(pointers([](BoxMeshSpec& s) {
              s.regions = {{"", RegionShape::box, {0, 0, 0}, {2, 2, 2}},
                           {"", RegionShape::box, {1, 1, 1}, {3, 3, 3}}};
            }),
            List{"/geometry/regions/1"});
  EXPECT_EQ(pointers([](BoxMeshSpec& s) {
              s.regions = {{"", RegionShape::box, {20, 0, 0}, {22, 2, 2}}};
            }),
            List{"/geometry/regions/0"});
  // A tied face that a fault cuts on one side only; a grid sheared between tied faces.
  EXPECT_EQ(pointers([](BoxMeshSpec& s) { s.tied[1] = true, s.patches[0].center[1] = 9; }),
            List{"/faults"});
  EXPECT_EQ(pointers([](BoxMeshSpec& s) {
              s.tied[1] = true, s.patches[0].length = 100, s.patches[0].strike = 0.2;
            }),
            List{"/faults"});
}

TEST(CheckQuality, RefusesAnInvertedCellWithItsPlace) {
  Mesh mesh = make_mesh(box({0, 0, 0}, {3, 3, 3}, 1));
  EXPECT_NEAR(check_quality(mesh).min_scaled_jacobian, 1, 1e-14);
  EXPECT_NEAR(check_quality(mesh).max_aspect, 1, 1e-14);
  mesh.nodes[21] += Eigen::Vector3d(1.2, 0, 0);
  const MeshQuality quality = check_quality(mesh);
  EXPECT_LT(quality.min_scaled_jacobian, 0.1);
  EXPECT_NE(quality.refusal.find("too distorted"), std::string::npos);
  EXPECT_LT((quality.worst_position - mesh.nodes[21]).norm(), 1.5);
}

TEST(CheckQuality, RefusesNotANumber) {
  Mesh mesh = make_mesh(box({0, 0, 0}, {2, 2, 2}, 1));
  mesh.nodes[3].y() = std::nan("");
  EXPECT_NE(check_quality(mesh).refusal, "");
}

TEST(CheckQuality, ReportsTheAspect) {
  BoxMeshSpec spec = box({0, 0, 0}, {4, 4, 4}, 1);
  spec.sizes.strike = 0.25;
  EXPECT_NEAR(check_quality(make_mesh(spec)).max_aspect, 4, 1e-12);
}

}  // namespace
}  // namespace faultsim
