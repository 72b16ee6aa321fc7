#include "simulator/reading/read_scene.h"
#include "simulator/documents/schema.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "simulator/common/fingerprint.h"
#include "simulator/common/text.h"
#include "simulator/common/units.h"
#include "simulator/initial_state/initial_state.h"
#include "simulator/scene/tiers.h"
#include "tests/unit/scene/rotliegend.h"

namespace faultsim {
namespace {

TEST(ReadScene, ReadsTheReferenceScene) {
  const Scene scene = read_scene(rotliegend());
  EXPECT_EQ(scene.geometry_kind, GeometryKind::field);
  EXPECT_EQ(scene.field.width, 20000);
  EXPECT_EQ(scene.field.layers[2].top_depth, 2000);
  EXPECT_EQ(scene.field.pivot_depth, 2100);
  EXPECT_EQ(material_named(scene, "salt").youngs_modulus, 40e9);
  EXPECT_EQ(material_named(scene, "salt").poisson_ratio, 0.3);
  ASSERT_EQ(scene.faults.size(), 3U);
  EXPECT_DOUBLE_EQ(scene.faults[2].friction.static_friction_angle, 30 * kDegree);
  EXPECT_EQ(scene.faults[2].friction.dynamic_friction_angle,
            scene.faults[2].friction.static_friction_angle);
  EXPECT_EQ(scene.faults[0].fault_biot, 1);
  EXPECT_EQ(scene.initial.overpressure, 2.5e6);
  EXPECT_EQ(scene.stages[0].duration, 10 * kYear);
  EXPECT_EQ(scene.pressure[1].region, "east");
  EXPECT_EQ(scene.output.observation_points[0].name, "above_centre");
  EXPECT_EQ(scene.mesh.growth, 2);
}

TEST(ReadScene, ReadsWeakeningAndStarters) {
  const Scene scene = read_scene(
      read_json_file(FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend-weakening.json"));
  EXPECT_DOUBLE_EQ(scene.faults[1].friction.dynamic_friction_angle, 10 * kDegree);
  EXPECT_DOUBLE_EQ(scene.faults[1].friction.slip_weakening_distance, 0.02);
  EXPECT_NO_THROW(read_scene(parse_json(starter_scene("field"), "field")));
  EXPECT_NO_THROW(read_scene(parse_json(starter_scene("box"), "box")));
  EXPECT_THROW(starter_scene("sphere"), InputError);
}

TEST(ReadScene, TiersFillTheMeshAndExplicitValuesWin) {
  const auto mesh = [](const char* tier) { return varied(rotliegend(), {{"/tier", tier}}).mesh; };
  EXPECT_EQ(mesh("standard").strike, 100);
  EXPECT_EQ(mesh("standard").corner, 0.5);
  EXPECT_EQ(mesh("standard").corner_growth, 1.5);
  EXPECT_EQ(mesh("standard").dip, 15);
  EXPECT_EQ(mesh("standard").normal, 0.5);
  EXPECT_EQ(mesh("standard").growth, 2);
  EXPECT_EQ(mesh("reference").strike, 75);
  EXPECT_EQ(mesh("demonstration").strike, 200);
  EXPECT_EQ(varied(rotliegend(), {{"/tier", "screening"}}).numerics.plane_strain, Switch::on);
  EXPECT_EQ(varied(rotliegend(), {{"/tier", "reference"}}).numerics.half_domain, Switch::on);
  const Scene own = varied(rotliegend(), {{"/mesh/dip", "25 m"}});
  EXPECT_EQ(own.mesh.dip, 25);
  EXPECT_EQ(own.mesh.strike, 100);
  EXPECT_EQ(own.mesh.corner, 0.5);
}

/// The schema cannot read the table of tiers; its words must say the same.
TEST(Tiers, AreDescribedInTheSchemaWithTheirSizes) {
  const std::string text = scene_schema().text()["properties"]["tier"]["description"];
  for (const Tier& tier : tiers()) {
    const MeshSizes& m = tier.sizes;
    const std::string first = tier.plane_strain ? "plane strain" : concat(m.strike, " m");
    const std::string expected =
        concat(tier.name, " = ", first, "; ", m.corner, " m by ", m.corner_growth, " to ", m.dip,
               " m; ", m.normal, " m by ", m.growth);
    EXPECT_NE(text.find(expected), std::string::npos) << expected;
    const std::string chi = formatted("χ̄ within %.3f (rms %.3f), ", tier.chi_largest, tier.chi_rms);
    EXPECT_EQ(std::string(tier.errors).find(chi), 0u) << "numbers and words";
  }
}

TEST(Tiers, AreToldWithTheirErrors) {
  EXPECT_EQ(
      mesh_text(read_scene(rotliegend())),
      concat("cells: tier standard, 100 m along strike; 0.5 m at compartment corners, growing by "
             "1.5 to 15 m down dip; 0.5 m beside faults, growing by 2\n  measured in plane "
             "strain: ",
             find_tier("standard")->errors));
  EXPECT_EQ(mesh_text(varied(rotliegend(), {{"/mesh/corner", "0 m"}})),
            "cells: 100 m along strike; 15 m down dip; 0.5 m beside faults, growing by 2; tier "
            "standard with sizes of its own");
}

TEST(ReadScene, CornersOfABoxAreRefused) {
  JsonDocument box = read_json_file(FAULTSIM_SOURCE_DIR "/simulator/reading/starter_box.json");
  set_value(box, "/mesh/corner", "5 m");
  std::vector<Problem> problems;
  read_scene(box, problems);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].pointer, "/mesh/corner");
}

/// Sizes, orders and places that no mesh is made of: the mesh takes them as given.
TEST(ReadScene, RefusesBodiesOfWhichThereIsNoMesh) {
  const auto pointer = [](const JsonDocument& document,
                          const std::vector<std::pair<std::string, std::string>>& sets) {
    try {
      varied(document, sets);
    } catch (const InputError& error) {
      return error.problems().front().pointer;
    }
    return std::string("none for ") + sets[0].first;
  };
  const std::vector<std::array<const char*, 2>> of_field = {{"/geometry/width", "0 m"},
                                                            {"/geometry/length", "-1 m"},
                                                            {"/geometry/depth", "0 m"},
                                                            {"/geometry/block_length", "0 m"},
                                                            {"/geometry/fault_length", "-2 m"},
                                                            {"/geometry/fault_overshoot", "-1 m"},
                                                            {"/geometry/layers/0/top", "1 m"},
                                                            {"/geometry/layers/0/top", "-1 m"},
                                                            {"/geometry/layers/2/top", "1000 m"},
                                                            {"/geometry/layers/3/top", "5 km"},
                                                            {"/geometry/blocks", "[]"},
                                                            {"/geometry/blocks/1/from", "10 m"},
                                                            {"/geometry/blocks/1/from", "-10 m"},
                                                            {"/geometry/blocks/0/from", "-10 km"},
                                                            {"/geometry/blocks/1/to", "10 km"},
                                                            {"/geometry/blocks/1/to", "-1 m"},
                                                            {"/geometry/blocks/1/thickness", "0 m"},
                                                            {"/mesh/strike", "0 m"},
                                                            {"/mesh/dip", "0 m"},
                                                            {"/mesh/normal", "-1 m"},
                                                            {"/mesh/normal", "nan m"},
                                                            {"/mesh/growth", "0.9"},
                                                            {"/mesh/corner_growth", "0.9"}};
  for (const auto& [at, value] : of_field)
    EXPECT_EQ(pointer(rotliegend(), {{at, value}}).substr(0, std::string(at).size()), at) << value;
  JsonDocument box = parse_json(starter_scene("box"), "box");
  const std::vector<std::array<const char*, 2>> of_box = {
      {"/geometry/to/1", "-500 m"},
      {"/geometry/from/0", "1001 m"},
      {"/mesh/strike", "-1 m"},
      {"/mesh/growth", "0.9"},
      {"/faults/0/length", "0 m"},
      {"/faults/0/width", "-1 m"},
      {"/faults/0/dip_from_vertical", "91 deg"},
      {"/faults/0/dip_from_vertical", "-91 deg"}};
  for (const auto& [at, value] : of_box) {
    const std::string where = at == std::string("/geometry/from/0") ? "/geometry/to/0" : at;
    EXPECT_EQ(pointer(box, {{at, value}}), where) << value;
  }
  box.value["geometry"].erase("material");
  for (const auto& [first, second] : {std::pair("999 m", "1500 m"), std::pair("1001 m", "1500 m"),
                                      std::pair("1000 m", "1000 m"), std::pair("1000 m", "4 km")}) {
    box.value["geometry"]["layers"] = {{{"name", "a"}, {"material", "rock"}, {"top", first}},
                                       {{"name", "b"}, {"material", "rock"}, {"top", second}}};
    EXPECT_EQ(pointer(box, {{"/title", "layers"}}),
              first == std::string("1000 m") ? "/geometry/layers/1/top" : "/geometry/layers/0/top");
  }
}

TEST(ReadScene, FaultsOverrideFrictionAndPressureKeyByKey) {
  const Scene scene = varied(rotliegend(), {{"/friction/cohesion", "1 MPa"},
                                            {"/fault_pressure/rule", "fraction"},
                                            {"/fault_pressure/fraction", "0.25"},
                                            {"/fault_pressure/fault_biot", "0.9"},
                                            {"/faults/1/friction/friction_coefficient", "0.5"},
                                            {"/faults/1/fault_biot", "0.8"},
                                            {"/faults/2/fault_pressure/fraction", "0.75"}});
  EXPECT_EQ(scene.faults[1].friction.cohesion, 1e6);
  EXPECT_DOUBLE_EQ(std::tan(scene.faults[1].friction.static_friction_angle), 0.5);
  EXPECT_EQ(scene.faults[1].friction.dynamic_friction_angle,
            scene.faults[1].friction.static_friction_angle);
  EXPECT_DOUBLE_EQ(scene.faults[0].friction.static_friction_angle, 30 * kDegree);
  EXPECT_EQ(scene.faults[0].fault_biot, 0.9);
  EXPECT_EQ(scene.faults[1].fault_biot, 0.8);
  EXPECT_EQ(scene.faults[0].pressure.fraction, 0.25);
  EXPECT_EQ(scene.faults[2].pressure.fraction, 0.75);
  EXPECT_EQ(scene.faults[2].pressure.rule, FaultPressureRule::fraction);
}

TEST(ReadScene, ReadsPrescribedFaultPressure) {
  const Scene scene = varied(
      rotliegend(),
      {{"/faults/0/fault_pressure",
        R"({"rule": "prescribed", "prescribed": "-100 bar", "depth_window": ["1900 m", "2300 m"],
            "table": {"time": ["0 year", "10 year"], "factor": [0, 1]}})"}});
  const FaultPressure& pressure = scene.faults[0].pressure;
  EXPECT_EQ(pressure.prescribed, -10e6);
  EXPECT_EQ((*pressure.depth_window)[1], 2300);
  EXPECT_EQ(pressure.table.time[1], 10 * kYear);
  EXPECT_EQ(scene.faults[1].pressure.rule, FaultPressureRule::mean);
  EXPECT_THROW(varied(rotliegend(), {{"/fault_pressure", R"({"rule": "prescribed"})"}}),
               InputError);
  EXPECT_THROW(varied(rotliegend(), {{"/fault_pressure", R"({"rule": "prescribed",
                      "prescribed": "-230 bar"})"}}),
               InputError)
      << "a pressure below zero in the fault";
}

TEST(ReadScene, StagesSetPressurePerRegionAbsoluteOrHold) {
  const Scene scene = varied(rotliegend(), {{"/geometry/blocks/1/offset", "100 m"}, {"/stages", R"([
          {"name": "a", "duration": "1 year", "steps": 2, "pressure_change": {"west": "-50 bar"}},
          {"name": "b", "duration": "1 year"},
          {"name": "c", "duration": "2 year", "steps": 4, "pressure": "100 bar"},
          {"name": "d", "duration": "2 year", "steps": 2, "cycles": 1,
           "pressure_between": {"east": ["-20 bar", "-10 bar"]}}])"}});
  const auto& west = scene.pressure[0];
  const auto& east = scene.pressure[1];
  EXPECT_EQ(scene.stages[1].n_steps, 1);
  const std::vector<double> times = {kYear, 2 * kYear, 4 * kYear, 5 * kYear, 6 * kYear};
  EXPECT_EQ(west.time, times);
  EXPECT_EQ(west.pressure_change[0], -5e6);
  EXPECT_EQ(west.pressure_change[1], -5e6) << "holding";
  EXPECT_DOUBLE_EQ(west.pressure_change[2], 10e6 - 22.12e6) << "p0 at 2000 m";
  EXPECT_EQ(east.pressure_change[0], 0) << "not named";
  EXPECT_DOUBLE_EQ(east.pressure_change[2], 10e6 - (2100 * 9810 + 2.5e6)) << "p0 at 2100 m";
  EXPECT_EQ(east.pressure_change[3], -2e6);
  EXPECT_EQ(east.pressure_change[4], -1e6);
  EXPECT_EQ(west.pressure_change[4], west.pressure_change[2]);
}

/// 10 years and 1 ns are 10 years: two points of a history at one time.
TEST(ReadScene, RefusesAStageWhoseStepsDoNotAdvanceTheTime) {
  const auto refusal = [](const std::string& duration, int n_steps) -> std::string {
    const std::string second = R"({"name": "b", "pressure_change": "-100 bar", "duration": ")" +
                               duration + R"(", "steps": )" + std::to_string(n_steps) + "}";
    try {
      varied(rotliegend(), {{"/stages", R"([{"name": "a", "duration": "10 year", "steps": 1}, )" +
                                            second + "]"}});
    } catch (const InputError& error) {
      const Problem& problem = error.problems().front();
      return problem.pointer + ": " + problem.what + "; " + problem.cure;
    }
    return "";
  };
  EXPECT_EQ(refusal("1e-9 s", 1),
            "/stages/1/duration: a step of 1e-09 s is too short to be told from none after "
            "3.15576e+08 s; make the stage longer, or leave it out");
  EXPECT_EQ(refusal("1e-5 s", 10000),
            "/stages/1/duration: a step of 1e-09 s is too short to be told from none after "
            "3.15576e+08 s; make the stage longer, write fewer steps, or leave it out");
  EXPECT_EQ(refusal("1e-6 s", 1), "");
  EXPECT_EQ(refusal("1 s", 10000), "");
}

TEST(ReadScene, ReadsPressuresFromCsv) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "scene_csv";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "p.csv") << "# measured\ntime [year], west [bar], east [MPa]\n"
                                     "0, 0, 0\n1, -10, -2\n 2.5 , -20,-3\n";
  JsonDocument document = rotliegend();
  document.source = (folder / "scene.json").string();
  const Scene all = varied(document, {{"/pressure_csv", "p.csv"}, {"/pressure_csv_end", "hold"}});
  EXPECT_EQ(all.pressure[0].pressure_change, (std::vector<double>{0, -1e6, -2e6}));
  EXPECT_EQ(all.pressure[1].pressure_change, (std::vector<double>{0, -2e6, -3e6}));
  EXPECT_EQ(all.pressure[1].time[2], 2.5 * kYear);
  const Scene one = varied(document, {{"/compartments/west/csv", "p.csv"},
                                      {"/compartments/west/scale", "0.5"},
                                      {"/pressure_csv_end", "hold"}});
  EXPECT_EQ(one.pressure[0].pressure_change, (std::vector<double>{0, -1e6, -2e6}));
  EXPECT_EQ(one.pressure[0].scale, 0.5);
  EXPECT_EQ(one.pressure[1].time.size(), 14U) << "the stages'";
}

