// Iterations to 1e-6 of five small systems and both right-hand sides: what costs iterations, or
// saves some, is seen here.
#include <gtest/gtest.h>

#include "simulator/coupled/box_study.h"
#include "simulator/coupled/solver_study.h"
#include "simulator/coupled/study_cases.h"
#include "tests/unit/condensation/test_problem.h"

namespace faultsim {
namespace {

struct Expected {
  LeadingKind leading;
  SchurKind schur;
  int random, physical;
};

void expect_counts(const BulkProblem& problem, FaultStage stage, const std::vector<Expected>& all) {
  const TwoSidedBulk bulk(problem);
  const SaddlePoint j = make_saddle_point(bulk, stage_of(problem.mesh, stage));
  for (const Expected& expected : all) {
    const StudyRow row = study(bulk, j, {expected.leading, expected.schur}, 200);
    const std::string name = concat(to_string(expected.leading), ", ", to_string(expected.schur));
    EXPECT_NEAR(row.random.to_1e6, expected.random, 1) << name;
    EXPECT_NEAR(row.physical.to_1e6, expected.physical, 1) << name;
    EXPECT_LT(row.true_residual, 3e-8) << name;
  }
}

TEST(StudyCounts, OfTheBoxAtAHalf) {
  expect_counts(box_study(2), FaultStage::stick,
                {{LeadingKind::amg, SchurKind::rac, 12, 12},
                 {LeadingKind::amg_by_component, SchurKind::rac, 12, 12},
                 {LeadingKind::exact, SchurKind::lsc, 22, 19},
                 {LeadingKind::exact, SchurKind::bds, 25, 23}});
}

TEST(StudyCounts, OfTheBoxAtAQuarter) {
  expect_counts(box_study(4), FaultStage::stick,
                {{LeadingKind::amg, SchurKind::rac, 11, 12},
                 {LeadingKind::amg_by_component, SchurKind::rac, 14, 14},
                 {LeadingKind::exact, SchurKind::lsc, 26, 22},
                 {LeadingKind::fsai, SchurKind::fsai_direct, 57, 60}});
}

TEST(StudyCounts, OfTheBoxAtAQuarterThatSlips) {
  expect_counts(box_study(4), FaultStage::slip,
                {{LeadingKind::amg, SchurKind::rac, 11, 12},
                 {LeadingKind::amg_by_component, SchurKind::rac, 14, 16},
                 {LeadingKind::exact, SchurKind::lsc, 26, 25}});
}

TEST(StudyCounts, OfTheBoxAtAQuarterThatOpens) {
  expect_counts(box_study(4), FaultStage::open,
                {{LeadingKind::amg, SchurKind::rac, 11, 12},
                 {LeadingKind::amg_by_component, SchurKind::rac, 14, 16},
                 {LeadingKind::exact, SchurKind::lsc, 25, 25}});
}

/// Two materials, cells that are no bricks, two faults.
TEST(StudyCounts, OfASmallBodyWithSomethingOfEverything) {
  expect_counts(test::mixed_problem(), FaultStage::stick,
                {{LeadingKind::amg, SchurKind::rac, 10, 10},
                 {LeadingKind::amg_by_component, SchurKind::rac, 10, 9},
                 {LeadingKind::exact, SchurKind::lsc, 14, 13}});
}

}  // namespace
}  // namespace faultsim
