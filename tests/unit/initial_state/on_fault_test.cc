// The initial state on a fault, by hand.
#include "simulator/initial_state/on_fault.h"

#include <gtest/gtest.h>

#include <cmath>

#include "simulator/common/units.h"
#include "simulator/initial_state/initial_state.h"
#include "tests/unit/scene/rotliegend.h"

namespace faultsim {
namespace {

/// Of the reference field at 2,100 m: σ_v = -9.81 (2200 1500 + 2100 500 + 2400 100), p0 = 9.81 1000
/// 2100 + 25 bar.
constexpr double kVertical = -9.81 * (2200 * 1500 + 2100 * 500 + 2400 * 100),
                 kPore = 9.81e3 * 2100 + 2.5e6, kRatio = 0.74;

TEST(InitialOnFault, OfAVerticalFaultIsTheEffectiveHorizontalStress) {
  const InitialOnFault at = initial_on_fault(varied(rotliegend()), 1, 2100);
  EXPECT_NEAR(at.normal, kRatio * (kVertical + kPore), 1e-3);
  EXPECT_LT(at.normal, 0) << "compression";
  EXPECT_NEAR(at.shear, 0, 1e-6);
  EXPECT_NEAR(at.pressure, kPore, 1e-6);
}

TEST(InitialOnFault, OfADippingFaultIsThatOfMohrsCircle) {
  for (const double dip : {-30.0, 30.0}) {
    const Scene scene =
        varied(rotliegend(), {{"/faults/1/dip_from_vertical", std::to_string(dip) + " deg"}});
    const double across = kRatio * (kVertical + kPore), vertical = kVertical + kPore;
    const double angle = dip * kDegree, mean = 0.5 * (across + vertical),
                 radius = 0.5 * (across - vertical);
    const InitialOnFault at = initial_on_fault(scene, 1, 2100);
    EXPECT_NEAR(at.normal, mean + radius * std::cos(2 * angle), 1e-3) << dip;
    EXPECT_NEAR(at.shear, std::abs(radius * std::sin(2 * angle)), 1e-3) << dip;
  }
}

TEST(InitialOnFault, AFaultTakesWhatABlockHasOfItsOwnByItsRule) {
  const auto pressure = [](const char* rule, double depth) {
    const Scene scene = varied(rotliegend(), {{"/geometry/blocks/1/overpressure", "65 bar"},
                                              {"/fault_pressure/rule", rule}});
    return initial_on_fault(scene, 1, depth).pressure;
  };
  EXPECT_NEAR(pressure("mean", 2100), kPore + 0.5 * 4e6, 1e-3) << "40 bar more on one side";
  EXPECT_NEAR(pressure("max", 2100), kPore + 4e6, 1e-3);
  EXPECT_NEAR(pressure("min", 2100), kPore, 1e-3);
  EXPECT_NEAR(pressure("max", 2300), 9.81e3 * 2300, 1e-3) << "below the reservoir";
}

/// Half of a point there lies beside the block, which differs from the column by nothing.
TEST(InitialOnFault, AnOverpressureLikeTheColumnsChangesNothingAtEdges) {
  for (const char* rule : {"mean", "max"}) {
    const Scene column = varied(rotliegend(), {{"/fault_pressure/rule", rule}});
    const Scene own = varied(rotliegend(), {{"/geometry/blocks/1/overpressure", "25 bar"},
                                            {"/fault_pressure/rule", rule}});
    for (const double depth : {2000.0, 2100.0, 2200.0})
      EXPECT_NEAR(initial_on_fault(own, 1, depth).pressure,
                  initial_on_fault(column, 1, depth).pressure, 1e-3)
          << rule << " at " << depth;
  }
}

TEST(InitialOnFault, ABiotCoefficientOfTheFaultWeighsThePressure) {
  const Scene scene = varied(rotliegend(), {{"/fault_pressure/fault_biot", "0.8"}});
  EXPECT_NEAR(initial_on_fault(scene, 1, 2100).normal,
              kRatio * (kVertical + kPore) - kPore + 0.8 * kPore, 1e-3);
}

/// Just below the top of the reservoir, where the east has 175 bar more than the column.
TEST(InitialOpening, IsThatOfTheSideWhereItIsLargest) {
  Scene scene = varied(rotliegend(), {{"/fault_pressure/rule", "max"}});
  EXPECT_EQ(initial_opening(scene, 1), 0);
  scene.field.blocks[1].overpressure = 20e6;
  constexpr double kTop = -9.81 * (2200 * 1500 + 2100 * 500), kFluid = 9.81e3 * 2000 + 2.5e6;
  EXPECT_NEAR(initial_opening(scene, 1), kRatio * (kTop + kFluid) + 17.5e6, 1e-2);
  EXPECT_EQ(initial_opening(scene, 0), 0) << "of the west alone";
}

TEST(InitialOpening, OfRoundingIsNone) {
  Scene scene = read_scene(parse_json(starter_scene("box"), "box"));
  scene.initial.tensor = {-30e6, 0, 0, 0, -30e6, 0, 0, 0, -30e6};
  scene.initial.pressure_gradient = 0;
  scene.initial.pressure = 30e6 + 0.5;
  EXPECT_EQ(initial_opening(scene, 0), 0);
  scene.initial.pressure = 30e6 + 2;
  EXPECT_NEAR(initial_opening(scene, 0), 2, 1e-6);
}

TEST(InitialOnFault, RegionsBesideAreThoseOfTheBlocks) {
  const Scene scene = varied(rotliegend());
  EXPECT_EQ(regions_beside(scene, 0), std::vector<std::size_t>{0});
  EXPECT_EQ(regions_beside(scene, 1), (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(regions_beside(scene, 2), std::vector<std::size_t>{1});
}

TEST(InitialOnFault, TheNormalOfABoxFollowsStrikeAndDip) {
  Scene scene = read_scene(parse_json(starter_scene("box"), "box"));
  PatchGeometry& patch = scene.box.patches.at(0);
  patch.strike = 90 * kDegree;  // along x, dips to the south
  patch.dip_from_vertical = 30 * kDegree;
  const std::array<double, 3> normal = fault_normal(scene, 0);
  EXPECT_NEAR(normal[0], 0, 1e-12);
  EXPECT_NEAR(normal[1], -std::cos(30 * kDegree), 1e-12);
  EXPECT_NEAR(normal[2], std::sin(30 * kDegree), 1e-12);
  patch.strike = 0;
  EXPECT_NEAR(fault_normal(scene, 0)[0], std::cos(30 * kDegree), 1e-12);
}

}  // namespace
}  // namespace faultsim