TEST(ReadScene, ReadsCsvAsSpreadsheetsWriteIt) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "scene_csv";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "q.csv") << "\xEF\xBB\xBFtime [year],\"west [bar]\"\r\n0,0\r\n1,-10\r\n";
  JsonDocument document = rotliegend();
  document.source = (folder / "scene.json").string();
  const Scene scene = varied(document, {{"/pressure_csv", "q.csv"}, {"/pressure_csv_end", "hold"}});
  EXPECT_EQ(scene.pressure[0].pressure_change, (std::vector<double>{0, -1e6}));
}

TEST(ReadJsonFile, NamesAFolder) {
  try {
    read_json_file(testing::TempDir());
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().front().what, "this is a folder");
  }
}

/// Every field of BoxGeometry and the rest that a field does not have.
const char* const kFullBox = R"({
  "format": 1, "title": "full", "tier": "custom",
  "materials": {
    "a": { "density": "2000 kg/m3", "youngs_modulus": "25 GPa", "poisson_ratio": 0.25, "biot": 0.9 },
    "b": { "youngs_modulus": "10 GPa", "poisson_ratio": 0 }
  },
  "geometry": {
    "kind": "box", "from": ["-1 m", "-2 m", "-3 m"], "to": ["1 m", "2 m", "3 m"],
    "layers": [ { "name": "upper", "material": "a", "top": "-3 m" },
                { "name": "lower", "material": "b", "top": "1 m" } ],
    "boundary": [
      { "sides": ["x-", "x+"], "kind": "tied" },
      { "sides": ["y-", "y+"], "kind": "roller" },
      { "sides": ["z-"], "kind": "displacement", "components": ["x", "z"],
        "translation": ["0 m", "0 m", "1 mm"],
        "gradient": [[0, 0, 1e-3], [0, 0, 0], [0.5, 0, 0]],
        "table": { "time": ["1 s", "2 s", "4 s"], "factor": [1.2, 1.3, -1.8] } },
      { "sides": ["z+"], "kind": "stress",
        "stress": [["-1 MPa", "2 MPa", "0 MPa"], ["2 MPa", "0 MPa", "3 MPa"], ["0 MPa", "3 MPa", "5 MPa"]] }
    ],
    "regions": [
      { "name": "slab", "from": ["-1 m", "-2 m", "-1 m"], "to": ["0 m", "2 m", "1 m"] },
      { "name": "coin", "shape": "disc", "center": ["0 m", "0 m", "2 m"], "radius": "0.5 m", "thickness": "20 cm" }
    ]
  },
  "mesh": { "strike": "0.5 m", "dip": "0.25 m", "normal": "0.1 m", "growth": 1.1, "fine_margin": "1 m", "largest": "2 m" },
  "initial_state": { "kind": "profile", "tensor": [["-20 MPa", "3 MPa", "2 MPa"], ["3 MPa", "-25 MPa", "1 MPa"], ["2 MPa", "1 MPa", "-30 MPa"]], "pressure": "9 MPa", "pressure_gradient": "-1 kPa/m" },
  "friction": { "law": "coefficient", "cohesion": "1 kPa", "friction_coefficient": 0.6,
    "dynamic_friction_coefficient": 0.4, "slip_weakening_distance": "0.8 m", "slip_measure": "cumulated",
    "cohesion_after_opening": true },
  "fault_pressure": { "rule": "none", "fault_biot": 0.9 },
  "faults": [
    { "name": "F", "center": ["0 m", "0 m", "0.5 m"], "strike": "10 deg", "dip_from_vertical": "-45 deg",
      "length": "1 m", "width": "2 m", "shape": "ellipse" },
    { "name": "G", "center": ["0 m", "0 m", "0 m"], "dip_from_vertical": "90 deg", "length": "1 m", "width": "1 m" }
  ],
  "stages": [ { "name": "load", "duration": "4 s", "steps": 4 } ],
  "numerics": { "slip_tolerance": "1 um", "activation_length": "0.3 m", "traction_tolerance": 1e-9,
    "max_newton_iterations": 31, "max_active_set_passes": 101, "max_step_cuts": 7, "b_bar": false,
    "half_domain": "off", "plane_strain": "automatic" },
  "output": { "fault_fields": false, "volume_fields": true }
})";

