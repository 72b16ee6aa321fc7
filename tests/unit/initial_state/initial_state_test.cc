#include "simulator/initial_state/initial_state.h"

#include <gtest/gtest.h>

#include <cmath>

#include "simulator/common/units.h"
#include "simulator/initial_state/load_times.h"
#include "simulator/initial_state/pressure_history.h"
#include "simulator/reading/read_scene.h"
#include "tests/unit/scene/rotliegend.h"

namespace faultsim {
namespace {

TEST(InitialState, WeighsTheReferenceColumnByHand) {
  const Scene scene = read_scene(rotliegend());
  // 9.81 (2200 * 1500 + 2100 * 500) = 42.6735 MPa; 9.81 * 1000 * 2000 + 25 bar = 22.12 MPa.
  const StressAtDepth top = initial_state(scene, -2000, DepthSide::below);
  EXPECT_DOUBLE_EQ(top.sigma[8], -42.6735e6);
  EXPECT_DOUBLE_EQ(top.pressure, 22.12e6);
  EXPECT_NEAR(top.sigma[0], 0.74 * (-42.6735e6 + 22.12e6) - 22.12e6, 1e-6);
  EXPECT_NEAR(top.sigma[4], 0.83 * (-42.6735e6 + 22.12e6) - 22.12e6, 1e-6);
  EXPECT_EQ(top.sigma[1], 0);
  // 5000 m: + 9.81 (2400 * 200 + 2600 * 2800)
  EXPECT_NEAR(initial_state(scene, -5000).sigma[8], -42.6735e6 - 9.81 * 7.76e6, 1e-6);
  EXPECT_EQ(initial_state(scene, 10).sigma[8], 0);
}

TEST(InitialState, OfAnOffshoreFieldCarriesTheSea) {
  JsonDocument document = parse_json(starter_scene("field"), "field");
  const Scene dry = read_scene(document);
  set_value(document, "/initial_state/water_depth", "30 m");
  const Scene scene = read_scene(document);
  const double sea = 30 * 1000 * 9.81;
  for (const double z : {-10.0, -2000.0, -3000.0}) {
    const StressAtDepth with = initial_state(scene, z), without = initial_state(dry, z);
    EXPECT_NEAR(with.pressure - without.pressure, sea, 1e-6);
    EXPECT_NEAR(with.sigma[8] - without.sigma[8], -sea, 1e-6) << "σ'_v stays";
  }
  EXPECT_NEAR(initial_region_pressure(scene, 0, 2500) - initial_region_pressure(dry, 0, 2500), sea,
              1e-6);
  EXPECT_NE(case_identity(scene), case_identity(dry));
}

TEST(InitialState, TakesTheMeanWhereThePressureJumps) {
  const Scene scene = read_scene(rotliegend());
  const double above = initial_state(scene, -2000, DepthSide::above).pressure;
  const double below = initial_state(scene, -2000, DepthSide::below).pressure;
  EXPECT_DOUBLE_EQ(below - above, 2.5e6);
  EXPECT_DOUBLE_EQ(initial_state(scene, -2000).pressure, 0.5 * (above + below));
  EXPECT_DOUBLE_EQ(initial_state(scene, -2200, DepthSide::above).pressure, 2200 * 9810 + 2.5e6);
  EXPECT_DOUBLE_EQ(initial_state(scene, -2200, DepthSide::below).pressure, 2200 * 9810);
  EXPECT_DOUBLE_EQ(initial_state(scene, -2100).pressure, 2100 * 9810 + 2.5e6);
}

/// V3: χ0 of a plane that dips β from the vertical and strikes along y.
double critical_index(const Scene& scene, double dip) {
  const StressAtDepth state = initial_state(scene, -2100);
  const double n[3] = {std::cos(dip), 0, -std::sin(dip)};
  double t[3] = {};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) t[i] += state.sigma[3 * i + j] * n[j];
    t[i] += state.pressure * n[i];
  }
  const double normal = t[0] * n[0] + t[1] * n[1] + t[2] * n[2];
  const double square = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
  const double shear = std::sqrt(std::max(0.0, square - normal * normal));
  return shear / (-normal * std::tan(30 * kDegree));
}

