// What is said of nodes and elements that do not fit together, and of kinds that are not read.
#include <gmock/gmock.h>

#include "tests/unit/gmsh/gmsh_fixture.h"

namespace faultsim {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::string kFirstOrder =
    "; use elements of first order: Mesh.ElementOrder = 1, or gmsh -order 1";
const std::string kOneShape = "; mesh all volumes with tetrahedra, or all with hexahedra";
const std::string kRenumber = "; renumber the nodes (RenumberMeshNodes) and save the mesh";

/// The tag of an element and its nodes 1, 2, ...
std::vector<std::uint64_t> row(std::uint64_t tag, std::uint64_t n_nodes) {
  std::vector<std::uint64_t> all{tag};
  for (std::uint64_t node = 1; node <= n_nodes; ++node) all.push_back(node);
  return all;
}

TEST(GmshElements, RefusesNodesThatAreThereTwice) {
  msh::File file = msh::two_tetrahedra();
  file.nodes[2] = {3, 2, {5, 2, 2}, {{1, 1, 1}, {2, 2, 2}, {3, 3, 3}}};
  const std::string twice = ": node 2 is given twice, first at line 24" + kRenumber;
  EXPECT_EQ(refusal(msh::text(file)), "mesh.msh:32" + twice + "\nmesh.msh:33" + twice);
  file.nodes[2].tags = {std::uint64_t{1} << 62, 5, 2};  // tags that are sorted
  EXPECT_EQ(refusal(msh::text(file)), "mesh.msh:33" + twice);
  const std::string bytes = msh::binary(file, msh::ByteOrder::little);
  const std::size_t nodes = bytes.find("$Nodes\n") + 7;
  EXPECT_EQ(refusal(bytes),
            concat("mesh.msh: byte ", nodes + 32 + 52 + 116 + 20 + 16,
                   ": node 2 is given twice, first at byte ", nodes + 32 + 52 + 20, kRenumber));
}

TEST(GmshElements, RefusesNodesWithoutANumber) {
  EXPECT_EQ(refusal(changed(sound_text(), "\n5 \n", "\n0 \n")),
            "mesh.msh:31: a node has the tag 0; number nodes from 1"
            "\nmesh.msh:41: tetrahedron 3 has node 5, which is not in $Nodes" +
                kAnew);
  EXPECT_EQ(refusal(changed(sound_text(), "\n5 \n", "\n-5 \n")),
            "mesh.msh:31: \"-5\" is not a whole number from 0 to 9223372036854775807 (expected: "
            "the tag of a node)" +
                kLine);
}

TEST(GmshElements, RefusesNodesThatAreNotThere) {
  for (const std::string node : {"6", "0", "4611686018427387904"}) {
    EXPECT_EQ(refusal(changed(sound_text(), "\n3 2 3 4 5 \n", "\n3 2 3 4 " + node + " \n")),
              "mesh.msh:41: tetrahedron 3 has node " + node + ", which is not in $Nodes" + kAnew);
  }
  EXPECT_EQ(refusal(changed(sound_text(), "\n1 2 3 4 \n", "\n1 2 3 8 \n")),
            "mesh.msh:37: triangle 1 has node 8, which is not in $Nodes" + kAnew);
  msh::File file = msh::two_tetrahedra();
  file.elements[2].rows[0][4] = 7;
  const std::string bytes = msh::binary(file, msh::ByteOrder::big);
  EXPECT_EQ(refusal(bytes),
            concat("mesh.msh: byte ", bytes.find("$Elements\n") + 10 + 32 + 52 + 60 + 20,
                   ": tetrahedron 3 has node 7, which is not in $Nodes", kAnew));
  // A node amid a side matters as well.
  file = msh::two_tetrahedra();
  file.elements[0] = {2, 7, 9, {{1, 2, 3, 4, 1, 5, 6}}};
  EXPECT_EQ(refusal(msh::text(file)),
            "mesh.msh:37: triangle 1 has node 6, which is not in $Nodes" + kAnew);
}

TEST(GmshElements, RefusesCornersThatAreThereTwice) {
  const std::string cure = "; remove duplicates from the geometry (Coherence) and mesh again";
  EXPECT_EQ(refusal(changed(sound_text(), "\n3 2 3 4 5 \n", "\n3 2 3 5 2 \n")),
            "mesh.msh:41: tetrahedron 3 has node 2 at two of its corners" + cure);
  EXPECT_EQ(refusal(changed(sound_text(), "\n1 2 3 4 \n", "\n1 2 4 4 \n")),
            "mesh.msh:37: triangle 1 has node 4 at two of its corners" + cure);
  msh::File file = msh::two_tetrahedra();  // the nodes amid sides may be corners: not looked at
  file.elements[0] = {2, 7, 9, {{1, 2, 3, 4, 3, 4, 2}}};
  EXPECT_EQ(refusal(msh::text(file)), "");
}

TEST(GmshElements, RefusesFacetsWithANodeThatNoCellHas) {
  msh::File file = msh::two_tetrahedra();
  file.nodes[0] = {0, 1, {1, 6}, {{0, 0, 0}, {7, 7, 7}}};
  file.elements[0].rows.push_back({4, 2, 6, 6 - 3});
  const std::string cure =
      "; make the surface one of the volumes' (BooleanFragments), or embed it (Surface{...} In "
      "Volume{...}), and mesh again";
  EXPECT_EQ(
      refusal(msh::text(file)),
      "mesh.msh:40: triangle 4 of \"fault\" has node 6, which is not a corner of a cell" + cure);
  // Not where a cell could not be put together, which may have it.
  EXPECT_EQ(refusal(changed(msh::text(file), "\n3 2 3 4 5 \n", "\n3 2 3 4 9 \n")),
            "mesh.msh:44: tetrahedron 3 has node 9, which is not in $Nodes" + kAnew);
}

TEST(GmshElements, RefusesMixedCells) {
  msh::File file = msh::two_tetrahedra();
  file.elements[2].rows.push_back({4, 1, 3, 4, 5});
  file.elements.push_back({3, 2, 5, {row(5, 8)}});
  file.elements.push_back({3, 2, 6, {row(6, 6), row(7, 6)}});
  file.elements.push_back({3, 1, 7, {row(8, 5)}});
  file.nodes[0] = {0, 1, {1, 6, 7, 8}, {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}}};
  const std::string text = msh::text(file);
  EXPECT_EQ(refusal(text),
            "mesh.msh:44: cells are 3 tetrahedra, 1 hexahedron, 2 prisms, 1 pyramid" + kOneShape);
  EXPECT_EQ(refusal(msh::binary(file, msh::ByteOrder::little))
                    .find("cells are 3 tetrahedra, 1 hexahedron, 2 prisms, 1 pyramid" +
                          kOneShape) == std::string::npos,
            false);
}

