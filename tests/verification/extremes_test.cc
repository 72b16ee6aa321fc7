// The campaign of extremes, thinned: every case ends in a stated outcome, and whatever misses a
// limit of the diagnosis is said by the result itself (results/extremes has all cases).

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "campaign/expansion/expansion.h"
#include "simulator/loading/diagnosis.h"
#include "simulator/reading/read_scene.h"

namespace faultsim {
namespace {

faultsweep::Expansion extremes() {
  return faultsweep::expand(faultsweep::read_campaign(std::string(FAULTSIM_SOURCE_DIR) +
                                                      "/docs/examples/campaigns/extremes.json"));
}

class Diagnoser {
 public:
  explicit Diagnoser(const faultsweep::Expansion& expansion) : expansion_(expansion) {}

  Diagnosis run(const faultsweep::Case& one, const DiagnosisLimits& limits = {}) {
    const Scene scene = read_scene(
        parse_json(faultsweep::scene_of(expansion_, one).dump(), expansion_.spec.scene_source));
    std::vector<Problem> problems;
    const Plan plan = make_plan(scene, problems);
    EXPECT_TRUE(problems.empty());
    if (one.family != family_) {
      prepared_ = prepare_operator(scene, plan, {}, false, monitor_);
      family_ = one.family;
    }
    return diagnose_case(scene, prepared_, monitor_, limits);
  }

 private:
  const faultsweep::Expansion& expansion_;
  PreparedOperator prepared_;
  int family_ = -1;
  SilentMonitor monitor_;
};

void expect_no_unflagged_violation(const Diagnosis& d) {
  EXPECT_NE(d.result.outcome, Outcome::failed) << d.result.reason;
  EXPECT_NE(d.result.outcome, Outcome::interrupted);
  if (!in_equilibrium(d.result.outcome)) {
    EXPECT_FALSE(d.result.reason.empty());
  }
  for (const Violation& violation : d.violations) EXPECT_TRUE(violation.told) << violation.what;
}

/// Every stride-th case of each group from `first`; the groups named in `skip` not.
int diagnose_some(const faultsweep::Expansion& expansion, int first, int stride,
                  const std::string& skip) {
  Diagnoser diagnoser(expansion);
  std::map<int, int> seen;
  int n = 0;
  for (const faultsweep::Case& one : expansion.cases) {
    const int place = seen[one.group]++;
    if (place % stride != first) continue;
    const std::string& group = expansion.spec.groups[static_cast<std::size_t>(one.group)].name;
    if (group == skip) continue;
    SCOPED_TRACE(group + ", case " + std::to_string(one.index + 1));
    expect_no_unflagged_violation(diagnoser.run(one));
    ++n;
  }
  return n;
}

TEST(Extremes, HaveThreeHundredCases) { EXPECT_GE(extremes().cases.size(), 300u); }

TEST(Extremes, OneOfEachGroupShowsNoUnflaggedViolation) {
  EXPECT_GE(diagnose_some(extremes(), 5, 60, "salt"), 10);
}

/// What the tests around this one look for would be seen.
TEST(Extremes, WouldShowAViolationUntold) {
  const faultsweep::Expansion expansion = extremes();
  const Diagnosis d =
      Diagnoser(expansion).run(expansion.cases[5], {.residual = 0, .noise_change = 0});
  ASSERT_GE(d.violations.size(), 2u);
  for (const Violation& violation : d.violations) EXPECT_FALSE(violation.told) << violation.what;
}

TEST(Extremes, EverySixthShowsNoUnflaggedViolationSlow) {
  EXPECT_GE(diagnose_some(extremes(), 2, 6, ""), 50);
}

}  // namespace
}  // namespace faultsim