TEST(InitialState, GivesTheTableOfV3) {
  const double dips[] = {5, 10, 15, 20, 25};
  const double at_074[] = {0.0527, 0.1030, 0.1486, 0.1879, 0.2193};
  const double at_040[] = {0.2230, 0.4251, 0.5902, 0.7104, 0.7849};
  JsonDocument document = rotliegend();
  const Scene scene = read_scene(document);
  set_value(document, "/initial_state/ratio_across", "0.4");
  const Scene low = read_scene(document);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(critical_index(scene, dips[i] * kDegree), at_074[i], 6e-5);
    EXPECT_NEAR(critical_index(low, dips[i] * kDegree), at_040[i], 6e-5);
  }
}

/// V5: σ_n −60.038782 and τ 8.211612 MPa on a fault that dips 70 deg, α_0 = 0.9, K0 = 0.5.
TEST(InitialState, GivesTheStartOfV5) {
  JsonDocument document = parse_json(starter_scene("box"), "box");
  set_value(document, "/initial_state", R"({"kind": "profile", "ratio_across": 0.5,
      "ratio_along": 0.5, "initial_biot": 0.9, "vertical_stress": "-82.6 MPa",
      "vertical_stress_gradient": "-23.6 kPa/m", "pressure": "35 MPa",
      "pressure_gradient": "10 kPa/m"})");
  const Scene scene = read_scene(document);
  const auto sigma = initial_state(scene, 0).sigma;
  const double s = std::sin(70 * kDegree);
  const double c = std::cos(70 * kDegree);
  EXPECT_NEAR(sigma[0] * s * s + sigma[8] * c * c, -60.038782e6, 1);
  EXPECT_NEAR((sigma[0] - sigma[8]) * s * c, 8.211612e6, 1);
  EXPECT_DOUBLE_EQ(initial_state(scene, -100).sigma[8], -82.6e6 - 2.36e6);
  EXPECT_DOUBLE_EQ(initial_state(scene, 100).pressure, 34e6);
}

TEST(InitialState, TakesAUniformTensorAsItIs) {
  JsonDocument document = parse_json(starter_scene("box"), "box");
  set_value(document, "/initial_state", R"({"kind": "profile", "pressure": "5 MPa", "tensor":
      [["-20 MPa", "3 MPa", "2 MPa"], ["3 MPa", "-25 MPa", "1 MPa"], ["2 MPa", "1 MPa", "-30 MPa"]]})");
  set_value(document, "/stages/0/pressure_change", "0 bar");
  const StressAtDepth state = initial_state(read_scene(document), -777);
  const std::array<double, 9> expected = {-20e6, 3e6, 2e6, 3e6, -25e6, 1e6, 2e6, 1e6, -30e6};
  EXPECT_EQ(state.sigma, expected);
  EXPECT_EQ(state.pressure, 5e6);
}

