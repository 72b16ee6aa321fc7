#include "campaign/statistics/calibrated_share.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "tests/unit/statistics/tier_models.h"

namespace faultsweep {
namespace {

using testing::TierDraw;
using testing::TierModel;

double width(const Estimate& one) { return one.bounds.high - one.bounds.low; }

TEST(CalibratedShare, Covers) {
  std::mt19937_64 random(3);
  const TierModel models[] = {{.correlation = 0.9, .share = 0.3},
                              {.share = 0.5, .turned = 0.1},
                              {.correlation = 0, .share = 0.1},
                              {.share = 0.05, .only_there = 0.05}};
  for (const TierModel& model : models) {
    int held = 0;
    for (int repeat = 0; repeat < 400; ++repeat) {
      const TierDraw draw(model, 60, 600, random);
      const Interval bounds = calibrated_share(draw.flags, draw.standard()).estimate(0.95).bounds;
      held += bounds.low <= model.truth() && model.truth() <= bounds.high;
    }
    EXPECT_GE(held, 365) << model.share;
    EXPECT_LE(held, 396) << model.share;
  }
}

/// What a flag of the cheap model leaves open near the limit, its index decides.
TEST(CalibratedShare, IsCloserThanTheFlagsAlone) {
  std::mt19937_64 random(5);
  const TierModel model{.correlation = 0.9985, .share = 0.4};
  double calibrated = 0, by_flag = 0, alone = 0;
  constexpr int kRepeats = 100;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    const TierDraw draw(model, 100, 10'000, random);
    const std::vector<std::vector<double>> flag = {draw.features[2]};
    const CalibratedShare found = calibrated_share(draw.flags, draw.standard());
    const auto squared = [&](double value) { return std::pow(value - model.truth(), 2); };
    calibrated += squared(found.estimate(0.95).value);
    by_flag += squared(calibrated_share(draw.flags, {flag, 10'000}).estimate(0.95).value);
    alone += squared(found.as_computed.direct(0.95).value);
  }
  EXPECT_LT(calibrated, 0.15 * alone) << "squared errors";
  EXPECT_LT(calibrated, by_flag);
}

TEST(CalibratedShare, SaysLittleLessThanTheFlagsWhereTheCheapModelSaysNothing) {
  std::mt19937_64 random(6);
  double calibrated = 0, alone = 0;
  for (int repeat = 0; repeat < 50; ++repeat) {
    const TierDraw draw({.correlation = 0, .share = 0.3}, 40, 1000, random);
    const CalibratedShare found = calibrated_share(draw.flags, draw.standard());
    calibrated += width(found.estimate(0.95)), alone += width(found.as_computed.direct(0.95));
  }
  EXPECT_LT(calibrated, 1.06 * alone);
  EXPECT_GT(calibrated, 0.97 * alone);
}

TEST(CalibratedShare, WithoutUndecidedFlagsIsOneEstimate) {
  std::mt19937_64 random(7);
  const TierDraw draw({.share = 0.3}, 50, 500, random);
  const CalibratedShare found = calibrated_share(draw.flags, draw.standard());
  EXPECT_EQ(found.n_undecided, 0u);
  EXPECT_EQ(found.by_undecided(0.95), 0);
  EXPECT_EQ(found.by_number(0.95), half_width(found.estimate(0.95)));
}

/// Flags within a distance of the limit are open: bounds hold either way, and each part of their
/// width is what it would be.
TEST(CalibratedShare, UndecidedFlagsWidenTheBoundsToEitherSide) {
  std::mt19937_64 random(8);
  const TierDraw draw({.share = 0.4, .open = 0.2}, 200, 2000, random);
  std::vector<Flag> open = draw.flags, as_no = draw.flags, as_yes = draw.flags;
  std::size_t n_open = 0;
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (!draw.near[i]) continue;
    ++n_open;
    open[i] = draw.flags[i] == Flag::yes ? Flag::undecided_yes : Flag::undecided_no;
    as_no[i] = Flag::no, as_yes[i] = Flag::yes;
  }
  ASSERT_GT(n_open, 10u);
  const StandardFeatures features = draw.standard();
  const CalibratedShare found = calibrated_share(open, features);
  const Estimate computed = calibrated_share(draw.flags, features).estimate(0.95);
  const Estimate least = calibrated_share(as_no, features).estimate(0.95);
  const Estimate most = calibrated_share(as_yes, features).estimate(0.95);
  const Estimate both = found.estimate(0.95);
  EXPECT_EQ(found.n_undecided, n_open);
  EXPECT_EQ(both.value, computed.value);
  EXPECT_EQ(both.bounds.low, least.bounds.low);
  EXPECT_EQ(both.bounds.high, most.bounds.high);
  EXPECT_EQ(found.by_number(0.95), half_width(computed));
  EXPECT_EQ(found.by_undecided(0.95), 0.5 * (most.value - least.value));
  EXPECT_NEAR(found.by_undecided(0.95), 0.5 * static_cast<double>(n_open) / 200, 0.02);
}

/// Where nothing ever happens, or always, the truth is inside and the bounds are no point.
TEST(CalibratedShare, HoldsZeroAndOne) {
  std::mt19937_64 random(5);
  const TierDraw draw({.share = 0.3}, 100, 3000, random);
  for (const Flag flag : {Flag::no, Flag::yes}) {
    const Interval bounds =
        calibrated_share(std::vector<Flag>(100, flag), draw.standard()).estimate(0.95).bounds;
    const double truth = flag == Flag::yes ? 1 : 0;
    EXPECT_LE(bounds.low, truth);
    EXPECT_GE(bounds.high, truth);
    EXPECT_GT(bounds.high - bounds.low, 0.02);
    EXPECT_LT(bounds.high - bounds.low, 0.05);
  }
}

/// Features that cannot be used are left out: what remains is the share of the flags.
TEST(CalibratedShare, StandsWithoutFeatures) {
  std::vector<Flag> flags(40, Flag::no);
  flags[5] = flags[17] = Flag::yes;
  const std::vector<std::vector<double>> constant = {std::vector<double>(300, 1.0)};
  const Estimate found = calibrated_share(flags, StandardFeatures(constant, 300)).estimate(0.95);
  EXPECT_NEAR(found.value, 0.05, 0.002);
}

}  // namespace
}  // namespace faultsweep
