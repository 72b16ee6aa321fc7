#include "simulator/coupled_case/path_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace faultsim {
namespace {

using testing::HasSubstr;

Plan million() {
  Plan plan;
  plan.n_unknowns = 1'000'000;
  plan.memory_bytes = 60e9;
  return plan;
}

TEST(PathChoice, TakesTheOperatorWhereItFits) {
  const PathChoice one = choose_path(million(), 64e9, {});
  EXPECT_EQ(one.path, SolutionPath::condensed);
  EXPECT_THAT(one.reason, HasSubstr("60 GB of 64 GB"));
  EXPECT_EQ(choose_path(million(), {}, {}).path, SolutionPath::condensed);
}

TEST(PathChoice, TakesBothSidesWhereOnlyTheyFit) {
  const PathChoice one = choose_path(million(), 32e9, {});
  EXPECT_EQ(one.path, SolutionPath::coupled);
  EXPECT_THAT(one.reason, HasSubstr("the coupled path needs about"));
}

TEST(PathChoice, TakesColumnsWhereOnlyTheyFit) {
  Plan plan = million();
  plan.n_jump = 10'000;
  EXPECT_LT(coupled_bytes(plan, true), coupled_bytes(plan, false)) << "no multipliers";
  const PathChoice one = choose_path(plan, 4.7e9, {}, true);
  EXPECT_EQ(one.path, SolutionPath::coupled);
  EXPECT_THAT(
      one.reason,
      HasSubstr("the condensed operator needs about 60 GB of 4.7 GB; the coupled path, which "
                "solves for the columns of what moves, needs about 4.4 GB"));
  plan.n_jump = 60'000;
  EXPECT_EQ(choose_path(plan, 8e9, {}, true).path, SolutionPath::condensed) << "14 GB of columns";
}

/// Between what histories of these sizes took and a little above the most that such a body did
/// (results/solver-study).
TEST(PathChoice, MemoryOfTheCoupledPathIsAsMeasured) {
  Plan plan;
  plan.n_unknowns = 77'682;
  EXPECT_GT(coupled_bytes(plan, false), 316e6);
  EXPECT_LT(coupled_bytes(plan, false), 1.1 * 392e6);
  plan.n_unknowns = 1'019'133;
  EXPECT_GT(coupled_bytes(plan, false), 3.9e9);
  EXPECT_LT(coupled_bytes(plan, false), 1.1 * 5.2e9);
}

TEST(PathChoice, SaysWhyNeitherWillDo) {
  const PathChoice small = choose_path(million(), 1e9, {});
  EXPECT_EQ(small.path, SolutionPath::condensed) << "which refuses with its cure";
  EXPECT_THAT(small.reason, HasSubstr("of 1 GB, the coupled path"));
  const PathChoice creeping = choose_path(million(), 32e9, {{"/x", 0, "salt creeps", ""}});
  EXPECT_EQ(creeping.path, SolutionPath::condensed);
  EXPECT_THAT(creeping.reason, HasSubstr("salt creeps"));
}

}  // namespace
}  // namespace faultsim