TEST(ReadScene, ReadsEveryFieldOfABox) {
  const Scene scene = read_scene(parse_json(kFullBox, "full"));
  const BoxGeometry& box = scene.box;
  EXPECT_EQ(box.from[2], -3);
  EXPECT_EQ(box.layers[1].top_depth, 1);
  ASSERT_EQ(box.boundary.size(), 4U);
  EXPECT_EQ(box.boundary[0].kind, BoundaryKind::tied);
  EXPECT_EQ(box.boundary[1].sides[1], Side::y_max);
  const BoundaryCondition& moved = box.boundary[2];
  EXPECT_EQ(moved.components, (std::array<bool, 3>{true, false, true}));
  EXPECT_DOUBLE_EQ(moved.translation[2], 1e-3);
  EXPECT_EQ(moved.gradient[2], 1e-3);
  EXPECT_EQ(moved.gradient[6], 0.5);
  EXPECT_EQ(moved.table.factor, (std::vector<double>{1.2, 1.3, -1.8}));
  EXPECT_EQ(box.boundary[3].stress[5], 3e6);
  EXPECT_EQ(box.boundary[3].stress[8], 5e6);
  EXPECT_TRUE(box.boundary[3].table.time.empty());
  EXPECT_EQ(box.regions[0].to[2], 1);
  EXPECT_EQ(box.regions[1].shape, RegionShape::disc);
  EXPECT_DOUBLE_EQ(box.regions[1].thickness, 0.2);
  ASSERT_EQ(box.patches.size(), 2U);
  EXPECT_EQ(box.patches[0].shape, PatchShape::ellipse);
  EXPECT_DOUBLE_EQ(box.patches[0].strike, 10 * kDegree);
  EXPECT_DOUBLE_EQ(box.patches[0].dip_from_vertical, -45 * kDegree);
  EXPECT_EQ(box.patches[0].center[2], 0.5);
  EXPECT_DOUBLE_EQ(box.patches[1].dip_from_vertical, 90 * kDegree);
  EXPECT_EQ(box.patches[0].width, 2);
}

