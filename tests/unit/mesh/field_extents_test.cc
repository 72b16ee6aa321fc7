// Blocks and faults of a field that end where they say.
#include <gmock/gmock.h>

#include <map>

#include "tests/unit/mesh/mesh_checks.h"
#include "tests/unit/mesh/small_field.h"

namespace faultsim {
namespace {

using namespace testing_mesh;

/// Volume by region, and of sideburden.
std::map<int, double> volumes(const Mesh& mesh) {
  std::map<int, double> all;
  for (size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    const double volume = cell_volume(mesh, cell);
    if (mesh.region[cell] >= 0) all[mesh.region[cell]] += volume;
    if (mesh.material[cell] == kSideburden) all[-1] += volume;
  }
  return all;
}

std::set<double> lines_along(const Mesh& mesh) {
  std::set<double> lines;
  for (const Eigen::Vector3d& one : mesh.nodes) lines.insert(one.y());
  return lines;
}

void expect_same_bits(const Mesh& a, const Mesh& b) {
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.cells, b.cells);
  EXPECT_EQ(a.material, b.material);
  EXPECT_EQ(a.region, b.region);
  ASSERT_EQ(a.faults.size(), b.faults.size());
  for (size_t f = 0; f < a.faults.size(); ++f) {
    EXPECT_EQ(a.faults[f].points, b.faults[f].points);
    EXPECT_EQ(a.faults[f].node_of_point, b.faults[f].node_of_point);
  }
}

TEST(FieldExtents, OfAllBlocksAlikeAreTheMeshOfBlockLength) {
  for (const bool half_domain : {false, true}) {
    FieldMeshSpec spec = small_field();
    spec.half_domain = half_domain;
    const Mesh common = make_mesh(spec);
    for (Block& block : spec.blocks) block.y_from = -1000, block.y_to = 1000;
    spec.block_length = 1;  // of no block
    spec.fault_length = 1;  // of no fault
    spec.fault_extents.assign(3, {.y_from = -1200, .y_to = 1200, .overshoot = 150});
    spec.fault_overshoot = 1;  // of no fault
    expect_same_bits(make_mesh(spec), common);
  }
}

TEST(FieldExtents, BlocksEndWhereTheySay) {
  FieldMeshSpec spec = small_field();
  spec.blocks[0].y_from = -700, spec.blocks[0].y_to = 1900;
  spec.blocks[1].y_to = -250;
  const Mesh mesh = make_mesh(spec);
  check_mesh(mesh);
  const std::map<int, double> volume = volumes(mesh);
  const double width = 2000, height = 200;
  EXPECT_NEAR(volume.at(0), width * 2600 * height, 1);
  EXPECT_NEAR(volume.at(1), width * 750 * height, 1);
  // The layer's own depths are sideburden all beside: what lies above and below the east block's
  // reservoir, which is 50 m lower, has been left by it between its ends alone.
  const double layer = 20e3 * 20e3 * height;
  EXPECT_NEAR(volume.at(-1), layer - width * 2600 * height - width * 750 * height, 1);
  for (const double y : {-1000.0, -700.0, -250.0, 0.0, 1900.0})
    EXPECT_TRUE(lines_along(mesh).contains(y)) << y;
  EXPECT_FALSE(lines_along(mesh).contains(1000.0)) << "where no block ends";
  for (size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    const double y = cell_centre(mesh, static_cast<int>(cell)).y();
    EXPECT_TRUE(mesh.region[cell] != 0 || (y > -700 && y < 1900));
    EXPECT_TRUE(mesh.region[cell] != 1 || (y > -1000 && y < -250));
  }
}

/// Cells, sizes and nodes of a field seen in a mirror along y.
TEST(FieldExtents, AFieldSeenInAMirrorHasTheMeshSeenInIt) {
  FieldMeshSpec spec = small_field();
  spec.blocks[0].y_from = -700, spec.blocks[0].y_to = 1900;
  spec.blocks[1].y_to = -250;
  const std::set<double> here = lines_along(make_mesh(spec));
  spec.blocks[0].y_from = -1900, spec.blocks[0].y_to = 700;
  spec.blocks[1].y_from = 250, spec.blocks[1].y_to = 1000;
  const std::set<double> there = lines_along(make_mesh(spec));
  ASSERT_EQ(here.size(), there.size());
  auto one = here.begin();
  for (auto other = there.rbegin(); other != there.rend(); ++other, ++one)
    EXPECT_NEAR(*one, -*other, 1e-6);
}

/// Split nodes are those strictly within, and faces cover length times height.
TEST(FieldExtents, FaultsReachAsFarAsTheySay) {
  FieldMeshSpec spec = small_field();
  spec.fault_extents = {{.y_from = -2000}, {}, {.y_from = 300, .y_to = 1500, .overshoot = 400}};
  const Mesh mesh = make_mesh(spec);
  check_mesh(mesh);
  const double from[3] = {-2000, -1200, 300}, to[3] = {1200, 1200, 1500};
  const double top[3] = {1850, 1850, 2050 - 400}, foot[3] = {2350, 2400, 2250 + 400};
  for (size_t f = 0; f < 3; ++f) {
    SCOPED_TRACE(f);
    const FaultSurface& fault = mesh.faults[f];
    EXPECT_NEAR(face_area(fault), (to[f] - from[f]) * (foot[f] - top[f]), 1e-6);
    size_t n_inside = 0;
    for (const Eigen::Vector3d& p : mesh.nodes)
      n_inside += p.x() == spec.blocks[0].from + 2000 * static_cast<double>(f) &&
                  p.y() > from[f] + 1e-6 && p.y() < to[f] - 1e-6 && -p.z() > top[f] + 1e-6 &&
                  -p.z() < foot[f] - 1e-6;
    EXPECT_EQ(n_inside, 2 * fault.nodes.size()) << "each there twice";
    for (const double end : {from[f], to[f]}) EXPECT_TRUE(lines_along(mesh).contains(end)) << end;
  }
}

TEST(FieldExtents, AFaultsOwnOvershootIsBlamedForItself) {
  const auto pointers = [](const FieldMeshSpec& spec) {
    std::vector<std::string> all;
    try {
      make_mesh(spec);
    } catch (const InputError& error) {
      for (const Problem& one : error.problems()) all.push_back(one.pointer);
    }
    return all;
  };
  using List = std::vector<std::string>;
  FieldMeshSpec spec = small_field();
  spec.fault_extents = {{}, {}, {.overshoot = 2900}};
  EXPECT_EQ(pointers(spec), (List{"/faults/2/overshoot", "/faults/2/overshoot"})) << "top and foot";
  spec.fault_extents = {};
  spec.fault_overshoot = 2780;
  EXPECT_THAT(pointers(spec), testing::Contains("/geometry/blocks/1/offset"));
  EXPECT_THAT(pointers(spec), testing::Not(testing::Contains("/faults/2/overshoot")));
}

/// An end at that of the model is cut by it: its nodes are split, those of the other end are not.
TEST(FieldExtents, AFaultMayGoThroughOneEndOfTheModel) {
  FieldMeshSpec spec = small_field();
  spec.fault_extents = {{.y_to = 10e3}, {}, {}};
  const Mesh mesh = make_mesh(spec);
  check_mesh(mesh);
  const FaultSurface& fault = mesh.faults[0];
  size_t n_south = 0, n_north = 0;
  for (size_t k = 0; k < fault.points.size(); ++k) {
    if (fault.node_of_point[k] < 0) continue;
    n_south += fault.points[k].y() < -1200 + 1e-6;
    n_north += fault.points[k].y() > 10e3 - 1e-6;
  }
  EXPECT_EQ(n_south, 0u);
  EXPECT_GT(n_north, 2u);
  EXPECT_NEAR(face_area(fault), 11.2e3 * 500, 1e-5);
}

TEST(FieldExtents, PlaneStrainTakesBlocksAndFaultsAsEndless) {
  FieldMeshSpec spec = small_field();
  spec.plane_strain = true;
  const Mesh common = make_mesh(spec);
  spec.blocks[0].y_from = 500, spec.blocks[0].y_to = 600;
  spec.fault_extents = {{.y_from = 500}, {}, {.y_to = 0}};
  expect_same_bits(make_mesh(spec), common);
}

}  // namespace
}  // namespace faultsim
