// The verification engine must be able to say no.
#include "tests/verification/closed_forms/verify_report.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "simulator/common/errors.h"
#include "tests/verification/closed_forms/verify.h"
#include "tests/verification/closed_forms/verify_cases.h"

namespace faultsim {
namespace {

TEST(VerifyReport, MissesWhatIsOutsideItsTolerance) {
  VerifyReport report;
  report.compare("inside", "m", 2, 2.019, 0.01);
  EXPECT_TRUE(report.passed());
  report.compare("outside", "m", 2, 2.021, 0.01);
  EXPECT_FALSE(report.rows.back().pass);
  EXPECT_FALSE(report.passed());
}

TEST(VerifyReport, NeverPassesNotANumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  VerifyReport report;
  report.compare("compared", "", 1, nan, 1e9);
  report.bound("bounded", "", nan, 1e9);
  report.at_least("order", -1e9, nan);
  for (const VerifyRow& row : report.rows) EXPECT_FALSE(row.pass) << row.quantity;
  EXPECT_TRUE(report_to_json(report)["rows"][0]["computed"].is_null());
}

TEST(VerifyReport, DoesNotPassWhenNothingWasCompared) {
  VerifyReport report;
  EXPECT_FALSE(report.passed());
  report.holds("a statement", true);
  EXPECT_TRUE(report.passed());
  report.failure = "could not be evaluated";
  EXPECT_FALSE(report.passed());
}

TEST(VerifyReport, MeasuresTheOrderOfConvergence) {
  EXPECT_DOUBLE_EQ(observed_order(0.4, 0.1), 2);
  EXPECT_DOUBLE_EQ(observed_order(0.4, 0.2), 1);
}

TEST(VerifyCases, HaveUniqueNamesAndCoverV1ToV8) {
  std::set<std::string> names, problems;
  for (const VerifyCase& verify_case : verify_cases()) {
    EXPECT_TRUE(names.insert(verify_case.name).second) << verify_case.name;
    problems.insert(verify_case.name.substr(0, 2));
    for (const std::string& scene : verify_case.scenes)
      EXPECT_FALSE(verification_scene(scene).empty());
  }
  EXPECT_EQ(problems, (std::set<std::string>{"V1", "V2", "V3", "V4", "V5", "V6", "V7", "V8"}));
}

TEST(VerifyCases, TurnAnErrorIntoAFailure) {
  class Quiet final : public Monitor {
    void progress(double, const std::string&) override {}
    void note(const std::string&) override {}
  } monitor;
  const VerifyCase broken = {
      "V0-broken", "wrong scene", {}, false, [](SceneRunner& runner, VerifyReport&) {
        runner.run("v1_patch_test.json", {{"/mesh/dip", "25"}});
      }};
  const VerifyReport report = run_verify_case(broken, monitor);
  EXPECT_FALSE(report.passed());
  EXPECT_NE(report.failure.find("/mesh/dip"), std::string::npos) << report.failure;
}

TEST(VerifyCommand, RefusesUnknownNames) {
  EXPECT_THROW(verify_command({"V1", "V77"}, false, false, false), InputError);
}

}  // namespace
}  // namespace faultsim