TEST(ReadScene, ReadsTheRestOfABoxScene) {
  const Scene scene = read_scene(parse_json(kFullBox, "full"));
  const CoulombLaw& friction = scene.faults[0].friction;
  EXPECT_EQ(friction.weakening, WeakeningLaw::coefficient);
  EXPECT_DOUBLE_EQ(std::tan(friction.dynamic_friction_angle), 0.4);
  EXPECT_EQ(friction.slip_weakening_distance, 0.8);
  EXPECT_EQ(friction.slip_measure, SlipMeasure::cumulated);
  EXPECT_TRUE(friction.cohesion_after_opening);
  EXPECT_EQ(scene.faults[1].pressure.rule, FaultPressureRule::none);
  EXPECT_EQ(scene.mesh.largest, 2);
  EXPECT_EQ(scene.mesh.fine_margin, 1);
  EXPECT_EQ(scene.mesh.growth, 1.1);
  EXPECT_DOUBLE_EQ(scene.numerics.slip_tolerance, 1e-6);
  EXPECT_EQ(scene.numerics.max_newton_iterations, 31);
  EXPECT_EQ(scene.numerics.max_active_set_passes, 101);
  EXPECT_EQ(scene.numerics.max_step_cuts, 7);
  EXPECT_FALSE(scene.numerics.b_bar);
  EXPECT_EQ(scene.numerics.half_domain, Switch::off);
  EXPECT_EQ(scene.numerics.plane_strain, Switch::automatic);
  EXPECT_TRUE(scene.output.volume_fields);
  EXPECT_FALSE(scene.output.fault_fields);
  EXPECT_EQ((*scene.initial.tensor)[1], 3e6);
  EXPECT_EQ(scene.initial.pressure_gradient, -1000);
}

