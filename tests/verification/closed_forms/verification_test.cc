// Every verification case through the library that `faultsim verify` uses, one ctest each.
#include <gtest/gtest.h>

#include <cctype>

#include "simulator/common/run_context.h"
#include "tests/verification/closed_forms/verify_cases.h"

namespace faultsim {
namespace {

class Verification : public testing::TestWithParam<VerifyCase> {};

void expect_pass(const VerifyCase& verify_case) {
  SilentMonitor monitor;
  const VerifyReport report = run_verify_case(verify_case, monitor);
  EXPECT_TRUE(report.failure.empty()) << report.failure;
  EXPECT_FALSE(report.rows.empty());
  for (const VerifyRow& row : report.rows) {
    EXPECT_TRUE(row.pass) << row.quantity << ": expected " << row.expected << ", computed "
                          << row.computed << " " << row.unit << ", error " << row.error << " > "
                          << row.tolerance;
  }
}

TEST_P(Verification, MeetsItsClosedForm) { expect_pass(GetParam()); }

class VerificationSlow : public testing::TestWithParam<VerifyCase> {};
TEST_P(VerificationSlow, MeetsItsClosedForm) { expect_pass(GetParam()); }
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(VerificationSlow);

std::vector<VerifyCase> cases(bool slow) {
  std::vector<VerifyCase> selected;
  for (const VerifyCase& verify_case : verify_cases()) {
    if (verify_case.slow == slow) selected.push_back(verify_case);
  }
  return selected;
}

std::string test_name(const testing::TestParamInfo<VerifyCase>& info) {
  std::string name;
  for (const char c : info.param.name) {
    if (std::isalnum(static_cast<unsigned char>(c))) name += c;
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, Verification, testing::ValuesIn(cases(false)), test_name);
INSTANTIATE_TEST_SUITE_P(All, VerificationSlow, testing::ValuesIn(cases(true)), test_name);

}  // namespace
}  // namespace faultsim
