#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "simulator/app/commands.h"
#include "simulator/plan/combinations.h"
#include "simulator/reading/read_scene.h"
#include "simulator/simulation/simulation.h"
#include "tests/unit/mesh/mesh_scene.h"

/// Each pair of features either runs, as a user would run it, or is refused with the reason of the
/// one table.
namespace faultsim {
namespace {

constexpr Feature kOfScenes[] = {
    Feature::creep,         Feature::surface,     Feature::flow_result,  Feature::temperature,
    Feature::stress_change, Feature::half_domain, Feature::plane_strain, Feature::weakening,
    Feature::cohesion_loss, Feature::mesh};
constexpr Feature kAskedFor[] = {Feature::coupled_path, Feature::displacements,
                                 Feature::contact_problem, Feature::influences};

class Combinations : public testing::Test {
 protected:
  Combinations() {
    std::string name = (std::filesystem::temp_directory_path() / "combinations_XXXXXX").string();
    folder_ = mkdtemp(name.data());
    std::ofstream(folder_ / "p.csv")
        << "x [m], y [m], depth [m], dx [m], dy [m], dz [m], 1990-01-01 [bar], 2000-01-01 [bar]\n"
           "0, 0, 2500, 40000, 40000, 5000, 300, 150\n";
    test::write_mesh_scene(folder_, test::meshed_cube(2));
  }
  ~Combinations() override { std::filesystem::remove_all(folder_); }

  /// What makes a scene have a feature, besides plane strain and stages.
  Changes changes_for(Feature feature) const {
    switch (feature) {
      case Feature::creep:
        return {{"/materials/salt/viscosity", "2e18 Pa s"},
                {"/numerics/creep", "on"},
                {"/numerics/creep_refinements", "1"}};
      case Feature::surface:
        return {{"/numerics/surface", R"({"over": [{"parameter": "/materials/salt/youngs_modulus",
                 "from": "30 GPa", "to": "50 GPa"}], "probes": {"cases": [{}]}})"}};
      case Feature::flow_result:
        return {{"/pressure_field", R"({"file": "p.csv"})"}};
      case Feature::weakening:
        return {{"/friction/dynamic_friction_angle", "18 deg"},
                {"/friction/slip_weakening_distance", "5 m"}};
      case Feature::cohesion_loss:
        return {{"/friction/cohesion", "0.1 MPa"}, {"/friction/cohesion_after_slip", "false"}};
      case Feature::temperature:
        return {{"/materials/reservoir/thermal_expansion", "1e-5 1/K"}};
      case Feature::half_domain:
        return {{"/numerics/half_domain", "on"}};
      case Feature::displacements:
        return {{"/output/volume_fields", "true"}};
      default:
        return {};
    }
  }

  /// A coarse scene with two features, as a file.
  std::string scene_of(Feature one, Feature other) const {
    const auto has = [&](Feature feature) { return one == feature || other == feature; };
    const bool is_plane = has(Feature::plane_strain) || !has(Feature::half_domain);
    const bool is_mesh = has(Feature::mesh);
    JsonDocument document = is_mesh ? read_json_file((folder_ / "scene.json").string())
                                    : parse_json(starter_scene("field"), "scene");
    nlohmann::json stage = {{"name", "production"}, {"until", "2000-01-01"}, {"steps", 2}};
    if (!has(Feature::flow_result)) stage["pressure_change"] = "-150 bar";
    if (has(Feature::temperature)) stage["temperature_change"] = "-10 K";
    if (has(Feature::stress_change)) {
      const nlohmann::json none = {"0 MPa", "0 MPa", "0 MPa"};
      stage["stress_change"] = {{"-1 MPa", "0 MPa", "0 MPa"}, none, none};
    }
    Changes changes = {{"/start_date", "1990-01-01"},
                       {"/friction", R"({"friction_angle": "20 deg"})"},
                       {"/compartments", "{}"},
                       {"/stages", nlohmann::json::array({stage}).dump()}};
    if (has(Feature::plane_strain)) changes.push_back({"/numerics", R"({"plane_strain": "on"})"});
    if (!is_mesh) {
      changes.push_back({"/tier", "custom"});
      changes.push_back({"/numerics", is_plane ? R"({"plane_strain": "on"})" : "{}"});
      changes.push_back(
          {"/mesh", R"({"strike": "1200 m", "dip": "100 m", "normal": "300 m", "growth": 2})"});
    }
    for (const Feature feature : {one, other}) {
      for (const Change& change : changes_for(feature)) changes.push_back(change);
    }
    for (const Change& change : changes)
      set_value(document, resolve_parameter(document, change.parameter), change.value);
    std::ofstream(folder_ / "pair.json") << document.value.dump();
    return (folder_ / "pair.json").string();
  }

