#include "simulator/common/units.h"
#include "tests/unit/mesh/mesh_checks.h"

/// Patches of any orientation: they lie on the plane asked for, their edges on grid lines, and
/// areas add up.
namespace faultsim {
namespace {

using namespace testing_mesh;

BoxMeshSpec body() {
  BoxMeshSpec spec;
  spec.from = {-20, -20, -20}, spec.to = {20, 20, 20};
  spec.layer_materials = {0};
  spec.fault_names = {"a", "c", "b"};
  spec.sizes = {1, 1, 1, 1.3, 0, 0};
  spec.plane_strain = false;
  return spec;
}

Eigen::Vector3d along(const PatchGeometry& patch) {
  return {std::sin(patch.strike), std::cos(patch.strike), 0};
}
Eigen::Vector3d down(const PatchGeometry& patch) {
  const double s = patch.strike, d = patch.dip_from_vertical;
  return {std::sin(d) * std::cos(s), -std::sin(d) * std::sin(s), -std::cos(d)};
}
Eigen::Vector3d centre(const PatchGeometry& patch) {
  return {patch.center[0], patch.center[1], patch.center[2]};
}

TEST(BoxPatch, ThroughGoingPlanesHaveTheExactAreaAtAnyDip) {
  for (const double dip : {-45.0, -25.0, 0.0, 10.0, 25.0, 40.0}) {
    SCOPED_TRACE(dip);
    BoxMeshSpec spec = body();
    spec.from[2] = -12, spec.to[2] = 12;
    spec.patches = {{{1, 0, 0}, 0, dip * kDegree, 1000, 1000}};
    const Mesh mesh = make_mesh(spec);
    check_mesh(mesh);
    const double exact = 40 * 24 / std::cos(dip * kDegree);
    EXPECT_NEAR(node_area(mesh.faults[0]), exact, 1e-9 * exact);
    EXPECT_NEAR(face_area(mesh.faults[0]), exact, 1e-9 * exact);
    EXPECT_NEAR(total_volume(mesh), 40 * 40 * 24, 1e-8);
    const FaultNode& one = mesh.faults[0].nodes[0];
    EXPECT_NEAR(one.normal.x(), std::cos(dip * kDegree), 1e-14);
    EXPECT_NEAR(one.normal.z(), std::sin(dip * kDegree), 1e-14);
  }
}

TEST(BoxPatch, ThroughGoingPlanesMayHaveStrikeAndDip) {
  BoxMeshSpec spec = body();
  spec.patches = {{{0, 0, 0}, 20 * kDegree, 15 * kDegree, 1000, 1000}};
  const Mesh mesh = make_mesh(spec);
  check_mesh(mesh);
  const double exact = 40 * 40 / mesh.faults[0].nodes[0].normal.x();
  EXPECT_NEAR(node_area(mesh.faults[0]), exact, 1e-9 * exact);
  EXPECT_NEAR(total_volume(mesh), 64e3, 1e-7);
}

TEST(BoxPatch, RectanglesEndOnGridLinesWhateverTheirStrikeAndDip) {
  for (const double strike : {0.0, 15.0, -30.0, 90.0, 75.0, 120.0, 180.0, 200.0, 270.0})
    for (const double dip : {0.0, 20.0, -30.0}) {
      SCOPED_TRACE(::testing::Message() << "strike " << strike << " dip " << dip);
      BoxMeshSpec spec = body();
      spec.patches = {{{1, -1, 2}, strike * kDegree, dip * kDegree, 10, 8}};
      const Mesh mesh = make_mesh(spec);
      check_mesh(mesh);
      const FaultSurface& fault = mesh.faults[0];
      EXPECT_NEAR(face_area(fault), 80, 1e-9);
      const PatchGeometry& patch = spec.patches[0];
      double max_u = 0, max_v = 0;
      for (size_t k = 0; k < fault.points.size(); ++k) {
        const Eigen::Vector3d local = fault.points[k] - centre(patch);
        EXPECT_NEAR(local.dot(along(patch).cross(down(patch))), 0, 1e-9);
        const double u = std::abs(local.dot(along(patch))), v = std::abs(local.dot(down(patch)));
        EXPECT_EQ(fault.node_of_point[k] >= 0, u < 5 - 1e-6 && v < 4 - 1e-6);
        max_u = std::max(max_u, u);
        max_v = std::max(max_v, v);
      }
      EXPECT_NEAR(max_u, 5, 1e-9);
      EXPECT_NEAR(max_v, 4, 1e-9);
      // Rows go down dip.
      EXPECT_GT((fault.points[1] - fault.points[0]).dot(fault.nodes[0].dip), 0);
      EXPECT_NEAR(total_volume(mesh), 64e3, 1e-6);
    }
}

TEST(BoxPatch, FlatPatchesLieOnABentHorizontalGridPlane) {
  BoxMeshSpec spec = body();
  for (const double strike : {0.0, 90.0, 180.0})
    for (const double dip : {90.0, 70.0, -60.0, -90.0}) {
      SCOPED_TRACE(::testing::Message() << "strike " << strike << " dip " << dip);
      spec.patches = {{{1, -1, 2}, strike * kDegree, dip * kDegree, 10, 8}};
      const Mesh mesh = make_mesh(spec);
      check_mesh(mesh);
      EXPECT_NEAR(face_area(mesh.faults[0]), 80, 1e-9);
      EXPECT_GT(mesh.faults[0].nodes[0].normal.z(), 0.7);
      if (std::abs(dip) == 90) {
        EXPECT_LT((mesh.faults[0].nodes[0].strike - along(spec.patches[0])).norm(), 1e-9);
      }
    }
}

TEST(BoxPatch, EllipsesSplitTheNodesStrictlyInside) {
  for (const double dip : {0.0, 30.0, 90.0}) {
    SCOPED_TRACE(dip);
    BoxMeshSpec spec = body();
    spec.sizes = {0.5, 0.5, 0.5, 1.3, 0, 0};
    spec.patches = {{{0, 0, 0}, 25 * kDegree, dip * kDegree, 8, 6, PatchShape::ellipse}};
    const Mesh mesh = make_mesh(spec);
    check_mesh(mesh);
    const FaultSurface& fault = mesh.faults[0];
    const PatchGeometry& patch = spec.patches[0];
    for (size_t k = 0; k < fault.points.size(); ++k) {
      const double u = fault.points[k].dot(along(patch)) / 4,
                   v = fault.points[k].dot(down(patch)) / 3;
      EXPECT_EQ(fault.node_of_point[k] >= 0, u * u + v * v < 1 - 1e-6);
    }
    EXPECT_NEAR(node_area(fault), M_PI * 12, 0.1 * M_PI * 12);
    EXPECT_LT(node_area(fault), face_area(fault));
  }
}

TEST(BoxPatch, CentreOfACircularPatchIsSymmetric) {
  BoxMeshSpec spec = body();
  spec.patches = {{{0, 0, 0}, 0, 90 * kDegree, 8, 8, PatchShape::ellipse}};
  const Mesh mesh = make_mesh(spec);
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  for (const FaultNode& one : mesh.faults[0].nodes) first += one.area * node(mesh, one.minus_node);
  EXPECT_NEAR(first.norm(), 0, 1e-9);
}

TEST(BoxPatch, SeveralFaultsSplitEachOnTheirPlane) {
  BoxMeshSpec spec = body();
  spec.patches = {{{-8, 0, 0}, 0, 20 * kDegree, 1000, 1000},
                  {{9, 0, 0}, 10 * kDegree, 0, 1000, 1000},
                  {{0, 2, 0}, 0, 0, 10, 10}};
  spec.from[2] = -10, spec.to[2] = 10;
  const Mesh mesh = make_mesh(spec);
  check_mesh(mesh);
  ASSERT_EQ(mesh.faults.size(), 3u);
  EXPECT_EQ(mesh.faults[1].name, "c");
  EXPECT_NEAR(node_area(mesh.faults[0]), 40 * 20 / std::cos(20 * kDegree), 1e-8);
  EXPECT_NEAR(node_area(mesh.faults[1]), 40 * 20 / std::cos(10 * kDegree), 1e-8);
  EXPECT_NEAR(face_area(mesh.faults[2]), 100, 1e-9);
}

TEST(BoxPatch, ParallelPatchesMayBeNearWhereTheirRangesDiffer) {
  BoxMeshSpec spec = body();
  spec.patches = {{{0, -6, 0}, 30 * kDegree, 0, 6, 6}, {{3, 6, 0}, 30 * kDegree, 0, 6, 6}};
  const Mesh mesh = make_mesh(spec);
  check_mesh(mesh);
  EXPECT_NEAR(face_area(mesh.faults[0]), 36, 1e-9);
  EXPECT_NEAR(face_area(mesh.faults[1]), 36, 1e-9);
}

TEST(BoxPatch, TwoPatchesMayShareAPlaneAndAnEdge) {
  BoxMeshSpec spec = body();
  const double dip = 20 * kDegree;
  const Eigen::Vector3d step = 3 * Eigen::Vector3d(std::sin(dip), 0, -std::cos(dip));
  spec.patches = {{{-step.x(), 0, -step.z()}, 0, dip, 10, 6},
                  {{step.x(), 0, step.z()}, 0, dip, 10, 6}};
  const Mesh mesh = make_mesh(spec);
  check_mesh(mesh);
  EXPECT_NEAR(face_area(mesh.faults[0]), 60, 1e-9);
  EXPECT_NEAR(face_area(mesh.faults[1]), 60, 1e-9);
}

TEST(BoxPatch, RegionsEndOnASlantedFault) {
  // Both sides of a displaced fault (V4): left y in (-1.5, 0.75), right in (-0.75, 1.5), times 10.
  BoxMeshSpec spec = body();
  spec.from = {-200, 0, -100}, spec.to = {200, 1, 100};
  spec.plane_strain = true;
  spec.sizes = {1, 2.5, 2.5, 1.2, 0, 0};
  spec.patches = {{{0, 0.5, 0}, 0, 20 * kDegree, 10, 80}};
  spec.regions = {{"", RegionShape::box, {-200, 0, -15}, {0, 1, 7.5}},
                  {"", RegionShape::box, {0, 0, -7.5}, {200, 1, 15}}};
  const Mesh mesh = make_mesh(spec);
  check_mesh(mesh);
  for (const FaultFace& face : mesh.faults[0].faces) {
    const double z = cell_centre(mesh, face.minus_cell).z();
    EXPECT_EQ(mesh.region[static_cast<size_t>(face.minus_cell)], z > -15 && z < 7.5 ? 0 : -1) << z;
    EXPECT_EQ(mesh.region[static_cast<size_t>(face.plus_cell)], z > -7.5 && z < 15 ? 1 : -1) << z;
  }
  // Left block: up to x = -z tan 20 deg, mean z = -3.75.
  EXPECT_NEAR(region_volume(mesh, 0), 22.5 * (200 + 3.75 * std::tan(20 * kDegree)), 1e-6);
}

TEST(BoxPatch, FineCellsAreKeptToTheMargin) {
  BoxMeshSpec spec = body();
  spec.patches = {{{0, 0, 0}, 0, 0, 6, 8}};
  spec.sizes = {1, 0.5, 0.25, 1.3, 3, 4};
  std::vector<Problem> problems;
  const GridLines lines = grid_lines(spec, problems);
  ASSERT_TRUE(problems.empty());
  const auto has = [](const std::vector<double>& line, double x) {
    return std::any_of(line.begin(), line.end(), [&](double v) { return std::abs(v - x) < 1e-9; });
  };
  for (int k = -6; k <= 6; ++k) EXPECT_TRUE(has(lines[1], k)) << k;
  for (int k = -14; k <= 14; ++k) EXPECT_TRUE(has(lines[2], 0.5 * k)) << k;
  for (const double x : {-0.25, 0.0, 0.25}) EXPECT_TRUE(has(lines[0], x)) << x;
  for (const auto& line : {lines[0], lines[1], lines[2]})
    for (size_t k = 1; k < line.size(); ++k) EXPECT_LE(line[k] - line[k - 1], 4 + 1e-9);
}

}  // namespace
}  // namespace faultsim
