// What is read of a sound file: text and binary, first and second order, groups and their names.
#include "simulator/gmsh/gmsh_mesh.h"

#include <gmock/gmock.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "tests/unit/gmsh/gmsh_fixture.h"
#include "tests/unit/gmsh/msh_writer.h"

namespace faultsim {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Facet = std::array<int, 4>;

void expect_two_tetrahedra(const GmshMesh& mesh) {
  ASSERT_EQ(mesh.nodes.size(), 5u);
  EXPECT_EQ(mesh.nodes[0], Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(mesh.nodes[1], Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(mesh.nodes[2], Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(mesh.nodes[3], Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(mesh.nodes[4], Eigen::Vector3d(1, 1, 1));
  EXPECT_THAT(mesh.node_tags, ElementsAre(1, 2, 3, 4, 5));
  EXPECT_EQ(mesh.corners_per_cell, 4);
  EXPECT_THAT(mesh.cells, ElementsAre(0, 1, 2, 3, 1, 2, 3, 4));
  EXPECT_THAT(mesh.cell_group, ElementsAre(1, 0));
  EXPECT_THAT(mesh.cell_groups, ElementsAre("east", "west"));
  EXPECT_THAT(mesh.facets, ElementsAre(Facet{1, 2, 3, -1}));
  EXPECT_THAT(mesh.facet_group, ElementsAre(0));
  EXPECT_THAT(mesh.facet_groups, ElementsAre("fault"));
  EXPECT_EQ(mesh.largest_bend, 0);
}

TEST(GmshMesh, IsTheSameFromTextAndBinaryOfBothByteOrders) {
  const msh::File file = msh::two_tetrahedra();
  expect_two_tetrahedra(read_bytes(msh::text(file)));
  expect_two_tetrahedra(read_bytes(msh::text(file, "\r\n")));
  expect_two_tetrahedra(read_bytes(msh::binary(file, msh::ByteOrder::little)));
  expect_two_tetrahedra(read_bytes(msh::binary(file, msh::ByteOrder::big)));
}

TEST(GmshMesh, ReadsTextWithBlanksAndEmptyLines) {
  std::string text = replaced(msh::text(msh::two_tetrahedra()), "\n", " \t\n\n  ");
  text = replaced(text, "  $", "$");
  expect_two_tetrahedra(read_bytes(text));
  expect_two_tetrahedra(read_bytes(text.substr(0, text.find_last_not_of(" \t\n") + 1)));
}

TEST(GmshMesh, SkipsCoordinatesWithinEntities) {
  msh::File file = msh::two_tetrahedra();
  file.nodes = {{0, 1, {1}, {{0, 0, 0}}},
                {1, 1, {2}, {{1, 0, 0, 91}}},
                {2, 7, {3, 4}, {{0, 1, 0, 92, 93}, {0, 0, 1, 94, 95}}},
                {3, 2, {5}, {{1, 1, 1, 96, 97, 98}}}};
  expect_two_tetrahedra(read_bytes(msh::text(file)));
  expect_two_tetrahedra(read_bytes(msh::binary(file, msh::ByteOrder::little)));
  file.nodes[0].points[0] = {0, 0, 0};
  std::string text = msh::text(file);
  text = changed(text, "\n0 1 0 1 \n", "\n0 1 1 1 \n");  // a point has no coordinates within
  expect_two_tetrahedra(read_bytes(text));
}

TEST(GmshMesh, ReadsNodeTagsOfAnySizeAndOrder) {
  msh::File file = msh::two_tetrahedra();
  const std::map<std::uint64_t, std::uint64_t> tag{
      {1, std::uint64_t{1} << 62}, {2, 77}, {3, 5'000'000'000}, {4, 4}, {5, 1}};
  for (msh::NodeBlock& block : file.nodes) {
    for (std::uint64_t& one : block.tags) one = tag.at(one);
  }
  for (msh::ElementBlock& block : file.elements) {
    for (auto& row : block.rows)
      std::transform(row.begin() + 1, row.end(), row.begin() + 1,
                     [&](std::uint64_t one) { return tag.at(one); });
  }
  for (const std::string& bytes : {msh::text(file), msh::binary(file, msh::ByteOrder::big)}) {
    const GmshMesh mesh = read_bytes(bytes);
    EXPECT_THAT(mesh.node_tags, ElementsAre(std::int64_t{1} << 62, 77, 5'000'000'000, 4, 1));
    EXPECT_THAT(mesh.cells, ElementsAre(0, 1, 2, 3, 1, 2, 3, 4));
  }
}

TEST(GmshMesh, KeepsOnlyNodesThatAreCornersOfCellsInTheOrderOfTheFile) {
  msh::File file = msh::two_tetrahedra();
  file.nodes[0].tags = {9, 1, 8};
  file.nodes[0].points = {{5, 5, 5}, {0, 0, 0}, {6, 6, 6}};
  std::swap(file.nodes[0], file.nodes[2]);
  const GmshMesh mesh = read_bytes(msh::text(file));
  EXPECT_THAT(mesh.node_tags, ElementsAre(5, 2, 3, 4, 1));
  EXPECT_THAT(mesh.cells, ElementsAre(4, 1, 2, 3, 1, 2, 3, 0));
  EXPECT_EQ(mesh.nodes[4], Eigen::Vector3d(0, 0, 0));
}

TEST(GmshMesh, IgnoresPointsLinesAndSurfacesWithoutAGroup) {
  msh::File file = msh::two_tetrahedra();
  file.entities[1].physical = {};
  file.elements.push_back({0, 1, 15, {{11, 1}}});
  file.elements.push_back({1, 1, 1, {{12, 1, 2}}});
  file.elements.push_back({1, 1, 8, {{13, 1, 2, 999}}});
  for (const std::string& bytes : {msh::text(file), msh::binary(file, msh::ByteOrder::little)}) {
    const GmshMesh mesh = read_bytes(bytes);
    EXPECT_THAT(mesh.facets, IsEmpty());
    EXPECT_THAT(mesh.facet_group, IsEmpty());
    EXPECT_THAT(mesh.facet_groups, IsEmpty());
    EXPECT_EQ(mesh.cell_group.size(), 2u);
  }
  file.elements[0] = {2, 7, 10, {{1, 2, 3, 4, 5, 999, 999, 999, 999, 999}}};
  EXPECT_EQ(refusal(msh::text(file)), "");  // of an order that is not read, in no group
}

TEST(GmshMesh, SkipsSectionsThatItDoesNotRead) {
  const std::string skipped =
      "$Comments\n$Nodes is a word, and so is\n$EndNodes\n$EndComment\n$EndComments\n"
      "$Periodic\n1\n0 1 2\n$EndPeriodic\n\n$NodeData\n\x01\n$EndNodeData\n";
  const std::string text = msh::text(msh::two_tetrahedra());
  expect_two_tetrahedra(read_bytes(changed(text, "$Entities\n", skipped + "$Entities\n")));
  expect_two_tetrahedra(read_bytes(text + skipped));
  const std::string binary = msh::binary(msh::two_tetrahedra(), msh::ByteOrder::big);
  expect_two_tetrahedra(read_bytes(changed(binary, "$Entities\n", skipped + "$Entities\n")));
}

TEST(GmshMesh, ListsFacetsOfSeveralGroupsOnceInEach) {
  msh::File file = msh::two_tetrahedra();
  file.names.push_back({2, 9, "all"});
  file.entities[1].physical = {9, -4, 9};  // turned over, and twice: the same group
  file.entities.insert(file.entities.begin() + 2, {2, 8, {9}});
  file.elements[0].rows.push_back({5, 1, 2, 3});
  file.elements.push_back({2, 8, 2, {{6, 3, 4, 5}}});
  const GmshMesh mesh = read_bytes(msh::text(file));
  EXPECT_THAT(mesh.facet_groups, ElementsAre("fault", "all"));
  EXPECT_THAT(mesh.facets, ElementsAre(Facet{1, 2, 3, -1}, Facet{0, 1, 2, -1}, Facet{1, 2, 3, -1},
                                       Facet{0, 1, 2, -1}, Facet{2, 3, 4, -1}));
  EXPECT_THAT(mesh.facet_group, ElementsAre(0, 0, 1, 1, 1));
}

TEST(GmshMesh, CallsGroupsWithoutANameByTheirNumber) {
  msh::File file = msh::two_tetrahedra();
  file.names = {{3, 3, ""}, {2, 10, "elsewhere"}};
  const GmshMesh mesh = read_bytes(msh::text(file));
  EXPECT_THAT(mesh.cell_groups, ElementsAre("physical volume 3", "physical volume 10"));
  EXPECT_THAT(mesh.facet_groups, ElementsAre("physical surface 4"));
  file.names = {};  // and no section of names
  EXPECT_EQ(read_bytes(msh::text(file)).cell_groups, mesh.cell_groups);
}

TEST(GmshMesh, KeepsNamesAsTheyAre) {
  msh::File file = msh::two_tetrahedra();
  file.names[0].name = "St\xC3\xB6rung \"A\" ";
  file.names[1].name = "fault";  // names are those of a dimension
  file.names.push_back({3, 99, "nowhere"});
  const GmshMesh mesh = read_bytes(msh::binary(file, msh::ByteOrder::little));
  EXPECT_THAT(mesh.facet_groups, ElementsAre("St\xC3\xB6rung \"A\" "));
  EXPECT_THAT(mesh.cell_groups, ElementsAre("fault", "west"));
}

TEST(GmshMesh, PutsTogetherVolumesOfOneGroup) {
  msh::File file = msh::two_tetrahedra();
  file.entities[2].physical = {3};
  const GmshMesh mesh = read_bytes(msh::text(file));
  EXPECT_THAT(mesh.cell_groups, ElementsAre("east"));
  EXPECT_THAT(mesh.cell_group, ElementsAre(0, 0));
}

/// A tetrahedron of second order, whose nodes amid sides lie d = (0, 0, d_k) from the middle.
msh::File quadratic(const std::array<double, 6>& d) {
  msh::File file;
  file.entities = {{2, 1, {1}}, {3, 1, {1}}};
  const std::vector<std::vector<double>> corners = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}};
  file.nodes = {{3, 1, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, corners}};
  const int sides[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {2, 3}, {1, 3}};  // in Gmsh's order
  for (std::size_t k = 0; k < 6; ++k) {
    std::vector<double> middle(3);
    for (std::size_t i = 0; i < 3; ++i)
      middle[i] = (corners[static_cast<std::size_t>(sides[k][0])][i] +
                   corners[static_cast<std::size_t>(sides[k][1])][i]) /
                  2;
    middle[2] += d[k];
    file.nodes[0].points.push_back(middle);
  }
  file.elements = {{2, 1, 9, {{1, 1, 2, 3, 5, 6, 7}}},
                   {3, 1, 11, {{2, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}}}};
  return file;
}

TEST(GmshMesh, ReducesSecondOrderToCorners) {
  const GmshMesh mesh = read_bytes(msh::text(quadratic({})));
  EXPECT_EQ(mesh.nodes.size(), 4u);
  EXPECT_THAT(mesh.cells, ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(mesh.facets, ElementsAre(Facet{0, 1, 2, -1}));
  EXPECT_EQ(mesh.largest_bend, 0);
}

TEST(GmshMesh, MeasuresTheBendOfEverySide) {
  for (std::size_t k = 0; k < 6; ++k) {
    std::array<double, 6> d{};
    d[k] = k % 2 == 0 ? 0.25 : -0.25;
    d[(k + 1) % 6] = 0.125;
    EXPECT_DOUBLE_EQ(read_bytes(msh::text(quadratic(d))).largest_bend, 0.25) << k;
  }
  msh::File file = quadratic({});  // a facet alone is bent
  file.nodes[0].tags.push_back(11);
  file.nodes[0].points.push_back({0, 1.5, 0});
  file.elements[0].rows[0][6] = 11;
  EXPECT_DOUBLE_EQ(read_bytes(msh::text(file)).largest_bend, 0.5);
}

TEST(GmshMesh, ReadsHexahedraAndQuadrangles) {
  msh::File file;
  file.names = {{2, 1, "top"}, {3, 1, "rock"}};
  file.entities = {{2, 1, {1}}, {3, 1, {1}}};
  file.nodes = {{3, 1, {}, {}}};
  for (std::uint64_t i = 0; i < 12; ++i) {
    file.nodes[0].tags.push_back(i + 1);
    file.nodes[0].points.push_back({i % 4 == 1 || i % 4 == 2 ? 1.0 : 0.0, i % 4 >= 2 ? 1.0 : 0.0,
                                    std::floor(static_cast<double>(i) / 4)});
  }
  file.elements = {{2, 1, 3, {{1, 9, 10, 11, 12}}},
                   {3, 1, 5, {{2, 1, 2, 3, 4, 5, 6, 7, 8}, {3, 5, 6, 7, 8, 9, 10, 11, 12}}}};
  const GmshMesh mesh = read_bytes(msh::binary(file, msh::ByteOrder::little));
  EXPECT_EQ(mesh.corners_per_cell, 8);
  EXPECT_THAT(mesh.cells, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 4, 5, 6, 7, 8, 9, 10, 11));
  EXPECT_THAT(mesh.cell_group, ElementsAre(0, 0));
  EXPECT_THAT(mesh.facets, ElementsAre(Facet{8, 9, 10, 11}));
}

TEST(GmshMesh, ReadsTetrahedraOfBothOrders) {
  msh::File file = quadratic({});
  file.nodes[0].tags.push_back(11);
  file.nodes[0].points.push_back({1, 1, 1});
  file.elements.push_back({3, 1, 4, {{3, 2, 3, 4, 11}}});
  EXPECT_THAT(read_bytes(msh::text(file)).cells, ElementsAre(0, 1, 2, 3, 1, 2, 3, 4));
}

/// A file that Gmsh wrote; two_boxes.geo says how.
TEST(GmshMesh, ReadsAFileOfGmsh) {
  const GmshMesh mesh = read_gmsh(FAULTSIM_SOURCE_DIR "/tests/cases/gmsh/two_boxes.msh");
  EXPECT_EQ(mesh.corners_per_cell, 4);
  EXPECT_THAT(mesh.cell_groups, ElementsAre("east", "west"));
  EXPECT_THAT(mesh.facet_groups, ElementsAre("crack", "both", "St\xC3\xB6rung A"));
  EXPECT_LT(mesh.largest_bend, 1e-9);
  std::map<std::set<int>, std::set<int>> groups_at;  // of the cells beside a face
  std::map<std::set<int>, int> n_cells;
  std::array<double, 2> volume{};
  for (std::size_t c = 0; c < mesh.cell_group.size(); ++c) {
    const int* corner = mesh.cells.data() + 4 * c;
    Eigen::Matrix4d frame = Eigen::Matrix4d::Ones();
    for (int k = 0; k < 4; ++k) {
      frame.col(k).head<3>() = mesh.nodes[static_cast<std::size_t>(corner[k])];
      std::set<int> face(corner, corner + 4);
      face.erase(corner[k]);
      groups_at[face].insert(mesh.cell_group[c]);
      ++n_cells[face];
    }
    volume[static_cast<std::size_t>(mesh.cell_group[c])] += frame.determinant() / 6;
  }
  EXPECT_NEAR(std::abs(volume[0]), 100 * 80 * 60, 1e-6);
  EXPECT_NEAR(std::abs(volume[1]), 100 * 80 * 60, 1e-6);
  std::array<int, 3> n_facets{};
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const std::set<int> face(mesh.facets[f].begin(), mesh.facets[f].begin() + 3);
    EXPECT_EQ(n_cells[face], 2);
    const double x = mesh.nodes[static_cast<std::size_t>(mesh.facets[f][0])].x();
    EXPECT_EQ(groups_at[face].size(), x == 100 ? 2u : 1u);  // between the boxes; within the east
    ++n_facets[static_cast<std::size_t>(mesh.facet_group[f])];
  }
  EXPECT_EQ(n_facets[1], n_facets[0] + n_facets[2]);
  EXPECT_GT(n_facets[0], 0);
  EXPECT_GT(n_facets[2], 0);
}

}  // namespace
}  // namespace faultsim