  /// Runs it, by the command that is asked for. @returns what is said where it is refused, "" where
  /// it runs.
  std::string refusal(Feature one, Feature other) const {
    SceneArguments scene;
    scene.file = scene_of(one, other);
    OperatorArguments op;
    op.no_cache = true;
    op.threads = 1;
    ExitCode code = ExitCode::done;
    try {
      if (other == Feature::contact_problem) {
        code = export_contact_command({scene, op, 1, folder_ / "contact.h5", true});
      } else if (other == Feature::influences) {
        code = influence_command({scene, {}, op, folder_ / "influence.h5"});
      } else {
        RunArguments run;
        run.scene = scene;
        run.op = op;
        run.output = folder_ / "result";
        if (other == Feature::coupled_path) run.path = "coupled";
        code = run_command(run);
        std::filesystem::remove_all(run.output);
      }
    } catch (const InputError& error) {
      return error.what();
    }
    EXPECT_EQ(code, ExitCode::done);
    return "";
  }

  void expect_as_the_table_says(Feature one, Feature other) const {
    SCOPED_TRACE(concat("features ", static_cast<int>(one), " and ", static_cast<int>(other)));
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const std::string said = refusal(one, other);
    testing::internal::GetCapturedStdout();
    testing::internal::GetCapturedStderr();
    const char* reason = "";
    for (const Refusal& refused : refusals()) {
      if ((refused.one == one && refused.other == other) ||
          (refused.one == other && refused.other == one))
        reason = refused.reason;
    }
    if (*reason == '\0') {
      EXPECT_EQ(said, "") << "it should run";
    } else {
      EXPECT_THAT(said, testing::HasSubstr(reason));
    }
  }

  std::filesystem::path folder_;
};

TEST_F(Combinations, OfScenesRunOrAreRefusedInOnePlace) {
  for (const Feature& one : kOfScenes) {
    for (const Feature* other = &one + 1; other != std::end(kOfScenes); ++other)
      expect_as_the_table_says(one, *other);
  }
}

TEST_F(Combinations, WithWhatIsAskedForRunOrAreRefusedInOnePlace) {
  for (const Feature one : kOfScenes) {
    for (const Feature other : kAskedFor) expect_as_the_table_says(one, other);
  }
}

/// The page of the docs has the table of the code; to write it anew, set FAULTSIM_WRITE_DOCS.
TEST(CombinationsPage, IsMadeFromTheCode) {
  const char* const path = FAULTSIM_SOURCE_DIR "/docs/combinations.md";
  std::stringstream page;
  page << std::ifstream(path).rdbuf();
  const std::string text = page.str();
  const std::size_t table = text.find("\n| |");
  ASSERT_NE(table, std::string::npos) << path;
  const std::string made = text.substr(0, table + 1) + combinations_table();
  if (std::getenv("FAULTSIM_WRITE_DOCS") != nullptr) std::ofstream(path) << made;
  EXPECT_EQ(text, made);
}

}  // namespace
}  // namespace faultsim
