#include "simulator/result/approximation.h"

#include <gtest/gtest.h>

namespace faultsim {
namespace {

CaseResult interpolated() {
  CaseResult result;
  result.surface = CaseSurface{.n_operators = 75,
                               .n_basis = 70,
                               .n_checks = 12,
                               .tolerance = 1e-3,
                               .stiffness = 1.2e-4,
                               .traction = 3e-5,
                               .slip = 6e-4};
  return result;
}

TEST(ApproximationSentence, IsNoneOfAnExactResult) {
  EXPECT_EQ(approximation_sentence(CaseResult()), "");
  CaseResult covered;
  covered.field_coverage = 1 - 1e-15;
  EXPECT_EQ(approximation_sentence(covered), "");
}

TEST(ApproximationSentence, SaysTheMeasuredErrorsOfASurface) {
  CaseResult result = interpolated();
  EXPECT_EQ(
      approximation_sentence(result),
      "Its operator is interpolated between 75 exact ones, off by at most 1.2e-4 in H, 3e-5 in "
      "the locked traction and 6e-4 in slip without friction at 12 check points.");
  result.surface->observation = 2e-6;
  EXPECT_EQ(
      approximation_sentence(result),
      "Its operator is interpolated between 75 exact ones, off by at most 1.2e-4 in H, 3e-5 in "
      "the locked traction, 2e-6 in what is observed and 6e-4 in slip without friction at "
      "12 check points.");
}

TEST(ApproximationSentence, SaysHowFarCasesAreOff) {
  CaseResult result = interpolated();
  result.surface->n_cases = 24;
  result.surface->chi_bar = 1.31e-3;
  EXPECT_EQ(
      approximation_sentence(result),
      "Its operator is interpolated between 75 exact ones, off by at most 1.2e-4 in H, 3e-5 in "
      "the locked traction and 6e-4 in slip without friction at 12 check points; there χ̄ of "
      "24 cases is off by at most 1.4e-3.");
}

/// "At most" must stay true.
TEST(ApproximationSentence, RoundsErrorsUp) {
  const struct {
    double error;
    const char* text;
  } errors[] = {{1.2000001e-4, "1.3e-4 in H"}, {9.91e-3, "1e-2 in H"}, {1e-3, "1e-3 in H"},
                {9.9e-8, "9.9e-8 in H"},       {0.07, "7e-2 in H"},    {0, " 0 in H"},
                {1.01e-300, "1.1e-300 in H"},  {0.999999, "1e0 in H"}};
  for (const auto& [error, text] : errors) {
    CaseResult result = interpolated();
    result.surface->stiffness = error;
    EXPECT_NE(approximation_sentence(result).find(text), std::string::npos)
        << approximation_sentence(result);
  }
}

TEST(ApproximationSentence, SaysWhatAFlowResultCoversAndNoMore) {
  const struct {
    double share;
    const char* text;
  } shares[] = {{0.26, "26 %"},     {0.263999, "26.3 %"},
                {0.9999, "99.9 %"}, {4e-4, "less than 0.1 %"},
                {0.29, "29 %"},     {0, "less than 0.1 %"}};
  for (const auto& [share, text] : shares) {
    CaseResult result;
    result.field_coverage = share;
    EXPECT_EQ(approximation_sentence(result),
              std::string("Its flow result covers ") + text + " of the compartments.");
  }
}

TEST(ApproximationSentence, SaysHowMuchOfTheChangeIsNotAssumed) {
  CaseResult result;
  result.field_coverage = 0.26;
  result.field_assumed = 0.6;
  EXPECT_EQ(approximation_sentence(result),
            "Its flow result covers 26 % of the compartments, and 40 % of the integral of its "
            "change there.");
}

TEST(ApproximationSentence, SaysBothOneAfterTheOther) {
  CaseResult result = interpolated();
  result.field_coverage = 0.5;
  const std::string text = approximation_sentence(result);
  EXPECT_NE(text.find("check points. Its flow result covers 50 %"), std::string::npos) << text;
}

}  // namespace
}  // namespace faultsim