/// The reference scene with all there is to say about creep, but for the fixed steps that exclude
/// the others.
JsonDocument creeping() {
  JsonDocument document =
      read_json_file(FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend-salt.json");
  set_value(document, "/initial_state/viscous_layers", "lithostatic");
  set_value(document, "/numerics", R"({"creep": "on", "creep_refinements": 2,
      "creep_tolerance": "1 bar", "creep_scheme": "backward_euler"})");
  return parse_json(document.value.dump(2), "creeping");
}

/// Whatever stands in whatever place: problems, never a crash, and each problem has a cure and a
/// place.
TEST(ReadScene, AnswersNonsenseAnywhereWithProblems) {
  for (const JsonDocument& document : {rotliegend(), parse_json(kFullBox, "full"), creeping()}) {
    for (const auto& [pointer, line] : document.lines) {
      if (pointer.empty()) continue;
      for (const char* nonsense : {"null", "[]", "{}", "-7", "nonsense", "[[1]]",
                                   "{\"kind\": \"box\"}", "\"\"", "-1e9 m", "0 bar"}) {
        JsonDocument broken = document;
        set_value(broken, pointer, nonsense);
        std::vector<Problem> problems;
        ASSERT_NO_THROW(read_scene(broken, problems)) << pointer << " = " << nonsense;
        for (const Problem& problem : problems) {
          EXPECT_FALSE(problem.what.empty() || problem.cure.empty())
              << pointer << " = " << nonsense << ": " << problem.pointer << ": " << problem.what;
        }
      }
    }
  }
}

