#include "simulator/measures/slip_events.h"

#include <gtest/gtest.h>

#include "tests/unit/measures/faults_between_regions.h"

namespace faultsim {
namespace {

/// 1 cm of slip down dip on three nodes of F1, 10 m each, under a stress drop of 2 MPa. Half of the
/// work that bulk and loads give goes into friction.
class EventOfThreeNodes : public testing::Test {
 protected:
  EventOfThreeNodes() {
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(fault_.op.geometry.n_dofs);
    jump_.jump_before = jump_.jump_after = zero;
    jump_.traction_before = jump_.traction_after = zero;
    for (int k = 3; k <= 5; ++k) {
      jump_.jump_after[2 * k + 1] = 0.01;
      jump_.traction_before[2 * k + 1] = 8e6;
      jump_.traction_after[2 * k + 1] = 6e6;
    }
    for (std::size_t k = 0; k < fault_.op.geometry.nodes.size(); ++k) {
      jump_.traction_before[2 * k] = jump_.traction_after[2 * k] = -10e6;
      fault_.laws[k].dynamic_friction_angle = std::atan(0.4);
      fault_.laws[k].slip_weakening_distance = 0.02;
      fault_.op.geometry.nodes[k].poisson_ratio = 0.2;
    }
    jump_.nucleus = {4};
    jump_.negative_pivots = 1;
    jump_.released = 4e6;
    jump_.dissipated = 2e6;
  }
  SlipEvent event() const { return measure_event(fault_.op, fault_.laws, jump_); }
  void set_edges(double edge) {
    for (OperatorNode& node : fault_.op.geometry.nodes) node.edge_dip = edge;
  }
  FaultsBetweenRegions fault_;
  ContactJump jump_;
};

TEST_F(EventOfThreeNodes, IsSummedOverWhatSlid) {
  const SlipEvent one = event();
  EXPECT_EQ(one.fault, "F1");
  EXPECT_DOUBLE_EQ(one.depth, 2050);
  EXPECT_DOUBLE_EQ(one.slipped_area, 30);
  EXPECT_DOUBLE_EQ(one.potency, 0.3);
  EXPECT_DOUBLE_EQ(one.moment, 0.3 * 5e9);
  EXPECT_DOUBLE_EQ(one.mean_slip, 0.01);
  EXPECT_NEAR(one.stress_drop, 2e6, 1e-6);
  EXPECT_EQ(one.energy_released, 4e6);
  EXPECT_EQ(one.energy_dissipated, 2e6);
}

/// Of nodes at one depth the one in the middle along strike, not the first.
TEST_F(EventOfThreeNodes, IsPlacedInTheMiddleOfItsNucleusAlongDipAndStrike) {
  std::vector<OperatorNode>& nodes = fault_.op.geometry.nodes;
  for (const int k : {2, 3, 4, 5, 6}) nodes[k].position = {0, 100.0 * k, -2050};
  jump_.nucleus = {2, 3, 4, 5, 6};
  EXPECT_EQ(nucleus_node(fault_.op.geometry, jump_), 4);
  nodes[6].area *= 8;  // the centre, weighted by area, is at 500 m
  EXPECT_EQ(nucleus_node(fault_.op.geometry, jump_), 5);
  jump_.nucleus.clear();
  EXPECT_EQ(nucleus_node(fault_.op.geometry, jump_), -1);
}

TEST_F(EventOfThreeNodes, IsTwiceAsLargeWithTheOtherHalfOfTheDomain) {
  const SlipEvent half = event();
  fault_.op.geometry.half_domain = true;
  const SlipEvent whole = event();
  EXPECT_DOUBLE_EQ(whole.slipped_area, 2 * half.slipped_area);
  EXPECT_DOUBLE_EQ(whole.moment, 2 * half.moment);
  EXPECT_DOUBLE_EQ(whole.energy_released, 2 * half.energy_released);
  EXPECT_DOUBLE_EQ(whole.energy_dissipated, 2 * half.energy_dissipated);
  EXPECT_DOUBLE_EQ(whole.mean_slip, half.mean_slip);
  EXPECT_DOUBLE_EQ(whole.stress_drop, half.stress_drop);
}

TEST_F(EventOfThreeNodes, IsResolvedByThreeCellsInTheNucleationLength) {
  // Uenishi and Rice in mode II: 1.158 G/(1 − ν)/W, W from the law itself.
  const double weakening = -NodeLaw(fault_.laws[4]).strength(-10e6, {0, 0}, 0, {}).d_measure;
  const double length = nucleation_length(5e9 / 0.8, weakening);
  for (const auto& [edge, resolved] : {std::pair{0.3 * length, true}, {0.4 * length, false}}) {
    set_edges(edge);
    EXPECT_EQ(event().resolved, resolved) << edge << " of " << length;
  }
}

TEST_F(EventOfThreeNodes, IsProvedByEnergyThatCoversWhatFrictionTook) {
  EXPECT_TRUE(event().evidence_holds);
  jump_.released = 1.99e6;
  EXPECT_FALSE(event().evidence_holds) << "friction took more than was given";
  jump_.released = 4e6;
  jump_.dissipated = -1;
  EXPECT_FALSE(event().evidence_holds);
  jump_.dissipated = 2e6;
  jump_.negative_pivots = 0;
  EXPECT_FALSE(event().evidence_holds) << "stability was never lost";
  jump_.n_lost_cohesion = 1;
  EXPECT_TRUE(event().evidence_holds);
  jump_.residual_after = 11;
  EXPECT_FALSE(event().evidence_holds) << "it did not arrive at an equilibrium";
}

}  // namespace
}  // namespace faultsim
