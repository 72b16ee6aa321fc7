#include "simulator/result/result_sentences.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace faultsim {
namespace {

/// One flag that the cells decide and one that they leave open: nobody may read that both slide.
TEST(SlidingSentence, DoesNotSayMoreOfAFaultThanItsCellsTell) {
  CaseResult result;
  result.whole.activated = true;
  for (const char* name : {"F1", "F2", "F3"}) {
    FaultStageMetrics fault;
    fault.fault = name;
    fault.activated = fault.fault != "F3";
    fault.activation_resolved = fault.fault != "F2";
    fault.max_slip = 0.02;
    result.whole.faults.push_back(fault);
  }
  EXPECT_EQ(sliding_sentence(result),
            "F1 slides, slip 0.02 m; F2 may slide, slip 0.02 m (the cells do not tell).");
}

/// A case that was stopped is not one in which nothing slides.
TEST(SlidingSentence, SaysHowFarAHistoryGoes) {
  CaseResult result;
  result.outcome = Outcome::interrupted;
  EXPECT_EQ(sliding_sentence(result), "No load step was completed: what slides is not known.");
  result.steps.resize(2);
  result.steps[1].step = 1;
  result.whole.chi_bar = 0.5;
  EXPECT_EQ(sliding_sentence(result),
            "Nothing slides up to load step 1, where the case ended: χ̄ comes to 0.5.");
  result.outcome = Outcome::converged;
  EXPECT_EQ(sliding_sentence(result), "Nothing slides: χ̄ comes to 0.5.");
}

}  // namespace
}  // namespace faultsim
