#include "simulator/loads/history.h"
#include "simulator/initial_state/pressure_history.h"

#include <gtest/gtest.h>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

Scene two_regions() {
  Scene scene;
  scene.stages = {{"primary_production", 10.0, 5}, {"gas_storage", 4.0, 2}};
  scene.pressure = {{"west", {10.0, 14.0}, {-20e6, -6e6}, 1.0, 0.0},
                    {"east", {10.0, 14.0}, {-20e6, -6e6}, 0.5, 2.0}};
  scene.materials.resize(2);
  scene.materials[1].biot = 0.8;
  return scene;
}

TEST(LoadSteps, StartsAtTheInitialStateAndEndsStagesExactly) {
  const auto steps = load_steps(two_regions());
  ASSERT_EQ(steps.size(), 8u);
  EXPECT_EQ(steps[0].stage, "initial");
  EXPECT_EQ(steps[5].time, 10.0);
  EXPECT_EQ(steps[6].stage, "gas_storage");
  EXPECT_EQ(steps[7].time, 14.0);
}

TEST(StageEnds, AreTheInitialStateAndTheLastStepOfEachStage) {
  const auto steps = load_steps(two_regions());
  std::vector<int> ends;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (is_stage_end(steps, i)) ends.push_back(steps[i].step);
  }
  EXPECT_EQ(ends, (std::vector<int>{0, 5, 7}));
  EXPECT_THROW(is_stage_end(steps, steps.size()), InternalError);
}

TEST(PressureChanges, AreLinearLaggedAndScaled) {
  const Scene scene = two_regions();
  EXPECT_DOUBLE_EQ(pressure_changes(scene, 5.0)[0], -10e6);
  EXPECT_DOUBLE_EQ(pressure_changes(scene, 12.0)[0], -13e6);
  EXPECT_DOUBLE_EQ(pressure_changes(scene, 99.0)[0], -6e6);
  EXPECT_DOUBLE_EQ(pressure_changes(scene, 1.5)[1], 0.0);   // still within the lag
  EXPECT_DOUBLE_EQ(pressure_changes(scene, 7.0)[1], -5e6);  // half of the history at t = 5
}

TEST(TableValue, IsOneWithoutATableAndConstantOutsideIt) {
  EXPECT_EQ(factor_at({}, 3.0), 1.0);
  const TimeTable table{{1.0, 3.0}, {2.0, 6.0}};
  EXPECT_DOUBLE_EQ(factor_at(table, 0.0), 2.0);
  EXPECT_DOUBLE_EQ(factor_at(table, 2.0), 4.0);
  EXPECT_DOUBLE_EQ(factor_at(table, 9.0), 6.0);
}

TEST(LoadFactors, TakeBiotFromTheMaterialAndTheTableFromTheBoundary) {
  Scene scene = two_regions();
  scene.box.boundary.resize(1);
  scene.box.boundary[0].table = {{0.0, 10.0}, {0.0, 1.0}};
  FaultOperator op;
  op.loads.keys = {{LoadKey::Kind::pressure, 1, 1},
                   {LoadKey::Kind::pressure, 0, 0},
                   {LoadKey::Kind::boundary, 0}};
  const LoadFactors factors(scene, op);
  const auto c = factors.at(5.0, {-10e6, -4e6});
  EXPECT_DOUBLE_EQ(c[0], 0.8 * -4e6);
  EXPECT_DOUBLE_EQ(c[1], -10e6);
  EXPECT_DOUBLE_EQ(c[2], 0.5);
  for (const LoadKey unknown :
       {LoadKey{LoadKey::Kind::boundary, 1}, LoadKey{LoadKey::Kind::pressure, 0, 2},
        LoadKey{LoadKey::Kind::pressure, 2, 0}, LoadKey{LoadKey::Kind::pressure, 0, -1}}) {
    op.loads.keys = {unknown};
    EXPECT_THROW(LoadFactors(scene, op), InternalError) << to_string(unknown);
  }
}

/// One fault node between a cell of region 0 (minus) and a cell of region 1 (plus), half its area;
/// the other half lies beside rock without pressure change on the plus side.
class FaultPressureRules : public testing::Test {
 protected:
  FaultPressureRules() {
    scene_ = two_regions();
    scene_.faults.resize(1);
    OperatorNode node;
    node.position = {0, 0, -2100};
    node.pressure = {{0, 1.0, 1, 1.0, 0.5}, {0, 1.0, -1, 0.0, 0.5}};
    geometry_.nodes = {node};
    OperatorFault fault;
    fault.n_nodes = 1;
    geometry_.faults = {fault};
  }
  double change(FaultPressureRule rule, double time = 5.0) {
    scene_.faults[0].pressure.rule = rule;
    return fault_pressure_change(scene_, geometry_, {0, 1}, time, {-10e6, -4e6})[0];
  }
  /// A reservoir from 2000 to 2200 m, in blocks without offset.
  void give_column() {
    scene_.geometry_kind = GeometryKind::field;
    scene_.materials[0].name = "rock";
    scene_.materials[0].density = 2400;
    scene_.field.depth = 5000;
    scene_.field.layers = {
        {"over", "rock", 0}, {"reservoir", "rock", 2000}, {"under", "rock", 2200}};
    scene_.field.reservoir_layer = "reservoir";
    scene_.field.blocks = {{"west", -1000, 0}, {"east", 0, 1000}};
  }
  Scene scene_;
  FaultGeometry geometry_;
};

