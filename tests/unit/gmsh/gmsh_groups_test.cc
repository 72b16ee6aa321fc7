// What is said of physical groups and their names.
#include <gmock/gmock.h>

#include "tests/unit/gmsh/gmsh_fixture.h"

namespace faultsim {
namespace {

const std::string kGroupCure = "; give every volume one Physical Volume with a name";
const std::string kOwnName = "; give each physical group a name of its own";
const std::string kWriteName =
    "; write the dimension and the number of the group, from 1, and its name in quotes: 3 1 "
    "\"reservoir\"";

TEST(GmshGroups, RefusesVolumesWithoutAPhysicalVolume) {
  msh::File file = msh::two_tetrahedra();
  file.entities[2].physical = {};
  file.entities.push_back({3, 3, {}});  // has no cells
  file.elements.push_back({3, 1, 4, {{4, 1, 2, 3, 5}, {5, 1, 2, 4, 5}}});
  EXPECT_EQ(refusal(msh::text(file)),
            "mesh.msh:39: volume 1, which has 3 cells, belongs to no physical volume" + kGroupCure);
  file = msh::two_tetrahedra();
  file.entities[3].physical = {};
  EXPECT_EQ(refusal(msh::text(file)),
            "mesh.msh:40: volume 2, which has 1 cell, belongs to no physical volume" + kGroupCure);
}

TEST(GmshGroups, RefusesVolumesInSeveral) {
  msh::File file = msh::two_tetrahedra();
  file.entities[2].physical = {12, -10, 3};
  const std::string what =
      "volume 1, which has 1 cell, belongs to several physical volumes: \"east\", \"west\", "
      "\"physical volume 12\"";
  EXPECT_EQ(refusal(msh::text(file)), "mesh.msh:38: " + what + kGroupCure);
  const std::string bytes = msh::binary(file, msh::ByteOrder::big);
  EXPECT_EQ(refusal(bytes), concat("mesh.msh: byte ", bytes.find("$Elements\n") + 10 + 32 + 52,
                                   ": ", what, kGroupCure));
  file.entities[2].physical = {10, 10, -10};
  EXPECT_EQ(refusal(msh::text(file)), "");
}

TEST(GmshGroups, RefusesAGroupZero) {
  EXPECT_EQ(refusal(changed(sound_text(), "1 1 1 1 4 2 1 -1", "1 1 1 1 0 2 1 -1")),
            "mesh.msh:14: surface 7 belongs to a physical group 0; number physical groups from 1");
}

TEST(GmshGroups, RefusesEntitiesThatAreThereTwice) {
  msh::File file = msh::two_tetrahedra();
  file.entities.push_back({3, 1, {3}});
  EXPECT_EQ(refusal(msh::text(file)),
            "mesh.msh:17: volume 1 is given twice, first at line 15" + kAnew);
}

TEST(GmshGroups, RefusesElementsOfEntitiesThatAreNotThere) {
  EXPECT_EQ(refusal(changed(sound_text(), "\n2 7 2 1 \n", "\n2 8 2 1 \n")),
            "mesh.msh:36: surface 8, which has 1 element, is not in $Entities" + kAnew);
  EXPECT_EQ(refusal(changed(sound_text(), "\n3 1 4 1 \n", "\n3 -1 4 1 \n")),
            "mesh.msh:38: volume -1, which has 1 element, is not in $Entities" + kAnew);
}

TEST(GmshGroups, RefusesNamesThatAreNone) {
  for (const std::string wrong : {"3 3 east", "3 3", "3 3 \"east", "3 3 \"", "4 3 \"east\"",
                                  "-1 3 \"east\"", "3 0 \"east\"", "3 3 \"east\" x"}) {
    EXPECT_EQ(refusal(changed(sound_text(), "3 3 \"east\"", wrong)),
              "mesh.msh:7: \"" + wrong + "\" is not the name of a physical group" + kWriteName);
  }
  EXPECT_EQ(refusal(changed(sound_text(), "3 3 \"east\"", "3 \"east\"")),
            "mesh.msh:7: \"\"east\"\" is not a whole number from -2147483648 to 2147483647 "
            "(expected: the dimension, number and name of a physical group)" +
                kLine);
}

TEST(GmshGroups, RefusesNamesThatAreNoText) {
  EXPECT_EQ(refusal(changed(sound_text(), "\"east\"", "\"e\xFFst\"")),
            "mesh.msh:7: \"3 3 \"e\\xffst\"\" contains \"\\xff\", which is not a text character" +
                kWriteName);
  const std::string bytes = changed(sound_binary(), "\"east\"", "\"e\x1bst\"");
  EXPECT_EQ(refusal(bytes),
            concat("mesh.msh: byte ", bytes.find("3 3 \"e"), ": \"3 3 \"e\\u001bst\"\" contains ",
                   "\"\\u001b\", which is not a text character", kWriteName));
}

TEST(GmshGroups, RefusesAGroupWithTwoNames) {
  EXPECT_EQ(refusal(changed(sound_text(), "3 3 \"east\"", "3 10 \"east\"")),
            "mesh.msh:8: \"3 10 \"west\"\" names a group that already has a name, at line 7" +
                kWriteName);
}

TEST(GmshGroups, RefusesANameOfTwoGroups) {
  EXPECT_EQ(refusal(changed(sound_text(), "\"west\"", "\"east\"")),
            "mesh.msh:8: the physical volumes 3 and 10 are both called \"east\"" + kOwnName);
  // Also of one that has no cells, and of one that is called by its number.
  msh::File file = msh::two_tetrahedra();
  file.names = {{2, 4, "fault"}, {2, 99, "fault"}, {3, 3, "physical volume 10"}};
  EXPECT_EQ(refusal(msh::text(file)),
            "mesh.msh:7: the physical surfaces 4 and 99 are both called \"fault\"" + kOwnName +
                "\nmesh.msh:15: the physical volumes 3 and 10 are both called \"physical volume "
                "10\"" +
                kOwnName);
}

}  // namespace
}  // namespace faultsim