TEST(CaseIdentity, IgnoresSpellingTitleCommentsAndOutput) {
  const std::string before = case_identity(read_scene(rotliegend()));
  EXPECT_EQ(before.size(), 32U);
  const std::vector<std::vector<std::pair<std::string, std::string>>> same = {
      {{"/title", "another"}},
      {{"/comment", "hello"}},
      {{"/output/volume_fields", "true"}},
      {{"/output/observation_points", "[]"}},
      {{"/stages/0/pressure_change", "-20 MPa"}},
      {{"/geometry/depth", "5000.0 m"}},
      {{"/compartments/east/scale", "1"}},
      {{"/geometry/blocks/1/offset", "-0 m"}},
      {{"/geometry/blocks/1/thickness", "200 m"}},
      {{"/geometry/blocks/1/from", "-0.0 m"}},
      {{"/mesh/growth", "2"}},
      {{"/mesh/dip", "15 m"}},
      {{"/tier", "custom"},
       {"/mesh", R"({"strike": "100 m", "dip": "15 m", "normal": "0.5 m", "growth": 2,
                     "corner": "0.5 m", "corner_growth": 1.5})"}},
      {{"/materials/unused", R"({"youngs_modulus": "1 GPa", "poisson_ratio": 0.1})"}},
      {{"/numerics/slip_tolerance", "0.1 mm"}},
      {{"/friction/dynamic_friction_angle", "30 deg"},
       {"/friction/slip_weakening_distance", "5 m"}},
  };
  for (const auto& sets : same) {
    EXPECT_EQ(case_identity(varied(rotliegend(), sets)), before) << sets[0].first;
  }
}