TEST(GmshElements, RefusesPrismsAndPyramidsAlone) {
  msh::File file = msh::two_tetrahedra();
  file.elements = {{3, 1, 7, {row(1, 5)}}, {3, 2, 19, {row(2, 13)}}};
  EXPECT_EQ(refusal(msh::text(file)), "mesh.msh:36: cells are 2 pyramids" + kOneShape);
  file.elements = {{3, 1, 18, {row(1, 15)}}};
  EXPECT_EQ(refusal(msh::text(file)), "mesh.msh:36: cells are 1 prism" + kOneShape);
}

TEST(GmshElements, RefusesOrdersThatAreNotRead) {
  msh::File file = msh::two_tetrahedra();
  file.elements = {{2, 7, 10, {row(1, 9), row(2, 9)}},
                   {3, 1, 17, {row(3, 20)}},
                   {3, 2, 12, {row(4, 27)}},
                   {3, 2, 17, {row(5, 20)}}};
  EXPECT_EQ(refusal(msh::text(file)),
            "mesh.msh:36: there are 2 quadrangles of 9 nodes" + kFirstOrder +
                "\nmesh.msh:39: there are 2 hexahedra of 20 nodes" + kFirstOrder +
                "\nmesh.msh:41: there is 1 hexahedron of 27 nodes" + kFirstOrder);
  file.elements = {{3, 1, 29, {row(1, 20)}}};
  EXPECT_EQ(refusal(msh::text(file)),
            "mesh.msh:36: there is 1 tetrahedron of 20 nodes" + kFirstOrder);
}

