#include "simulator/plan/creep_plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "simulator/reading/read_scene.h"

namespace faultsim {
namespace {

constexpr double kYear = 31557600;

using Changes = std::vector<std::pair<std::string, std::string>>;

Scene changed(JsonDocument document, const Changes& sets) {
  for (const auto& [pointer, value] : sets) set_value(document, pointer, value);
  return read_scene(document);
}

Scene elastic(const Changes& sets) {
  return changed(read_json_file(FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend.json"), sets);
}

Scene viscous(const Changes& sets) {
  return changed(read_json_file(FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend-salt.json"),
                 sets);
}

Plan planned(const Scene& scene) {
  std::vector<Problem> problems;
  Plan plan = make_plan(scene, problems);
  EXPECT_TRUE(problems.empty());
  return plan;
}

const Reduction* creep_off(const Plan& plan) {
  for (const Reduction& reduction : plan.reductions) {
    if (reduction.name == "creep_off") return &reduction;
  }
  return nullptr;
}

void expect_rungs(const Scene& scene, const std::vector<double>& expected) {
  const std::vector<double> rungs = creep_rungs(scene);
  ASSERT_EQ(rungs.size(), expected.size());
  for (std::size_t i = 0; i < rungs.size(); ++i) {
    EXPECT_NEAR(rungs[i], expected[i], 1e-12 * expected[i]) << i;
  }
}

TEST(CreepRungs, ContainTheStepsThatEndAtTurningPoints) {
  // storage in half-yearly steps; the cycles of east turn a tenth of a year later
  const Changes lag = {{"/numerics/creep_refinements", "0"},
                       {"/compartments/east/lag", "0.1 year"}};
  expect_rungs(viscous(lag), {kYear, 0.9 * kYear, 0.4 * kYear, 0.1 * kYear});
  Changes report = lag;
  report.emplace_back("/numerics/turning_points", "report");
  expect_rungs(viscous(report), {kYear, 0.5 * kYear});
  EXPECT_NE(planned(viscous(lag)).family, planned(viscous(report)).family);
  // half the step: no length that is not there
  expect_rungs(viscous({{"/compartments/east/lag", "0.25 year"}}),
               {kYear, 0.75 * kYear, 0.5 * kYear, 0.375 * kYear, 0.25 * kYear, 0.125 * kYear});
}

TEST(Plan, CountsAndNamesWhatTurningPointsAdd) {
  const Plan without = planned(elastic({}));
  EXPECT_EQ(without.n_added_steps, 0);
  EXPECT_EQ(plan_to_text(without).find("added"), std::string::npos);
  const Plan with = planned(elastic({{"/compartments/east/lag", "0.25 year"}}));
  EXPECT_GT(with.n_added_steps, 0);
  EXPECT_EQ(with.n_steps, without.n_steps + with.n_added_steps);
  EXPECT_NE(plan_to_text(with).find("added where histories turn)"), std::string::npos);
  EXPECT_EQ(with.family, without.family) << "elastic: no operator changes";
}

/// The reference scene; with lines, its faults have a table of them.
Scene tabled(std::vector<std::string> lines) {
  JsonDocument document =
      read_json_file(FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend.json");
  if (lines.empty()) return read_scene(document);
  document.value["fault_pressure"] = {{"rule", "table"}, {"csv", "p.csv"}};
  document.value["tables"]["p.csv"] = std::move(lines);
  return read_scene(document);
}

/// Pressures of faults may be lopsided, and may turn between load steps.
TEST(Plan, TakenOverIsThatOfTheSceneItself) {
  const std::string head = ", 0 year [MPa], 2.5 year [MPa], 18 year [MPa]";
  const std::vector<Scene> scenes = {
      tabled({}), tabled({"depth [m]" + head, "1800, 0, -3, 0", "2400, 0, -3, 0"}),
      tabled({"depth [m], along_strike [m]" + head, "1800, -1200, 0, -3, 0", "1800, 1200, 0, -1, 0",
              "2400, -1200, 0, -3, 0", "2400, 1200, 0, -1, 0"})};
  EXPECT_TRUE(planned(scenes[0]).half_domain);
  EXPECT_TRUE(planned(scenes[1]).half_domain);
  EXPECT_EQ(planned(scenes[1]).n_steps, planned(scenes[0]).n_steps + 1);
  EXPECT_FALSE(planned(scenes[2]).half_domain);
  for (const Scene& from : scenes) {
    for (const Scene& to : scenes) {
      ASSERT_TRUE(have_same_body(from, to));
      std::vector<Problem> problems;
      const Plan plan = make_plan(to, problems, from, planned(from));
      EXPECT_TRUE(problems.empty());
      EXPECT_EQ(plan_to_json(plan), plan_to_json(planned(to)));
      EXPECT_EQ(plan.n_jump, planned(to).n_jump);
    }
  }
}

TEST(Plan, ReportsTheInitialStateOfEachBlock) {
  const nlohmann::json plan =
      plan_to_json(planned(elastic({{"/geometry/blocks/1/offset", "100 m"}})));
  const nlohmann::json& rows = plan["initial_state"];
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0]["region"], "west");
  EXPECT_EQ(double(rows[1]["depth_m"]) - double(rows[0]["depth_m"]), 100);
  EXPECT_LT(rows[0]["sigma_v_pa"], -40e6);
  EXPECT_NE(plan_to_text(planned(elastic({}))).find("west"), std::string::npos);
}

TEST(CreepRungs, AreTheLoadStepsAndTheirHalves) {
  // yearly and half-yearly steps, each halved once: the half years are one rung
  expect_rungs(viscous({}), {kYear, 0.5 * kYear, 0.25 * kYear});
  expect_rungs(viscous({{"/numerics/creep_refinements", "0"}}), {kYear, 0.5 * kYear});
  expect_rungs(viscous({{"/numerics/creep_refinements", "3"}}),
               {kYear, 0.5 * kYear, 0.25 * kYear, 0.125 * kYear, 0.0625 * kYear});
  expect_rungs(viscous({{"/stages/1/steps", "3"}, {"/numerics/creep_refinements", "0"}}),
               {kYear, 2 * kYear / 3, 0.5 * kYear});
}

TEST(CreepRungs, OfFixedStepsCutTheLoadStepsEvenly) {
  const auto of = [](const char* step) { return viscous({{"/numerics/creep_time_step", step}}); };
  expect_rungs(of("0.25 year"), {0.25 * kYear});
  expect_rungs(of("0.4 year"), {kYear / 3, 0.25 * kYear});  // 3 in a year, 2 in half a year
  expect_rungs(of("7 year"), {kYear, 0.5 * kYear});
}

/// 2.1/0.7 is more than 3 in the last bit: neither a fourth step nor a second rung may come of
/// it.
TEST(CreepRungs, DoNotSplitOnRounding) {
  ASSERT_GT(2.1 / 0.7, 3);
  Scene scene = viscous({});
  scene.numerics.creep_time_step = 0.7;
  scene.stages = {{"a", 2.1, 1}, {"b", 1.4, 1}};
  expect_rungs(scene, {0.7});
  Scene apart = scene;
  apart.numerics.creep_time_step = 0;
  apart.numerics.creep_refinements = 0;
  apart.stages = {{"a", 1, 1}, {"b", 1 + 1e-10, 1}, {"c", 1 + 1e-8, 1}};
  expect_rungs(apart, {1 + 1e-8, 1 + 1e-10});
}

/// Salt of V8: τ = η/G = 1e17/15.384615e9 = 6.5e6 s.
TEST(CreepEstimate, OfTheReferenceSceneByHand) {
  const CreepEstimate estimate = estimate_creep(viscous({}));
  EXPECT_NEAR(estimate.relaxation_time, 6.5e6, 1);
  EXPECT_DOUBLE_EQ(estimate.duration, 18 * kYear);
  EXPECT_DOUBLE_EQ(estimate.relaxed_share, 1);
  // |Δp| 200 bar; the initial deviator is largest at 5000 m: σ'_v = −118.7991 + 49.05 MPa, of which
  // 26 % across and 17 % along are missing; its deviator d has |d|² = (2/3)(a² + b² − ab)
  const double effective = 9.81 * (2200 * 1500 + 2100 * 500 + 2400 * 200 + 2600 * 2800) - 49.05e6;
  const double a = 0.26 * effective, b = 0.17 * effective;
  const double shear = std::sqrt((a * a + b * b - a * b) / 3);
  ASSERT_TRUE(estimate.stress);
  EXPECT_NEAR(*estimate.stress, 20e6 + shear, 1);
  EXPECT_NEAR(*estimate.bound, 10 * (20e6 + shear), 10);
}

TEST(CreepEstimate, IsLinearWhereLittleRelaxes) {
  const CreepEstimate estimate =
      estimate_creep(viscous({{"/materials/salt/viscosity", "1e25 Pa s"}}));
  const double share = 18 * kYear / 6.5e14;
  EXPECT_NEAR(estimate.relaxed_share, share, 1e-5 * share);
  EXPECT_NEAR(*estimate.bound, 10 * *estimate.stress * share, 1e-5 * *estimate.bound);
}

/// The pressure counts where it lies within the history, scaled and delayed; that of faults too.
TEST(CreepEstimate, TakesTheLargestPressureChangeOfTheHistory) {
  const auto stress = [](const Changes& sets) {
    Changes all = {{"/initial_state/ratio_across", "1"}, {"/initial_state/ratio_along", "1"}};
    all.insert(all.end(), sets.begin(), sets.end());
    return *estimate_creep(viscous(all)).stress;
  };
  EXPECT_NEAR(stress({}), 20e6, 1e-3) << "no initial shear stress to release";
  EXPECT_NEAR(stress({{"/compartments/east/scale", "1.05"}}), 21e6, 1e-3);
  EXPECT_NEAR(stress({{"/compartments/east/lag", "13 year"}, {"/compartments/west/scale", "0"}}),
              10e6, 1e-3)
      << "half of it arrives in 18 years";
  EXPECT_NEAR(stress({{"/compartments/east/lag", "2.75 year"}, {"/compartments/west/scale", "0"}}),
              20e6, 1e-3)
      << "all of it arrives, at 12.75 years, between two points of the history of the west";
  EXPECT_NEAR(stress({{"/fault_pressure", R"({"rule": "prescribed", "prescribed": "125 bar",
                        "table": {"time": ["0 s", "1 year"], "factor": [0, -1.6]}})"},
                      {"/stages/0/pressure_change", "-150 bar"}}),
              20e6, 1e-3);
}

/// Wherever and whenever it is largest.
TEST(CreepEstimate, CountsTablesOfFaultPressure) {
  JsonDocument document =
      read_json_file(FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend-salt.json");
  document.value["fault_pressure"] = {{"rule", "table"}, {"csv", "p.csv"}};
  document.value["tables"]["p.csv"] = std::vector<std::string>{
      "depth [m], 0 year [MPa], 9 year [MPa], 18 year [MPa]", "1800, 0, 10, 0", "2400, 0, 25, 5"};
  const Scene scene = changed(
      document, {{"/initial_state/ratio_across", "1"}, {"/initial_state/ratio_along", "1"}});
  EXPECT_NEAR(*estimate_creep(scene).stress, 25e6, 1e-3) << "more than the 200 bar of the rest";
}

/// Nothing loads a box of salt, but its fluid presses its fault open.
TEST(CreepEstimate, CountsWhatOpensAtTheStart) {
  const auto box = [](const char* pressure) {
    JsonDocument document = parse_json(starter_scene("box"), "box");
    set_value(document, "/materials/rock/viscosity", "1e17 Pa s");
    set_value(document, "/stages/0/pressure_change", "0 bar");
    document.value["initial_state"] = {{"kind", "profile"},
                                       {"pressure", pressure},
                                       {"tensor",
                                        {{"-30 MPa", "0 MPa", "0 MPa"},
                                         {"0 MPa", "-30 MPa", "0 MPa"},
                                         {"0 MPa", "0 MPa", "-30 MPa"}}}};
    return read_scene(document);
  };
  EXPECT_NEAR(*estimate_creep(box("40 MPa")).stress, 10e6, 1e-3);
  EXPECT_TRUE(planned(box("40 MPa")).creep.active);
  EXPECT_NEAR(*estimate_creep(box("20 MPa")).stress, 0, 1e-3);
  EXPECT_FALSE(planned(box("20 MPa")).creep.active);
}

/// 3 K α_T ΔT of the material that expands most.
TEST(CreepEstimate, AddsTheLargestThermalStress) {
  const double pressure = *estimate_creep(viscous({})).stress;
  const double both =
      *estimate_creep(viscous({{"/materials/reservoir/thermal_expansion", "1e-5 1/K"},
                               {"/stages/0/temperature_change", "-30 K"}}))
           .stress;
  EXPECT_NEAR(both - pressure, 11e9 / (1 - 2 * 0.15) * 1e-5 * 30, 1);
}

/// A box that nothing but its faces load.
Scene viscous_box(const std::string& face) {
  JsonDocument document = parse_json(starter_scene("box"), "box");
  set_value(document, "/materials/rock/viscosity", "1e17 Pa s");
  set_value(document, "/stages/0/pressure_change", "0 bar");
  set_value(document, "/initial_state/viscous_layers", "lithostatic");
  set_value(document, "/geometry/boundary/1", face);
  return read_scene(document);
}

TEST(CreepEstimate, CountsTheLoadsOfFaces) {
  const CreepEstimate pulled = estimate_creep(viscous_box(
      R"({"sides": ["z+"], "kind": "stress", "stress": [["3 MPa", "0 MPa", "0 MPa"],
          ["0 MPa", "0 MPa", "0 MPa"], ["0 MPa", "0 MPa", "4 MPa"]],
          "table": {"time": ["0 s", "1 s"], "factor": [0.5, -2]}})"));
  EXPECT_NEAR(*pulled.stress, 2 * 5e6, 1e-3);
  const double confined = 11e9 * 0.85 / (1.15 * 0.7);  // E (1−ν)/((1+ν)(1−2ν))
  const CreepEstimate strained = estimate_creep(viscous_box(
      R"({"sides": ["z+"], "kind": "displacement", "components": ["x"],
          "gradient": [[1e-4, 0, 0], [0, 0, 0], [0.9, 0.9, 0.9]]})"));
  EXPECT_NEAR(*strained.stress, 1e-4 * confined, 1e-3);
  // u_z = 1e-4 z is 0.3 m at 3000 m depth: the smallest extent, 1000 m, may take it all
  const CreepEstimate distant = estimate_creep(viscous_box(
      R"({"sides": ["z+"], "kind": "displacement",
          "gradient": [[0, 0, 0], [0, 0, 0], [0, 0, 1e-4]]})"));
  EXPECT_NEAR(*distant.stress, 3e-4 * confined, 1e-3);
}

TEST(CreepEstimate, HasNoBoundWhereAFaceIsTranslated) {
  const char* face = R"({"sides": ["z+"], "kind": "displacement", "components": ["x"],
                         "translation": ["1 mm", "0 m", "0 m"]})";
  const CreepEstimate moved = estimate_creep(viscous_box(face));
  EXPECT_FALSE(moved.stress);
  EXPECT_FALSE(moved.bound);
  const Plan plan = planned(viscous_box(face));
  EXPECT_TRUE(plan.creep.active);
  EXPECT_FALSE(plan.creep.bound);
  EXPECT_TRUE(plan_to_json(plan)["creep"]["bound_pa"].is_null());
  EXPECT_NE(creep_off(plan)->reason.find("not bounded"), std::string::npos);
  const Scene other = viscous_box(R"({"sides": ["z+"], "kind": "displacement", "components": ["x"],
                                      "translation": ["0 m", "1 mm", "0 m"]})");
  EXPECT_TRUE(estimate_creep(other).bound) << "y is not prescribed";
}

