// What is said of the numbers of a file: records that cannot be read, counts that do not agree.
#include <gmock/gmock.h>

#include <cstring>
#include <limits>

#include "tests/unit/gmsh/gmsh_fixture.h"

namespace faultsim {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr std::uint64_t kHuge = 1'000'000'000'000'000'000;

/// What is said of the sound text with one change.
std::string refusal_with(const std::string& from, const std::string& to) {
  return refusal(changed(sound_text(), from, to));
}
template <typename Number>
std::string with_number(std::string bytes, std::size_t at, Number value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
  return bytes;
}
/// Where the numbers of a section of the binary file begin.
std::size_t begin_of(const std::string& name) {
  return sound_binary().find("$" + name + "\n") + name.size() + 2;
}
std::string at_byte(std::size_t byte) { return concat("mesh.msh: byte ", byte, ": "); }

TEST(GmshBlocks, RefusesWordsThatAreNoNumbers) {
  const auto with_x = [](const std::string& x) {
    return refusal_with("\n0 1 0 \n", "\n" + x + " 1 0 \n");
  };
  for (const std::string x : {"1d5", "1,5", "nan", "inf", "1e999", "0x1", "--1", "x", "\x1b"}) {
    EXPECT_EQ(with_x(x), "mesh.msh:28: \"" + (x == "\x1b" ? "\\u001b" : x) +
                             "\" is not a number (expected: x, y and z)" + kLine);
  }
  EXPECT_EQ(with_x("1.5e-3"), "");
  EXPECT_EQ(with_x("-1"), "");
  EXPECT_EQ(refusal_with("\n2 1 2 3 4 \n", "\n2 1 2 3.0 4 \n"),
            "mesh.msh:39: \"3.0\" is not a whole number from 0 to 9223372036854775807 (expected: "
            "the tag of an element and those of its 4 nodes)" +
                kLine);
  EXPECT_EQ(refusal_with("\n2 1 2 3 4 \n", "\n2 1 2 3 -4 \n"),
            "mesh.msh:39: \"-4\" is not a whole number from 0 to 9223372036854775807 (expected: "
            "the tag of an element and those of its 4 nodes)" +
                kLine);
  EXPECT_EQ(refusal_with("\n5 \n", "\n9223372036854775808 \n"),
            "mesh.msh:31: \"9223372036854775808\" is not a whole number from 0 to "
            "9223372036854775807 (expected: the tag of a node)" +
                kLine);
  EXPECT_EQ(refusal_with("\n3 2 0 1 \n", "\n3 2147483648 0 1 \n"),
            "mesh.msh:30: \"2147483648\" is not a whole number from -2147483648 to 2147483647 "
            "(expected: the dimension and number of an entity, 0 or 1, and the number of its "
            "nodes)" +
                kLine);
}

TEST(GmshBlocks, RefusesLinesThatAreTooShortOrTooLong) {
  EXPECT_EQ(refusal_with("\n0 1 0 \n", "\n0 1 \n"),
            "mesh.msh:28: \"0 1\" ends too early for x, y and z" + kLine);
  EXPECT_EQ(refusal_with("\n0 1 0 \n", "\n0 1 0 7\n"),
            "mesh.msh:28: \"0 1 0 7\" contains more than x, y and z" + kLine);
  EXPECT_EQ(refusal_with("\n3 2 3 4 5 \n", "\n3 2 3 4 \n"),
            "mesh.msh:41: \"3 2 3 4\" ends too early for the tag of an element and those of its 4 "
            "nodes" +
                kLine);
  EXPECT_EQ(
      refusal_with("\n3 2 3 4 5 \n", "\n3 2 3 4 5 6\n"),
      "mesh.msh:41: \"3 2 3 4 5 6\" contains more than the tag of an element and those of its 4 "
      "nodes" +
          kLine);
  EXPECT_EQ(refusal_with("\n5 \n", "\n5 5\n"),
            "mesh.msh:31: \"5 5\" contains more than the tag of a node" + kLine);
  EXPECT_EQ(refusal_with("1 1 1 2 \n", "1 1 1\n"),
            "mesh.msh:11: \"1 1 1\" ends too early for the numbers of points, curves, surfaces and "
            "volumes" +
                kLine);
  EXPECT_EQ(refusal_with("\n7 0 0 0 1 1 1 1 4 2 1 -1 \n", "\n7 0 0 0 1 1 1 9 4 2 1 -1 \n"),
            "mesh.msh:14: \"7 0 0 0 1 1 1 9 4 2 1 -1\" ends too early for the number of a surface, "
            "its box, counts and numbers of its physical groups and curves" +
                kLine);
  EXPECT_EQ(refusal_with("\n3 5 1 5 \n", "\n3 5 1 \n"),
            "mesh.msh:19: \"3 5 1\" ends too early for the numbers of blocks and in all, the least "
            "and the largest tag" +
                kLine);
}

TEST(GmshBlocks, DoesNotMissWhatStandsInLinesThatCannotBeRead) {
  // Node 5 of tetrahedron 3, its volume, and the corner of a facet.
  EXPECT_THAT(refusal_with("\n5 \n", "\nx \n"), Not(HasSubstr("\n")));
  EXPECT_THAT(refusal_with("\n2 0 0 0 1 1 1 1 3 2 1 -1 \n", "\nx \n"), Not(HasSubstr("\n")));
  msh::File file = msh::two_tetrahedra();
  file.elements[0].rows[0] = {1, 3, 4, 5};
  EXPECT_THAT(refusal(changed(msh::text(file), "\n3 2 3 4 5 \n", "\nx \n")), Not(HasSubstr("\n")));
}

TEST(GmshBlocks, RefusesNumbersThatAreNoneInBinary) {
  // Behind the section's head (32), two blocks with a node and three (20 + 32, 20 + 3 · 32), the
  // head of the third (20).
  const std::size_t tag = begin_of("Nodes") + 32 + 52 + 116 + 20, x = tag + 8;
  EXPECT_EQ(refusal(with_number(sound_binary(), x + 8, std::numeric_limits<double>::infinity())),
            at_byte(x) +
                "inf is not a finite number (expected: x, y and z); mesh again; the geometry may "
                "have a coordinate that is not a number");
  EXPECT_EQ(refusal(with_number(sound_binary(), tag, ~std::uint64_t{0})),
            at_byte(tag) +
                "18446744073709551615 is more than 9223372036854775807 (expected: the tag of a "
                "node)" +
                kAnew);
}

TEST(GmshBlocks, RefusesCountsThatDoNotAgree) {
  EXPECT_EQ(refusal_with("\n3 5 1 5 \n", "\n3 6 1 5 \n"),
            "mesh.msh:19: $Nodes says 3 blocks with 6 nodes in all, but has 3 with 5" + kAnew);
  EXPECT_EQ(refusal_with("\n3 5 1 5 \n", "\n4 5 1 5 \n"),
            "mesh.msh:19: $Nodes says 4 blocks with 5 nodes in all, but has 3 with 5" + kAnew);
  EXPECT_EQ(refusal_with("\n3 5 1 5 \n", "\n1 1 1 5 \n"),
            "mesh.msh:23: $Nodes continues after its last block" + kAnew);
  EXPECT_EQ(
      refusal_with("\n3 3 1 3 \n", "\n3 2 1 3 \n"),
      "mesh.msh:35: $Elements says 3 blocks with 2 elements in all, but has 3 with 3" + kAnew);
  EXPECT_EQ(refusal_with("\n3 2 3 4 5 \n", "\n3 2 3 4 5 \n4 1 2 3 5 \n"),
            "mesh.msh:42: $Elements continues after its last block" + kAnew);
  EXPECT_EQ(refusal_with("\n3 2 4 1 \n", "\n3 2 4 2 \n"),
            "mesh.msh:35: $Elements says 3 blocks with 3 elements in all, but has 3 with 4" +
                kAnew + "\nmesh.msh:40: the block says 2 tetrahedra, but 1 follow" + kAnew);
  EXPECT_EQ(refusal_with("1 1 1 2 \n", "1 1 1 3 \n"),
            "mesh.msh:11: $Entities says 3 volumes but has 2" + kAnew);
  EXPECT_EQ(refusal_with("1 1 1 2 \n", "1 1 1 1 \n"),
            "mesh.msh:16: $Entities continues after its last volume" + kAnew);
  EXPECT_EQ(refusal_with("\n3\n2 4 \"fault\"", "\n4\n2 4 \"fault\""),
            "mesh.msh:5: $PhysicalNames says 4 names but has 3" + kAnew);
}

TEST(GmshBlocks, RefusesCountsThatDoNotAgreeInBinary) {
  const std::size_t nodes = begin_of("Nodes"), elements = begin_of("Elements");
  EXPECT_EQ(refusal(with_number(sound_binary(), nodes + 8, std::uint64_t{6})),
            at_byte(nodes) + "$Nodes says 3 blocks with 6 nodes in all, but has 3 with 5" + kAnew);
  EXPECT_EQ(refusal(with_number(sound_binary(), nodes, std::uint64_t{2})),
            at_byte(nodes) + "$Nodes says 2 blocks with 5 nodes in all, but has 2 with 4" + kAnew +
                "\n" + at_byte(nodes + 32 + 52 + 116) + "$Nodes continues after its last block" +
                kAnew);
  const std::size_t last = elements + 32 + 20 + 32 + 20 + 40;
  EXPECT_EQ(
      refusal(with_number(sound_binary(), last + 12, std::uint64_t{2})),
      at_byte(last) + "the block says 2 tetrahedra, more than the section has room for" + kAnew);
  const std::size_t entities = begin_of("Entities");
  EXPECT_EQ(refusal(with_number(sound_binary(), entities + 16, std::uint64_t{0})),
            at_byte(entities + 32 + 36 + 76 + 80 + 80) +
                "$Entities continues after its last volume" + kAnew);
  EXPECT_EQ(refusal(with_number(sound_binary(), entities + 24, std::uint64_t{3})),
            at_byte(entities) + "$Entities says 3 volumes but has 2" + kAnew);
}

TEST(GmshBlocks, RefusesCountsThatNoFileHasRoomFor) {
  EXPECT_EQ(refusal_with("\n0 1 0 1 \n", "\n0 1 0 1000000000000000000 \n"),
            "mesh.msh:20: the block says 1000000000000000000 nodes, more than the section has room "
            "for" +
                kAnew);
  EXPECT_EQ(refusal_with("\n3 1 4 1 \n", "\n3 1 4 1000000000000000000 \n"),
            "mesh.msh:38: the block says 1000000000000000000 tetrahedra, more than the section has "
            "room for" +
                kAnew);
  EXPECT_EQ(refusal_with("\n3 5 1 5 \n", "\n1000000000000000000 1000000000000000000 1 5 \n"),
            "mesh.msh:19: $Nodes says 1000000000000000000 blocks with 1000000000000000000 nodes in "
            "all, but has 3 with 5" +
                kAnew);
  EXPECT_EQ(refusal_with("1 1 1 2 \n", "1 1 1 1000000000000000000 \n"),
            "mesh.msh:11: $Entities says 1000000000000000000 volumes but has 2" + kAnew);
  EXPECT_EQ(refusal_with("\n3\n2 4 \"fault\"", "\n1000000000000000000\n2 4 \"fault\""),
            "mesh.msh:5: $PhysicalNames says 1000000000000000000 names but has 3" + kAnew);
}

TEST(GmshBlocks, RefusesCountsThatNoBinaryFileHasRoomFor) {
  const std::size_t nodes = begin_of("Nodes"), entities = begin_of("Entities");
  EXPECT_EQ(refusal(with_number(sound_binary(), nodes + 32 + 12, kHuge)),
            at_byte(nodes + 32) +
                "the block says 1000000000000000000 nodes, more than the section has room for" +
                kAnew);
  EXPECT_EQ(refusal(with_number(sound_binary(), nodes, kHuge)),
            at_byte(nodes) +
                "$Nodes says 1000000000000000000 blocks with 5 nodes in all, but has 3 with 5" +
                kAnew);
  // The physical groups of the point, which then go on to the end of the section.
  EXPECT_EQ(refusal(with_number(sound_binary(), entities + 32 + 28, kHuge)),
            at_byte(entities + 32) +
                "the section ends within the number of a point, x, y, z, count and numbers of its "
                "physical groups" +
                kAnew);
}

TEST(GmshBlocks, RefusesBlocksThatCannotBe) {
  EXPECT_EQ(refusal_with("\n3 2 0 1 \n", "\n4 2 0 1 \n"),
            "mesh.msh:30: a block of nodes has dimension 4 and parametric 0, not 0 to 3 and 0 or "
            "1" +
                kAnew);
  EXPECT_EQ(refusal_with("\n3 2 0 1 \n", "\n3 2 2 1 \n"),
            "mesh.msh:30: a block of nodes has dimension 3 and parametric 2, not 0 to 3 and 0 or "
            "1" +
                kAnew);
  EXPECT_EQ(refusal_with("\n3 1 4 1 \n", "\n2 7 4 1 \n"),
            "mesh.msh:38: an entity of dimension 2 cannot have tetrahedra" + kAnew);
}

TEST(GmshBlocks, CountsWhatIsWrongInTheSameWay) {
  msh::File file = msh::two_tetrahedra();
  for (std::uint64_t tag = 4; tag < 34; ++tag)
    file.elements[2].rows.push_back({tag, 2, 3, 4, 1000 + tag});
  const std::string text = refusal(msh::text(file));
  EXPECT_THAT(
      text, HasSubstr("mesh.msh:61: tetrahedron 23 has node 1023, which is not in $Nodes" + kAnew +
                      "\nmesh.msh:62: 10 more are wrong in the same way, from here on" + kAnew));
  EXPECT_THAT(text, Not(HasSubstr("mesh.msh:63")));
}

}  // namespace
}  // namespace faultsim
