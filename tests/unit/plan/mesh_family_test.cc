// The families of scenes whose body is a mesh.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "simulator/plan/plan.h"
#include "tests/unit/files/scratch_folder.h"
#include "tests/unit/mesh/mesh_scene.h"
#include "tests/unit/scene/rotliegend.h"

namespace faultsim {
namespace {

/// A material by its name, and its Young's modulus.
using Rock = std::pair<std::string, std::string>;

class MeshFamily : public testing::Test {
 protected:
  /// Of a mesh that is "rock" throughout.
  std::string of(const std::vector<Rock>& rocks) const {
    JsonDocument document = read_json_file(file_.string());
    nlohmann::json materials;
    for (const auto& [name, modulus] : rocks) {
      materials[name] = {
          {"density", "2300 kg/m3"}, {"youngs_modulus", modulus}, {"poisson_ratio", 0.2}};
    }
    return family_of(varied(document, {{"/materials", materials.dump()},
                                       {"/geometry/volumes/rock/material", "rock"},
                                       {"/geometry/volumes/part 0/material", "rock"}}));
  }

  const ScratchFolder scratch_;
  const std::filesystem::path file_ = test::write_mesh_scene(scratch_.path());
};

/// Materials stand in the family without names, in the order of these, unused ones too.
TEST_F(MeshFamily, IsOfTheRockThatVolumesName) {
  const std::string stiff = of({{"aaa", "1 GPa"}, {"rock", "30 GPa"}});
  EXPECT_NE(of({{"rock", "1 GPa"}, {"zzz", "30 GPa"}}), stiff) << "one operator for both";
  EXPECT_EQ(of({{"bbb", "1 GPa"}, {"rock", "30 GPa"}}), stiff) << "names are not part of it";
}

}  // namespace
}  // namespace faultsim