TEST(GmshElements, KnowsTheNumberOfNodesOfEveryKind) {
  // Dimension, type, nodes: the manual of Gmsh.
  const int kinds[][3] = {
      {1, 1, 2},   {2, 2, 3},   {2, 3, 4},   {3, 4, 4},   {3, 5, 8},   {3, 6, 6},   {3, 7, 5},
      {1, 8, 3},   {2, 9, 6},   {2, 10, 9},  {3, 11, 10}, {3, 12, 27}, {3, 13, 18}, {3, 14, 14},
      {0, 15, 1},  {2, 16, 8},  {3, 17, 20}, {3, 18, 15}, {3, 19, 13}, {2, 20, 9},  {2, 21, 10},
      {2, 22, 12}, {2, 23, 15}, {2, 24, 15}, {2, 25, 21}, {1, 26, 4},  {1, 27, 5},  {1, 28, 6},
      {3, 29, 20}, {3, 30, 35}, {3, 31, 56}, {3, 92, 64}, {3, 93, 125}};
  msh::File file = msh::two_tetrahedra();
  for (std::uint64_t node = 6; node <= 125; ++node) {
    file.nodes[2].tags.push_back(node);
    file.nodes[2].points.push_back({0, 0, 0});
  }
  file.elements.resize(5);
  for (const auto& [dimension, type, n_nodes] : kinds) {
    const int entity = dimension == 2 ? 7 : 1;
    const auto one = row(9, static_cast<std::uint64_t>(n_nodes));
    file.elements[3] = {dimension, entity, type, {one, one}};
    file.elements[4] = {1, 1, 1, {row(10, 2)}};  // is found behind them
    for (const std::string& bytes : {msh::text(file), msh::binary(file, msh::ByteOrder::big)}) {
      const std::string text = refusal(bytes);
      EXPECT_THAT(text, AllOf(Not(HasSubstr("expected")), Not(HasSubstr("copy it again")),
                              Not(HasSubstr("not known"))))
          << type;
      if (dimension == 3 && type != 4 && type != 11) {
        EXPECT_THAT(text, testing::AnyOf(HasSubstr("; mesh all"), HasSubstr("; use elements")));
      }
    }
  }
}

TEST(GmshElements, RefusesKindsThatAreNotKnown) {
  msh::File file = msh::two_tetrahedra();
  file.elements.insert(file.elements.begin(), {3, 1, 140, {row(9, 3)}});
  EXPECT_EQ(refusal(msh::text(file)),
            "mesh.msh:36: elements of type 140 are not known here" + kFirstOrder);
  // What follows is read in text, where elements are lines.
  EXPECT_EQ(refusal(changed(msh::text(file), "\n3 2 3 4 5 \n", "\n3 2 3 4 6 \n")),
            "mesh.msh:36: elements of type 140 are not known here" + kFirstOrder +
                "\nmesh.msh:43: tetrahedron 3 has node 6, which is not in $Nodes" + kAnew);
  const std::string bytes = msh::binary(file, msh::ByteOrder::little);
  EXPECT_EQ(refusal(bytes), concat("mesh.msh: byte ", bytes.find("$Elements\n") + 10 + 32,
                                   ": elements of type 140 are not known here", kFirstOrder));
}

TEST(GmshElements, TellsAllThatIsWrongInTheOrderOfBytes) {
  msh::File file = msh::two_tetrahedra();
  file.names[0].name = "\xFF";
  file.nodes[2] = {3, 2, {5, 2}, {{1, 1, 1}, {2, 2, 2}}};
  file.elements.push_back({3, 1, 140, {row(9, 3)}});
  const std::string bytes = msh::binary(file, msh::ByteOrder::little);
  const std::size_t nodes = bytes.find("$Nodes\n") + 7;
  const std::string text = refusal(bytes);
  EXPECT_THAT(text,
              testing::MatchesRegex(concat(
                  "mesh.msh: byte ", bytes.find("2 4 \""), ": .* is not a text char.*",
                  "\nmesh.msh: byte ", nodes + 32 + 52 + 116 + 20 + 8, ": node 2 is given twice.*",
                  "\nmesh.msh: byte ", bytes.find("$Elements\n") + 10 + 32 + 52 + 60 + 60,
                  ": elements of type 140 are not known here.*")));
}

TEST(GmshElements, RefusesAFileWithoutCells) {
  msh::File file = msh::two_tetrahedra();
  file.elements = {};
  EXPECT_EQ(refusal(msh::text(file)),
            "mesh.msh: there are no cells; give volumes a Physical Volume, without which Gmsh "
            "saves none, and mesh: -3");
}

}  // namespace
}  // namespace faultsim
