#include "simulator/laws/maxwell.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace faultsim {
namespace {

constexpr double kG = 15.384615e9, kViscosity = 1e17, kTau = kViscosity / kG;
constexpr MaxwellScheme kExponential = MaxwellScheme::exponential;
constexpr MaxwellScheme kBackwardEuler = MaxwellScheme::backward_euler;

TEST(Maxwell, ConstantStrainRateIsExactInAnyNumberOfSteps) {
  const double rate = 1e-11, end = 5 * kTau;
  const double exact = 2 * kViscosity * rate * -std::expm1(-end / kTau);
  for (const int n : {1, 2, 7, 100}) {
    const MaxwellStep step = maxwell_step(kG, kViscosity, end / n, kExponential);
    double s = 0;
    for (int i = 0; i < n; ++i) s = step.decay * s + 2 * kG * step.shear_factor * rate * end / n;
    EXPECT_NEAR(s / exact, 1, 1e-14) << n << " steps";
  }
}

TEST(Maxwell, AYearIsSeventyFiveDaysOfRelaxationTimes) {
  const double year = 365.25 * 86400;
  EXPECT_NEAR(maxwell_step(kG, kViscosity, year, kExponential).decay, 0.00779, 5e-6);
  EXPECT_NEAR(maxwell_step(kG, kViscosity, year, kBackwardEuler).decay, 0.1708, 5e-5);
}

TEST(Maxwell, BackwardEulerConvergesToTheSameAtFirstOrder) {
  const double exact = std::exp(-1.0);
  double last = 0;
  for (const int n : {64, 128}) {
    const MaxwellStep step = maxwell_step(kG, kViscosity, kTau / n, kBackwardEuler);
    const double error = std::pow(step.decay, n) - exact;
    if (last > 0) {
      EXPECT_NEAR(last / error, 2, 0.05);
    }
    last = error;
  }
}

TEST(Maxwell, ExtremeStepsKeepTheirDigits) {
  for (const MaxwellScheme scheme : {kExponential, kBackwardEuler}) {
    const MaxwellStep tiny = maxwell_step(kG, kViscosity, 1e-9 * kTau, scheme);
    EXPECT_NEAR(tiny.relaxed, 1e-9, 2e-18);
    EXPECT_NEAR(tiny.shear_factor, 1 - (scheme == kExponential ? 0.5e-9 : 1e-9), 1e-15);
    const MaxwellStep long_step = maxwell_step(kG, kViscosity, 1e6 * kTau, scheme);
    EXPECT_NEAR(long_step.shear_factor * 1e6, 1, 2e-6);
    EXPECT_LE(long_step.decay, 1e-6);
  }
  EXPECT_EQ(maxwell_step(kG, kViscosity, 1e6 * kTau, kExponential).decay, 0);
}

TEST(Maxwell, NoTimeOrNoFlowIsElastic) {
  const double infinite = std::numeric_limits<double>::infinity();
  for (const MaxwellStep& step : {maxwell_step(kG, kViscosity, 0, kExponential),
                                  maxwell_step(kG, infinite, 1e9, kExponential)}) {
    EXPECT_EQ(step.decay, 1);
    EXPECT_EQ(step.relaxed, 0);
    EXPECT_EQ(step.shear_factor, 1);
  }
}

}  // namespace
}  // namespace faultsim