/// Salt from 1500 to 2000 m has come to rest: σ_h = σ_v there, the ratios rule outside, and on its
/// top and base the mean of both limits.
TEST(InitialState, IsLithostaticInViscousLayersWhereAsked) {
  JsonDocument document = rotliegend();
  set_value(document, "/materials/salt/viscosity", "1e17 Pa s");
  const Scene rocklike = read_scene(document);
  set_value(document, "/initial_state/viscous_layers", "lithostatic");
  const Scene scene = read_scene(document);
  const auto across = [](double depth, double m) {  // hydrostatic p0, 2200 over 2100 kg/m3
    const double vertical = -9.81 * (2200 * 1500 + 2100 * (depth - 1500));
    return m * (vertical + 9810 * depth) - 9810 * depth;
  };
  const double vertical = -9.81 * (2200 * 1500 + 2100 * 200);
  const StressAtDepth in_salt = initial_state(scene, -1700);
  const std::array<double, 9> expected = {vertical, 0, 0, 0, vertical, 0, 0, 0, vertical};
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(in_salt.sigma[i], expected[i], 1e-6) << i;
  EXPECT_EQ(in_salt.sigma[0], in_salt.sigma[8]) << "no deviator at all";
  EXPECT_EQ(in_salt.pressure, 1700 * 9810.0);
  for (const double z : {-1400.0, -2100.0, -3000.0}) {
    EXPECT_EQ(initial_state(scene, z).sigma, initial_state(rocklike, z).sigma) << z;
    EXPECT_NE(initial_state(scene, z).sigma[0], initial_state(scene, z).sigma[8]) << z;
  }
  EXPECT_NEAR(initial_state(rocklike, -1700).sigma[0], across(1700, 0.74), 1e-6);
  EXPECT_NEAR(initial_state(scene, -1500, DepthSide::above).sigma[0], across(1500, 0.74), 1e-6);
  EXPECT_NEAR(initial_state(scene, -1500, DepthSide::below).sigma[0], across(1500, 1), 1e-6);
  EXPECT_NEAR(initial_state(scene, -1500).sigma[4], across(1500, 0.5 * (0.83 + 1)), 1e-6);
  EXPECT_NEAR(initial_state(scene, -2000, DepthSide::above).sigma[0], across(2000, 1), 1e-6);
  EXPECT_NE(initial_state(scene, -2000, DepthSide::below).sigma[0],
            initial_state(scene, -2000, DepthSide::below).sigma[8]);
}

TEST(InitialState, OfABoxIsLithostaticInItsViscousLayersOrThroughout) {
  JsonDocument document = parse_json(starter_scene("box"), "box");  // 1000 to 3000 m deep
  set_value(document, "/materials/rock/viscosity", "1e17 Pa s");
  set_value(document, "/initial_state/viscous_layers", "lithostatic");
  const Scene all = read_scene(document);
  EXPECT_TRUE(has_viscous_layer(all));
  for (const double depth : {1000.0, 1777.0, 3000.0}) {
    EXPECT_EQ(initial_state(all, -depth).sigma[0], -22e3 * depth);
    EXPECT_EQ(initial_state(all, -depth).sigma[4], -22e3 * depth);
  }
  set_value(document, "/materials/lower", R"({"youngs_modulus": "1 GPa", "poisson_ratio": 0.2})");
  document.value["geometry"].erase("material");
  set_value(document, "/geometry/layers",
            R"([{"name": "salt", "material": "rock", "top": "1000 m"},
                {"name": "rock", "material": "lower", "top": "1500 m"}])");
  const Scene layered = read_scene(document);
  EXPECT_EQ(initial_state(layered, -1200).sigma[0], -22e3 * 1200);
  EXPECT_NEAR(initial_state(layered, -2000).sigma[0], 0.74 * (-44e6 + 20e6) - 20e6, 1e-6);
  set_value(document, "/geometry/layers/0/material", "lower");
  set_value(document, "/initial_state/viscous_layers", "ratios");
  EXPECT_FALSE(has_viscous_layer(read_scene(document)));
}

TEST(NeglectedWeightDifference, IsThatOfTheShiftedReservoir) {
  JsonDocument document = rotliegend();
  EXPECT_EQ(neglected_weight_difference(read_scene(document)), 0) << "sideburden weighs the same";
  set_value(document, "/geometry/blocks/1/offset", "150 m");
  // 150 m of reservoir (2400) in place of underburden (2600)
  EXPECT_NEAR(neglected_weight_difference(read_scene(document)), 200 * 9.81 * 150, 1e-6);
  set_value(document, "/materials/sideburden/density", "2300 kg/m3");
  // beside the blocks 200 m lack 100 kg/m3; in the east 150 m lack 100 and 150 m lack 200
  EXPECT_NEAR(neglected_weight_difference(read_scene(document)), 300 * 9.81 * 150, 1e-6);
}