TEST(CaseIdentity, ChangesWithWordsAndSwitches) {
  const std::string before = case_identity(read_scene(rotliegend()));
  const std::vector<std::vector<std::pair<std::string, std::string>>> other = {
      {{"/fault_pressure/rule", "max"}},
      {{"/tier", "screening"}},
      {{"/geometry/blocks/1/thickness", "199 m"}},
      {{"/mesh/corner", "4 m"}},
      {{"/mesh/corner", "0 m"}},
      {{"/mesh/corner_growth", "1.2"}},
      {{"/numerics/half_domain", "on"}},
      {{"/numerics/b_bar", "false"}},
      {{"/numerics/max_step_cuts", "7"}},
      {{"/friction/cohesion_after_opening", "true"}},
      {{"/friction/cohesion_after_slip", "false"}},
      {{"/numerics/follow_events", "false"}},
      {{"/numerics/onset_tolerance", "1e-3"}},
      {{"/numerics/max_events", "7"}},
      {{"/friction/friction_angle", "30.00000000000001 deg"}},  // the last bits of 30 deg
  };
  for (const auto& sets : other) {
    EXPECT_NE(case_identity(varied(rotliegend(), sets)), before) << sets[0].first;
  }
}

/// A change of the canonical text changes the identity of every stored case: this fails when one
/// was made by accident. New fields must not appear at their old value.
TEST(CaseIdentity, OfTheReferenceSceneIsTheOneOnFile) {
  EXPECT_EQ(case_identity(read_scene(rotliegend())), "0fb4a50baac4a97085ba871118d70f43");
  EXPECT_EQ(fingerprint("numerics 8\n" + canonical_scene(read_scene(rotliegend()))),
            "e5177d278037ea497c4fde8073e7877a");
  EXPECT_EQ(fingerprint("numerics 7\n" + canonical_scene(read_scene(rotliegend()))),
            "ba54ba9ce7c045d27b5cbd4cbedb34df");
  EXPECT_EQ(fingerprint("numerics 6\n" + canonical_scene(read_scene(rotliegend()))),
            "683e77caa7e7ca4c96e5be0a4ca3d0ce");
  EXPECT_EQ(fingerprint("numerics 5\n" + canonical_scene(read_scene(rotliegend()))),
            "945098e68579352f513f477171a51a7f");
  // As `standard` was before cells were graded, and numerics of version 2.
  for (const char* corner : {"0 m", "20 m", "30 m"}) {
    const Scene even =
        varied(rotliegend(), {{"/tier", "custom"},
                              {"/mesh", R"({"strike": "100 m", "dip": "20 m", "normal": "20 m"})"},
                              {"/mesh/corner", corner}});
    EXPECT_EQ(fingerprint("numerics 2\n" + canonical_scene(even)),
              "6054f13c8b3b1cff6c7302cd8a0629fd");
  }
}

/// Viscous salt in the reference scene.
const std::pair<std::string, std::string> kViscous = {"/materials/salt/viscosity", "1e17 Pa s"};

