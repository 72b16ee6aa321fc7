#include "simulator/result/result.h"

#include <gtest/gtest.h>

#include <cmath>

#include "simulator/common/errors.h"
#include "simulator/model/fault_operator.h"

namespace faultsim {
namespace {

TEST(Outcome, NamesGoBothWays) {
  for (const Outcome outcome : {Outcome::failed, Outcome::converged, Outcome::unconverged,
                                Outcome::unstable, Outcome::interrupted}) {
    EXPECT_EQ(stored_word<Outcome>(to_string(outcome), "outcome"), outcome);
  }
  EXPECT_STREQ(to_string(Outcome::unstable), "unstable");
  EXPECT_THROW(stored_word<Outcome>("fine", "outcome"), StorageError);
  EXPECT_EQ(CaseResult().outcome, Outcome::failed);
}

TEST(MomentMagnitude, FollowsHanksAndKanamori) {
  EXPECT_DOUBLE_EQ(moment_magnitude(std::pow(10.0, 9.1)).value(), 0.0);
  EXPECT_NEAR(moment_magnitude(1.26e15).value(), 4.0, 1e-3);
  EXPECT_NEAR(moment_magnitude(1e12).value() - moment_magnitude(1e9).value(), 2.0, 1e-14);
}

TEST(MomentMagnitude, IsNoneWithoutAMoment) {
  EXPECT_FALSE(moment_magnitude(0).has_value());
  EXPECT_FALSE(moment_magnitude(-1).has_value());
  EXPECT_FALSE(moment_magnitude(std::nan("")).has_value());
}

}  // namespace
}  // namespace faultsim
