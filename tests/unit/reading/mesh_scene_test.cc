#include "tests/unit/mesh/mesh_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "simulator/reading/read_scene.h"
#include "tests/unit/files/scratch_folder.h"

/// Scenes whose body is a mesh from a file.
namespace faultsim {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class MeshScene : public testing::Test {
 protected:
  Scene read(const std::vector<std::pair<std::string, std::string>>& changes = {}) const {
    JsonDocument document = read_json_file(file_.string());
    for (const auto& [pointer, value] : changes) set_value(document, pointer, value);
    return read_scene(document);
  }
  /// What is said, without the name of the file before each line.
  std::string said(const std::vector<std::pair<std::string, std::string>>& changes) const {
    try {
      read(changes);
    } catch (const InputError& error) {
      std::string text;
      for (const Problem& problem : error.problems())
        text += problem.pointer + ": " + problem.what + "; " + problem.cure + "\n";
      return text;
    }
    return "";
  }

  const ScratchFolder scratch_;
  const std::filesystem::path folder_ = scratch_.path();
  const std::filesystem::path file_ = test::write_mesh_scene(folder_);
};

TEST_F(MeshScene, SaysWhatAMeshIs) {
  const Scene scene = read();
  ASSERT_TRUE(is_meshed(scene));
  const BoxGeometry& body = scene.box;
  EXPECT_THAT(body.from, ElementsAre(0, 0, -2200));
  EXPECT_THAT(body.to, ElementsAre(400, 400, -1800));
  EXPECT_THAT(region_names(scene), ElementsAre("gas"));
  EXPECT_THAT(body.regions[0].from, ElementsAre(0, 0, -2100));
  EXPECT_THAT(body.regions[0].to, ElementsAre(400, 400, -1900));
  ASSERT_EQ(body.patches.size(), 2u);
  EXPECT_NEAR(body.patches[0].center[0], 200, 1e-9);
  EXPECT_NEAR(body.patches[0].center[2], -2000, 1e-9);
  EXPECT_NEAR(body.patches[0].strike, 0, 1e-12);
  EXPECT_NEAR(body.patches[0].length, 400, 1e-9);
  EXPECT_NEAR(body.patches[1].strike, -std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(body.patches[1].length, 200, 1e-9);
  EXPECT_NEAR(body.patches[1].width, 400, 1e-9);
  // 4³ cubes: 300 edges, 240 diagonals of faces, 64 of cubes.
  EXPECT_EQ(body.mesh->n_sides, 300 + 240 + 64);
}

TEST_F(MeshScene, ASceneThatTravelsKnowsItsMesh) {
  JsonDocument document = read_json_file(file_.string());
  const nlohmann::json named = document.value;
  embed_fields(document.value, document.source, named);
  const Scene scene = read_scene(document);
  EXPECT_EQ(document.value["fields"]["cube.msh"]["fingerprint"],
            scene.box.mesh->content->fingerprint);
  std::ofstream(folder_ / "cube.msh", std::ios::app) << "$Comments\nchanged\n$EndComments\n";
  try {
    read_scene(document);
    ADD_FAILURE() << "it is another mesh";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("\"cube.msh\" is no longer what it was"));
  }
}

TEST_F(MeshScene, EveryProblemIsSaidAtOnce) {
  EXPECT_EQ(
      said({{"/geometry/volumes/rock/material", "\"granite\""},
            {"/geometry/volumes/caprock", R"({"material": "salt"})"},
            {"/geometry/boundary/0/surfaces/0", "\"west\""},
            {"/faults/0/name", "\"C\""},
            {"/faults/1/strike", "\"10 deg\""},
            {"/tier", "standard"}}),
      "/geometry/volumes/rock/material: there is no material \"granite\"; write one of "
      "\"reservoir\", \"salt\"\n"
      "/geometry/volumes/caprock: there is no physical volume of the mesh \"caprock\"; write one "
      "of \"rock\", \"part 0\"\n"
      "/geometry/boundary/0/surfaces/0: there is no physical surface of the mesh \"west\"; write "
      "one of \"A\", \"B\", \"x-\", \"x+\", \"y-\", \"y+\", \"z-\", \"z+\"\n"
      "/tier: has no effect: the cells are those of the mesh; remove it\n"
      "/faults/0/name: there is no physical surface of the mesh \"C\"; write one of \"A\", \"B\", "
      "\"x-\", \"x+\", \"y-\", \"y+\", \"z-\", \"z+\"\n"
      "/faults/1/strike: a fault of a mesh lies where its physical surface does; remove it\n");
}

TEST_F(MeshScene, WhatNeedsLayersIsRefused) {
  EXPECT_THAT(
      said({{"/initial_state", R"({"kind": "column", "ratio_across": 0.7, "ratio_along": 0.7})"}}),
      HasSubstr("/initial_state/kind: a mesh has no layers that a column could weigh; use "
                "\"kind\": \"profile\" or \"tensor\""));
  EXPECT_THAT(said({{"/initial_state/viscous_layers", "lithostatic"}}),
              HasSubstr("a mesh has no layers to be lithostatic in; use \"ratios\""));
}

TEST_F(MeshScene, AVolumeWithoutMaterialAndARollerAcrossNothingAreRefused) {
  EXPECT_THAT(said({{"/geometry/volumes", R"({"rock": {"material": "salt"}})"}}),
              HasSubstr("/geometry/volumes: the volume \"part 0\" of the mesh has no material; add "
                        "\"part 0\": { \"material\": ... }"));
  UncutMesh body = test::meshed_cube();
  for (Eigen::Vector3d& x : body.nodes) x.x() += 0.1 * x.z();
  test::write_mesh_scene(folder_, body);
  EXPECT_THAT(said({}),
              HasSubstr("/geometry/boundary/0/surfaces/0: \"x-\" has a roller, but does not lie "
                        "across x, y or z; use \"fixed\", or \"displacement\" with "
                        "components"));
}

TEST_F(MeshScene, AMeshThatIsNoneIsSaidByItsLines) {
  std::ofstream(folder_ / "cube.msh") << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  EXPECT_THAT(said({}), HasSubstr("/geometry/file: "));
  EXPECT_THAT(said({}), HasSubstr("2.2"));
  std::filesystem::remove(folder_ / "cube.msh");
  EXPECT_THAT(said({}), HasSubstr("/geometry/file: "));
}

TEST_F(MeshScene, ItsIdentityIsThatOfTheFilesBytes) {
  const Scene scene = read();
  const std::string text = canonical_parts(scene).geometry;
  EXPECT_THAT(text, HasSubstr(scene.box.mesh->content->fingerprint));
  EXPECT_NE(canonical_parts(read({{"/geometry/volumes/rock/material", "reservoir"}})).geometry,
            text);
  EXPECT_NE(canonical_parts(read({{"/geometry/boundary/0/surfaces/0", "z+"}})).geometry, text);
  std::filesystem::rename(folder_ / "cube.msh", folder_ / "other.msh");
  EXPECT_EQ(canonical_parts(read({{"/geometry/file", "other.msh"}})).geometry, text);
}

}  // namespace
}  // namespace faultsim