TEST(ReadScene, ReadsViscousSaltAndItsNumerics) {
  const Scene scene = varied(rotliegend(), {kViscous});
  EXPECT_EQ(material_named(scene, "salt").viscosity, 1e17);
  EXPECT_FALSE(material_named(scene, "overburden").viscosity);
  EXPECT_EQ(scene.numerics.creep, Switch::automatic);
  EXPECT_EQ(scene.numerics.creep_time_step, 0);
  EXPECT_EQ(scene.numerics.creep_refinements, 1);
  EXPECT_EQ(scene.numerics.creep_tolerance, 2e4);
  EXPECT_EQ(scene.numerics.creep_scheme, MaxwellScheme::exponential);
  EXPECT_EQ(scene.initial.viscous_layers, ViscousLayers::ratios);
  const Scene other = varied(rotliegend(), {kViscous,
                                            {"/numerics/creep", "on"},
                                            {"/numerics/creep_time_step", "0.5 year"},
                                            {"/numerics/creep_tolerance", "1 bar"},
                                            {"/numerics/creep_scheme", "backward_euler"},
                                            {"/initial_state/viscous_layers", "lithostatic"}});
  EXPECT_EQ(other.numerics.creep, Switch::on);
  EXPECT_EQ(other.numerics.creep_time_step, 0.5 * kYear);
  EXPECT_EQ(other.numerics.creep_tolerance, 1e5);
  EXPECT_EQ(other.numerics.creep_scheme, MaxwellScheme::backward_euler);
  EXPECT_EQ(other.initial.viscous_layers, ViscousLayers::lithostatic);
}

TEST(HasViscousMaterial, AsksWhatTheModelIsMadeOf) {
  EXPECT_FALSE(has_viscous_material(read_scene(rotliegend())));
  EXPECT_TRUE(has_viscous_material(varied(rotliegend(), {kViscous})));
  EXPECT_FALSE(has_viscous_material(varied(
      rotliegend(),
      {{"/materials/unused",
        R"({"youngs_modulus": "1 GPa", "poisson_ratio": 0.1, "viscosity": "1e17 Pa s"})"}})));
}

/// Without viscous material creep is not part of a case, with it all of creep is.
TEST(CaseIdentity, HasCreepWhereSomethingIsViscous) {
  const std::vector<std::pair<std::string, std::string>> keys = {
      {"/numerics/creep", "off"},
      {"/numerics/creep_time_step", "0.5 year"},
      {"/numerics/creep_refinements", "2"},
      {"/numerics/creep_tolerance", "1 bar"},
      {"/numerics/creep_scheme", "backward_euler"}};
  const std::string elastic = case_identity(read_scene(rotliegend()));
  const std::string viscous = case_identity(varied(rotliegend(), {kViscous}));
  EXPECT_NE(viscous, elastic);
  for (const auto& key : keys) {
    EXPECT_EQ(case_identity(varied(rotliegend(), {key})), elastic) << key.first;
    EXPECT_NE(case_identity(varied(rotliegend(), {kViscous, key})), viscous) << key.first;
  }
  const Scene resting =
      varied(rotliegend(), {kViscous, {"/initial_state/viscous_layers", "lithostatic"}});
  EXPECT_NE(case_identity(resting), viscous);
  const Scene stiffer = varied(rotliegend(), {{"/materials/salt/viscosity", "2e17 Pa s"}});
  EXPECT_NE(case_identity(stiffer), viscous);
}

/// A default in the schema that is not the one in the code would be a lie.
void expect_true_defaults(const JsonDocument& document, int at_least) {
  const std::string before = case_identity(read_scene(document));
  int n_tried = 0;
  for (const ParameterInfo& row : parameters(document)) {
    const bool is_value =
        !row.default_value.empty() && (row.is_text || std::isdigit(row.default_value[0]) != 0);
    if (!is_value || row.value != row.default_value) continue;
    EXPECT_EQ(case_identity(varied(document, {{row.pointer, row.default_value}})), before)
        << row.pointer;
    ++n_tried;
  }
  EXPECT_GT(n_tried, at_least);
}

TEST(Defaults, OfTheSchemaAreThoseOfTheCode) {
  expect_true_defaults(rotliegend(), 30);
  JsonDocument viscous = rotliegend();
  set_value(viscous, kViscous.first, kViscous.second);
  expect_true_defaults(viscous, 34);
}

}  // namespace
}  // namespace faultsim
