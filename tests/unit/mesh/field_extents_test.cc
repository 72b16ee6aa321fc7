// Blocks of a field that end along strike where they say.
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

TEST(FieldExtents, PlaneStrainTakesBlocksAsEndless) {
  FieldMeshSpec spec = small_field();
  spec.plane_strain = true;
  const Mesh common = make_mesh(spec);
  spec.blocks[0].y_from = 500, spec.blocks[0].y_to = 600;
  expect_same_bits(make_mesh(spec), common);
}

}  // namespace
}  // namespace faultsim