TEST(CreepOff, IsSilentWhereNothingIsViscous) {
  const Plan plan = planned(elastic({}));
  EXPECT_EQ(creep_off(plan), nullptr);
  EXPECT_FALSE(plan.creep.active);
  EXPECT_TRUE(plan.creep.rungs.empty());
  EXPECT_EQ(plan_to_text(plan).find("creep"), std::string::npos);
  EXPECT_EQ(plan_to_json(plan)["creep"].dump(), R"({"active":false,"bound_pa":null,"rungs_s":[]})");
}

TEST(CreepOff, SaysWhyTheReferenceSaltCreeps) {
  const Plan plan = planned(viscous({}));
  EXPECT_TRUE(plan.creep.active);
  EXPECT_EQ(creep_off(plan)->reason,
            "relaxation time 75.23 days, history 18 years: 100 % relaxed; may move fault tractions "
            "by up to 292 MPa, more than a tenth of creep_tolerance, 0.002 MPa");
  EXPECT_EQ(plan_to_json(plan)["creep"]["rungs_s"],
            nlohmann::json({kYear, 0.5 * kYear, 0.25 * kYear}));
  EXPECT_NE(plan_to_text(plan).find("creep: steps of 1 year, 182.6 days, 91.31 days; 4 operators "
                                    "with the elastic one\n"),
            std::string::npos)
      << plan_to_text(plan);
}

