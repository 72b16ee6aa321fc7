#include "simulator/coupled/study_cases.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "simulator/coupled/box_study.h"
#include "simulator/coupled/solver_study.h"

namespace faultsim {
namespace {

/// Sizes of Ferronato et al. (SIAM GS 2019), met to 3 %.
void expect_size(StudyCase which, int n_displacements, int n_multipliers) {
  const BulkProblem problem = study_case(which);
  std::size_t n_copies = 0;
  for (const FaultSurface& fault : problem.mesh.faults) n_copies += fault.nodes.size();
  EXPECT_NEAR(3.0 * static_cast<double>(problem.mesh.nodes.size()) / n_displacements, 1, 0.03);
  EXPECT_NEAR(3.0 * static_cast<double>(n_copies) / n_multipliers, 1, 0.03);
}

TEST(StudyCases, AreAsLargeAsTheFieldCasesTheyStandFor) {
  expect_size(StudyCase::field_a, 171'150, 12'027);
  expect_size(StudyCase::field_b, 69'909, 2'757);
}

TEST(StudyCases, AreAsLargeAsTheFieldCasesTheyStandForSlow) {
  expect_size(StudyCase::cuts15, 379'983, 167'799);
  expect_size(StudyCase::field_c, 1'142'655, 38'109);
}

double n_in(const std::vector<NodeLinearisation>& nodes, FaultState state) {
  return static_cast<double>(
      std::count_if(nodes.begin(), nodes.end(),
                    [&](const NodeLinearisation& node) { return node.state == state; }));
}

TEST(FaultStages, StickThenSlipInTheMiddleThenOpenInTheMiddleOfThat) {
  const Mesh mesh = box_study(8).mesh;
  const auto n = static_cast<double>(mesh.faults.front().nodes.size());
  EXPECT_EQ(n_in(stage_of(mesh, FaultStage::stick), FaultState::stick), n);
  const std::vector<NodeLinearisation> slip = stage_of(mesh, FaultStage::slip);
  const std::vector<NodeLinearisation> open = stage_of(mesh, FaultStage::open);
  EXPECT_NEAR(n_in(slip, FaultState::slip) / n, 0.7 * 0.7, 0.05);
  EXPECT_EQ(n_in(slip, FaultState::open), 0);
  EXPECT_NEAR(n_in(open, FaultState::open) / n, 0.35 * 0.35, 0.04);
  EXPECT_EQ(n_in(open, FaultState::open) + n_in(open, FaultState::slip),
            n_in(slip, FaultState::slip));
  EXPECT_EQ(n_in(open, FaultState::stick), n_in(slip, FaultState::stick));
}

TEST(FaultStages, MakeTheJacobianUnsymmetricAndFewerMultipliers) {
  const BulkProblem problem = box_study(2);
  const TwoSidedBulk bulk(problem);
  const SaddlePoint stick = make_saddle_point(bulk, stage_of(problem.mesh, FaultStage::stick));
  const SaddlePoint slip = make_saddle_point(bulk, stage_of(problem.mesh, FaultStage::slip));
  const SaddlePoint open = make_saddle_point(bulk, stage_of(problem.mesh, FaultStage::open));
  EXPECT_TRUE(stick.symmetric);
  EXPECT_FALSE(slip.symmetric);
  EXPECT_GT(stick.n_multipliers(), slip.n_multipliers());
  EXPECT_GT(slip.n_multipliers(), open.n_multipliers());
}

}  // namespace
}  // namespace faultsim