TEST(PressureHistory, IsLinearScaledAndDelayed) {
  PressureHistory history{"east", {10, 20}, {-4, -2}, 1, 0};
  EXPECT_EQ(pressure_change_at(history, 0), 0);
  EXPECT_EQ(pressure_change_at(history, 5), -2);
  EXPECT_EQ(pressure_change_at(history, 10), -4);
  EXPECT_EQ(pressure_change_at(history, 15), -3);
  EXPECT_EQ(pressure_change_at(history, 99), -2);
  history.scale = 0.5;
  history.lag = 3;
  EXPECT_EQ(pressure_change_at(history, 3), 0);
  EXPECT_EQ(pressure_change_at(history, 8), -1);
  EXPECT_EQ(pressure_change_at(history, 13), -2);
  EXPECT_EQ(pressure_change_at({"west", {}, {}, 1, 0}, 7), 0);
}

TEST(PressureHistory, FollowsTheStagesOfTheReferenceScene) {
  const Scene scene = read_scene(rotliegend());
  const std::vector<StepEnd> steps = step_ends(scene);
  ASSERT_EQ(steps.size(), 24U);
  std::vector<double> times;
  for (const StepEnd& step : steps) times.push_back(step.time);
  EXPECT_DOUBLE_EQ(times[9], 10 * kYear);
  EXPECT_DOUBLE_EQ(times[23], 18 * kYear);
  const PressureHistory& west = scene.pressure[0];
  EXPECT_DOUBLE_EQ(pressure_change_at(west, times[0]), -2e6);
  EXPECT_DOUBLE_EQ(pressure_change_at(west, times[9]), -20e6);
  EXPECT_DOUBLE_EQ(pressure_change_at(west, times[10]), -13e6);
  EXPECT_DOUBLE_EQ(pressure_change_at(west, times[11]), -6e6);
  for (std::size_t k = 12; k < 24; ++k) {
    EXPECT_DOUBLE_EQ(pressure_change_at(west, times[k]), k % 2 == 0 ? -12e6 : -6e6);
  }
  EXPECT_EQ(steps[9].stage, 0U);
  EXPECT_EQ(steps[10].stage, 1U);
  EXPECT_EQ(steps[23].stage, 2U);
}

/// A stage without a pressure key keeps the pressures that it finds, in all of its steps.
TEST(PressureHistory, HoldsInAStageThatNamesNoPressure) {
  JsonDocument document = rotliegend();
  set_value(document, "/stages", R"([
      {"name": "production", "duration": "2 year", "steps": 2, "pressure_change": "-100 bar"},
      {"name": "shut_in", "duration": "9 year", "steps": 3},
      {"name": "storage", "duration": "1 year", "pressure_change": "-50 bar"}])");
  const Scene scene = read_scene(document);
  std::vector<double> times;
  for (const StepEnd& step : step_ends(scene)) times.push_back(step.time);
  const double expected[] = {-5e6, -10e6, -10e6, -10e6, -10e6, -5e6};
  ASSERT_EQ(times.size(), 6U);
  for (const PressureHistory& history : scene.pressure) {
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_DOUBLE_EQ(pressure_change_at(history, times[k]), expected[k]) << k;
    }
    EXPECT_EQ(pressure_change_at(history, 0.5 * (times[2] + times[3])), -10e6) << "between steps";
  }
}

TEST(TimeTable, IsOneWhenEmptyAndConstantOutside) {
  EXPECT_EQ(factor_at({}, 5), 1);
  EXPECT_EQ(factor_at({{1, 2}, {3, 5}}, 0), 3);
  EXPECT_EQ(factor_at({{1, 2}, {3, 5}}, 1.5), 4);
  EXPECT_EQ(factor_at({{1, 2}, {3, 5}}, 9), 5);
}

}  // namespace
}  // namespace faultsim