/// On both sides of the threshold: automatic switches creep off below a tenth of creep_tolerance.
TEST(CreepOff, IsAutomaticBelowATenthOfTheTolerance) {
  const Plan plan = planned(viscous({{"/materials/salt/viscosity", "1e25 Pa s"}}));
  EXPECT_FALSE(plan.creep.active);
  EXPECT_TRUE(plan.creep.rungs.empty());
  ASSERT_TRUE(plan.creep.bound);
  const double bound = *plan.creep.bound;
  EXPECT_LT(bound, 2e3);
  EXPECT_EQ(creep_off(plan)->reason,
            "relaxation time 2.06e+07 years, history 18 years: 8.74e-05 % relaxed");
  EXPECT_EQ(creep_off(plan)->bound,
            "moves fault tractions by less than 0.000255 MPa, below a tenth of creep_tolerance, "
            "0.002 MPa");
  const auto with_tolerance = [](double tolerance) {
    return planned(viscous({{"/materials/salt/viscosity", "1e25 Pa s"},
                            {"/numerics/creep_tolerance", concat(tolerance, " Pa")}}));
  };
  EXPECT_FALSE(with_tolerance(10.001 * bound).creep.active);
  EXPECT_TRUE(with_tolerance(9.999 * bound).creep.active);
}

