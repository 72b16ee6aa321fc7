// What is said of files that are none, and of their sections.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include "tests/unit/gmsh/gmsh_fixture.h"

namespace faultsim {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string kSave41 =
    "; save the mesh in the format MSH 4.1: gmsh -format msh41, or Mesh.MshFileVersion = 4.1";
const std::string kEnd = "; end each section $X with a line $EndX; the file may be cut off";
const std::string kOneOfTwo = "; keep one of the two sections";

/// Without the section of this name.
std::string without(const std::string& bytes, const std::string& name) {
  const std::size_t begin = bytes.find('$' + name), end = bytes.find("$End" + name);
  return bytes.substr(0, begin) + bytes.substr(end + name.size() + 5);
}
std::string section(const std::string& bytes, const std::string& name) {
  const std::size_t begin = bytes.find('$' + name), end = bytes.find("$End" + name);
  return bytes.substr(begin, end + name.size() + 5 - begin);
}

TEST(GmshFiles, ReadsTheSoundFileThatTheOthersAreMadeOf) {
  EXPECT_EQ(refusal(sound_text()), "");
  EXPECT_EQ(refusal(sound_binary()), "");
}

TEST(GmshFiles, RefusesWhatIsNoFile) {
  const GmshFile file("");
  const auto refusal_of = [](const std::filesystem::path& path) -> std::string {
    try {
      read_gmsh(path);
    } catch (const InputError& error) {
      return replaced(error.what(), path.string(), "it");
    }
    return "";
  };
  EXPECT_EQ(refusal_of(file.path().parent_path()), "it: this is a folder; name a file in it");
  EXPECT_EQ(refusal_of(file.path().parent_path() / "other.msh"),
            "it: the file cannot be read: No such file or directory; check name and permissions");
  const std::filesystem::path pipe = file.path().parent_path() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(refusal_of(pipe), "it: this is a pipe; write it to a file and name that");
}

TEST(GmshFiles, RefusesOtherFormatsWithTheCure) {
  EXPECT_EQ(refusal(""), "mesh.msh: the file is empty" + kSave41);
  EXPECT_EQ(refusal("solid cube\n"),
            "mesh.msh:1: the file begins with \"solid cube\" and not with $MeshFormat" + kSave41);
  EXPECT_EQ(refusal("$NOD\n8\n"),
            "mesh.msh:1: the file begins with \"$NOD\" and not with $MeshFormat" + kSave41);
  EXPECT_EQ(refusal("\x89HDF\r\n\x1a\n"),
            "mesh.msh:1: the file begins with \"\\x89HDF\" and not with $MeshFormat" + kSave41);
  EXPECT_EQ(refusal("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n"),
            "mesh.msh:2: the format is MSH 2.2, not 4.1" + kSave41);
  EXPECT_EQ(refusal("$MeshFormat\n4 1 8\n"), "mesh.msh:2: the format is MSH 4, not 4.1" + kSave41);
  EXPECT_EQ(refusal("$MeshFormat\n4.10000001 0 8\n"),
            "mesh.msh:2: the format is MSH 4.10000001, not 4.1" + kSave41);
}

TEST(GmshFiles, RefusesWhatItsFirstSectionMayNotSay) {
  EXPECT_EQ(refusal("$MeshFormat"), "mesh.msh:1: the file ends within $MeshFormat" + kAnew);
  EXPECT_EQ(refusal("$MeshFormat\r\n \n"), "mesh.msh:1: the file ends within $MeshFormat" + kAnew);
  EXPECT_EQ(refusal("$MeshFormat\n4.1 0\n"),
            "mesh.msh:2: \"4.1 0\" ends too early for version, 0 or 1 for text or binary, size of "
            "numbers" +
                kLine);
  EXPECT_EQ(
      refusal("$MeshFormat\n4.1 0 8 1\n"),
      "mesh.msh:2: \"4.1 0 8 1\" contains more than version, 0 or 1 for text or binary, size of "
      "numbers" +
          kLine);
  EXPECT_EQ(refusal("$MeshFormat\n4.1 2 8\n"),
            "mesh.msh:2: 2 is neither 0 (text) nor 1 (binary)" + kAnew);
  EXPECT_EQ(refusal("$MeshFormat\n4.1 0 4\n"),
            "mesh.msh:2: numbers of 4 bytes are not read, those of 8 are; save the mesh with Gmsh "
            "on a 64-bit computer");
  for (const char* one : {"", "\1\0\0", "\2\0\0\0"}) {
    EXPECT_EQ(refusal(std::string("$MeshFormat\n4.1 1 8\n") + one),
              "mesh.msh: the number 1, which shows the order of bytes, is missing" + kAnew);
  }
}

TEST(GmshFiles, RefusesPartitions) {
  const std::string part = "$PartitionedEntities\n2\n0\n0 0 0 0\n$EndPartitionedEntities\n";
  const std::string cure = "; save it in one part: UnpartitionMesh in Gmsh's script, no -part";
  EXPECT_EQ(refusal(changed(sound_text(), "$Nodes\n", part + "$Nodes\n")),
            "mesh.msh:18: the mesh is partitioned" + cure);
  // Its elements are those of parts, which $Entities does not list.
  const std::string of_part =
      changed(changed(sound_text(), "\n3 1 4 1 \n", "\n3 5 4 1 \n"), "$Nodes\n", part + "$Nodes\n");
  EXPECT_EQ(refusal(of_part), "mesh.msh:18: the mesh is partitioned" + cure);
  const std::string binary = sound_binary();
  EXPECT_EQ(refusal(changed(binary, "$Nodes\n", part + "$Nodes\n")),
            concat("mesh.msh: byte ", binary.find("$Nodes"), ": the mesh is partitioned", cure));
}

TEST(GmshFiles, RefusesSectionsThatAreThereTwice) {
  const std::string text = sound_text() + section(sound_text(), "MeshFormat") +
                           section(sound_text(), "PhysicalNames") +
                           section(sound_text(), "Entities") + section(sound_text(), "Nodes") +
                           section(sound_text(), "Elements");
  EXPECT_EQ(refusal(text), "mesh.msh:43: there is a second section $MeshFormat" + kOneOfTwo +
                               "\nmesh.msh:46: there is a second section $PhysicalNames" +
                               kOneOfTwo + "\nmesh.msh:52: there is a second section $Entities" +
                               kOneOfTwo + "\nmesh.msh:60: there is a second section $Nodes" +
                               kOneOfTwo + "\nmesh.msh:76: there is a second section $Elements" +
                               kOneOfTwo);
  // What the second holds is not missed.
  std::string split = changed(sound_text(), "$Nodes\n", "$Nodes\n0 0 0 0\n$EndNodes\n$Nodes\n");
  split = changed(split, "$Entities\n", "$Entities\n0 0 0 0\n$EndEntities\n$Entities\n");
  EXPECT_EQ(refusal(split), "mesh.msh:13: there is a second section $Entities" + kOneOfTwo +
                                "\nmesh.msh:24: there is a second section $Nodes" + kOneOfTwo);
  split = changed(sound_text(), "$Elements\n", "$Elements\n0 0 0 0\n$EndElements\n$Elements\n");
  EXPECT_EQ(refusal(split), "mesh.msh:37: there is a second section $Elements" + kOneOfTwo);
}

TEST(GmshFiles, RefusesSectionsThatAreMissing) {
  const std::string cure = "; save the mesh as Gmsh does, with $Entities, $Nodes and $Elements";
  for (const std::string name : {"Entities", "Nodes", "Elements"}) {
    EXPECT_EQ(refusal(without(sound_text(), name)),
              "mesh.msh: there is no section $" + name + cure);
    EXPECT_EQ(refusal(without(sound_binary(), name)),
              "mesh.msh: there is no section $" + name + cure);
  }
  EXPECT_EQ(refusal(without(sound_text(), "PhysicalNames")), "");
}

TEST(GmshFiles, RefusesAFileThatEndsWithinASection) {
  EXPECT_EQ(refusal(changed(sound_text(), "$EndElements\n", "")),
            "mesh.msh:34: the file ends within the section \"$Elements\"" + kEnd);
  EXPECT_EQ(refusal(changed(sound_text(), "$EndElements\n", "$EndElem")),
            "mesh.msh:34: the section \"$Elements\" does not end before \"$EndElem\"" + kEnd +
                "\nmesh.msh:42: \"$EndElem\" ends a section that has not begun" + kEnd);
  const std::string within_nodes = sound_text().substr(0, sound_text().find("\n1 1 1 \n"));
  EXPECT_EQ(refusal(within_nodes), "mesh.msh:18: the file ends within the section \"$Nodes\"" +
                                       kEnd + "\nmesh.msh:30: the block says 1 node, but 0 follow" +
                                       kAnew);
  const std::string binary = sound_binary();
  const std::size_t at = binary.find("$Elements");
  EXPECT_EQ(refusal(binary.substr(0, binary.size() - 20)),
            concat("mesh.msh: byte ", at, ": the file ends within the section \"$Elements\"", kEnd,
                   "\nmesh.msh: byte ", at + 10 + 32 + 20 + 20 + 32 + 40,
                   ": the block says 1 tetrahedron, more than the section has room for", kAnew));
}

TEST(GmshFiles, GoesOnBehindASectionThatDoesNotEnd) {
  EXPECT_EQ(refusal(changed(sound_text(), "$EndNodes\n", "")),
            "mesh.msh:18: the section \"$Nodes\" does not end before \"$Elements\"" + kEnd);
  EXPECT_EQ(refusal(changed(sound_text(), "$Nodes\n", "$Comments\n$x\n$Nodes\n")),
            "mesh.msh:18: the section \"$Comments\" does not end before \"$Nodes\"" + kEnd);
  EXPECT_EQ(refusal(sound_text() + "$View\n$Again\n"),
            "mesh.msh:43: the file ends within the section \"$View\"" + kEnd);
  const std::string binary = sound_binary();
  EXPECT_EQ(refusal(changed(binary, "$EndEntities\n", "$EndEntitles\n")),
            concat("mesh.msh: byte ", binary.find("$Entities"),
                   ": the section \"$Entities\" does not end before \"$Nodes\"", kEnd,
                   "\nmesh.msh: byte ", binary.find("\n$EndEntities"),
                   ": $Entities continues after its last volume", kAnew));
}

TEST(GmshFiles, RefusesWhatStandsOutsideOfSections) {
  EXPECT_EQ(refusal(changed(sound_text(), "$Nodes\n", "one\ntwo\n$Nodes\n")),
            "mesh.msh:18: \"one\" is outside all sections" + kEnd);
  EXPECT_EQ(refusal(sound_text() + "$EndElements\nrest"),
            "mesh.msh:43: \"$EndElements\" ends a section that has not begun" + kEnd);
  EXPECT_EQ(refusal(sound_text() + "\x1b[1m"),
            "mesh.msh:43: \"\\u001b[1m\" is outside all sections" + kEnd);
}

TEST(GmshFiles, ReadsNoMoreBehindTwentySectionsThatDoNotEnd) {
  std::string many;
  for (int i = 0; i < 30; ++i) many += concat("$A", i, "\n$Nodes\n$EndNodes\n");
  const std::string text = refusal(changed(sound_text(), "$Nodes\n", many + "$Nodes\n"));
  EXPECT_THAT(
      text, HasSubstr("\nmesh.msh:75: the section \"$A19\" does not end before \"$Nodes\"" + kEnd +
                      "\nmesh.msh:75: 20 sections do not end; no more is read" + kAnew));
  EXPECT_THAT(text, Not(HasSubstr("$A20")));
  EXPECT_THAT(text, Not(HasSubstr("there is no section")));
}

TEST(GmshFiles, TellsAllThatIsWrongInTheOrderOfLines) {
  std::string text = changed(sound_text(), "3 3 \"east\"", "3 3 east");
  text = changed(text, "\n0 1 0 \n", "\n0 1d5 0 \n");
  text = changed(text, "\n3 2 3 4 5 \n", "\n3 2 3 4 6 \n");
  text = changed(text, "$Entities\n", "junk\n$Entities\n") + "$x\n";
  EXPECT_EQ(refusal(text),
            "mesh.msh:7: \"3 3 east\" is not the name of a physical group; write the dimension and "
            "the number of the group, from 1, and its name in quotes: 3 1 \"reservoir\""
            "\nmesh.msh:10: \"junk\" is outside all sections" +
                kEnd +
                "\nmesh.msh:29: \"1d5\" is not a number (expected: x, y and z); write each on a "
                "line of its own, as Gmsh does, in decimal numbers with a point: 1.5, 1e5"
                "\nmesh.msh:42: tetrahedron 3 has node 6, which is not in $Nodes" +
                kAnew + "\nmesh.msh:44: the file ends within the section \"$x\"" + kEnd);
}

}  // namespace
}  // namespace faultsim