TEST_F(FaultPressureRules, CombineBothSidesThenAverageByArea) {
  EXPECT_DOUBLE_EQ(change(FaultPressureRule::mean), 0.5 * -7e6 + 0.5 * -5e6);
  EXPECT_DOUBLE_EQ(change(FaultPressureRule::min), -10e6);
  EXPECT_DOUBLE_EQ(change(FaultPressureRule::max), 0.5 * -4e6);
  EXPECT_DOUBLE_EQ(change(FaultPressureRule::minus), -10e6);
  EXPECT_DOUBLE_EQ(change(FaultPressureRule::plus), 0.5 * -4e6);
  EXPECT_DOUBLE_EQ(change(FaultPressureRule::none), 0.0);
  scene_.faults[0].pressure.fraction = 0.25;
  EXPECT_DOUBLE_EQ(change(FaultPressureRule::fraction), 0.5 * -8.5e6 + 0.5 * -7.5e6);
}

TEST_F(FaultPressureRules, PrescribedRampsOverTheFirstStageAndRespectsItsWindow) {
  scene_.faults[0].pressure.prescribed = -3e6;
  EXPECT_DOUBLE_EQ(change(FaultPressureRule::prescribed, 5.0), -1.5e6);
  EXPECT_DOUBLE_EQ(change(FaultPressureRule::prescribed, 12.0), -3e6);
  scene_.faults[0].pressure.depth_window = {0.0, 1000.0};
  EXPECT_DOUBLE_EQ(change(FaultPressureRule::prescribed, 12.0), 0.0);
  scene_.faults[0].pressure.depth_window = {2000.0, 2200.0};
  scene_.faults[0].pressure.table = {{0.0, 1.0}, {0.0, 0.5}};
  EXPECT_DOUBLE_EQ(change(FaultPressureRule::prescribed, 12.0), -1.5e6);
}

/// West has 60 bar of its own at 2100 m, where the column has 25 bar: 35 bar more.
TEST_F(FaultPressureRules, CombineWhatBlocksHaveBeyondTheColumnAtTheStart) {
  give_column();
  scene_.initial.overpressure = 25e5;
  const auto excess = [&](FaultPressureRule rule) {
    scene_.faults[0].pressure.rule = rule;
    return initial_pressure_excess(scene_, geometry_, {0, 1})[0];
  };
  EXPECT_EQ(excess(FaultPressureRule::mean), 0) << "no block has its own";
  scene_.field.blocks[0].overpressure = 60e5;
  EXPECT_DOUBLE_EQ(excess(FaultPressureRule::mean), 0.5 * 35e5);
  EXPECT_DOUBLE_EQ(excess(FaultPressureRule::max), 35e5);
  EXPECT_DOUBLE_EQ(excess(FaultPressureRule::min), 0);
  EXPECT_DOUBLE_EQ(excess(FaultPressureRule::minus), 35e5);
  EXPECT_EQ(excess(FaultPressureRule::none), 0);
  EXPECT_EQ(excess(FaultPressureRule::prescribed), 0);
  geometry_.nodes[0].position.z() = -2300;  // of a block at an offset: the column has none here
  EXPECT_DOUBLE_EQ(excess(FaultPressureRule::minus), 60e5);
}

/// At top and base of the layer half of a node's area lies beside west, in which the column has all
/// of its 25 bar. An offset may be there by rounding alone.
TEST_F(FaultPressureRules, TakeWhatBlocksHaveFromWithinThemAtTheirEdges) {
  give_column();
  scene_.initial.overpressure = 25e5;
  scene_.faults[0].pressure.rule = FaultPressureRule::minus;
  geometry_.nodes[0].pressure = {{0, 1.0, 1, 1.0, 0.5}, {-1, 0.0, -1, 0.0, 0.5}};
  for (const double own : {25e5, 60e5}) {
    scene_.field.blocks[0].overpressure = own;
    for (const double offset : {0.0, 1e-12, -1e-12}) {
      scene_.field.blocks[0].offset = offset;
      for (const double depth : {2000.0, 2200.0}) {
        geometry_.nodes[0].position.z() = -depth;
        EXPECT_DOUBLE_EQ(initial_pressure_excess(scene_, geometry_, {0, 1})[0], 0.5 * (own - 25e5))
            << own << " at " << depth;
      }
    }
  }
}

}  // namespace
}  // namespace faultsim