TEST(CreepOff, IsForcedByItsSwitch) {
  const Plan off = planned(viscous({{"/numerics/creep", "off"}}));
  EXPECT_FALSE(off.creep.active);
  EXPECT_EQ(creep_off(off)->reason.rfind("switched off; relaxation time 75.23 days", 0), 0U);
  EXPECT_EQ(creep_off(off)->bound, "moves fault tractions by less than 292 MPa");
  const Plan on =
      planned(viscous({{"/numerics/creep", "on"}, {"/materials/salt/viscosity", "1e25 Pa s"}}));
  EXPECT_TRUE(on.creep.active);
  EXPECT_EQ(on.creep.rungs.size(), 3U);
}

/// One factor and H more per step length.
TEST(CreepCost, GrowsWithTheOperators) {
  const Plan none = planned(elastic({}));
  const Plan three = planned(viscous({}));
  const Plan four = planned(viscous({{"/numerics/creep_refinements", "2"}}));
  EXPECT_NEAR(three.operator_seconds, 4 * none.operator_seconds, 1e-9 * none.operator_seconds);
  EXPECT_NEAR(four.operator_seconds, 5 * none.operator_seconds, 1e-9 * none.operator_seconds);
  const double per_step = four.memory_bytes - three.memory_bytes;
  EXPECT_NEAR(three.memory_bytes, none.memory_bytes + 3 * per_step, 1e-6 * per_step);
  const auto jumps = static_cast<double>(three.n_jump);
  EXPECT_GT(per_step, 8 * jumps * jumps);
  EXPECT_LT(per_step, none.memory_bytes);
}

/// The fingerprint of the elastic reference family is the one from before there was creep.
TEST(CreepFamily, IsTheElasticOneWhereNothingCreeps) {
  const std::string family = planned(elastic({})).family;
  EXPECT_EQ(family, "65f5693328669a207f5c55459bb74402");
  EXPECT_EQ(planned(viscous({{"/numerics/creep", "off"}})).family, family);
  EXPECT_EQ(planned(viscous({{"/materials/salt/viscosity", "1e25 Pa s"}})).family, family);
}

TEST(CreepFamily, HoldsWhatTheOperatorsDependOn) {
  const std::string family = planned(viscous({})).family;
  EXPECT_NE(family, planned(elastic({})).family);
  const std::vector<Changes> others = {{{"/materials/salt/viscosity", "2e17 Pa s"}},
                                       {{"/materials/overburden/viscosity", "1e21 Pa s"}},
                                       {{"/numerics/creep_scheme", "backward_euler"}},
                                       {{"/numerics/creep_refinements", "2"}},
                                       {{"/numerics/creep_time_step", "0.1 year"}},
                                       {{"/stages/1/steps", "3"}},
                                       {{"/stages/1/duration", "3 year"}}};
  for (const Changes& sets : others) {
    EXPECT_NE(planned(viscous(sets)).family, family) << sets[0].first;
  }
  EXPECT_NE(planned(viscous({{"/numerics/creep_time_step", "0.5 year"}})).family,
            planned(viscous({{"/numerics/creep_time_step", "0.25 year"}})).family)
      << "one step length each";
  const std::vector<Changes> same = {{{"/numerics/creep", "on"}},
                                     {{"/numerics/creep_tolerance", "1 bar"}},
                                     {{"/initial_state/viscous_layers", "lithostatic"}},
                                     {{"/stages/0/pressure_change", "-100 bar"}},
                                     {{"/stages/0/duration", "5 year"}, {"/stages/0/steps", "5"}}};
  for (const Changes& sets : same) {
    EXPECT_EQ(planned(viscous(sets)).family, family) << sets[0].first;
  }
}

/// What nothing is made of does not creep: its viscosity asks for no other operators.
TEST(CreepFamily, IsThatOfTheMaterialsThatAreUsed) {
  const auto with_spare = [](const Changes& sets) {
    Changes all = {{"/materials/spare", R"({"density": "2300 kg/m3", "youngs_modulus": "20 GPa",
                                            "poisson_ratio": 0.25})"}};
    all.insert(all.end(), sets.begin(), sets.end());
    return planned(viscous(all)).family;
  };
  const std::string viscosity = "/materials/spare/viscosity", top = "/geometry/layers/0/material";
  const std::string family = with_spare({});
  EXPECT_EQ(with_spare({{viscosity, "1e18 Pa s"}}), family);
  EXPECT_EQ(with_spare({{viscosity, "1e20 Pa s"}}), family);
  EXPECT_NE(with_spare({{top, "spare"}, {viscosity, "1e18 Pa s"}}), with_spare({{top, "spare"}}));
}

}  // namespace
}  // namespace faultsim
