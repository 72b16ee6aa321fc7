// Reports that a history can do without.
#include "simulator/flow/report_choice.h"

#include <gtest/gtest.h>

#include <cmath>

namespace faultsim {
namespace {

TEST(NeededReports, AreTheCornersOfWhatIsPiecewiseLinear) {
  const std::vector<double> time{0, 1, 3, 4, 5};
  Eigen::MatrixXd value(2, 5);
  value << 0, 1, 3, 3, 3,  //
      0, 2, 6, 8, 10;
  EXPECT_EQ(needed_reports(time, value, 1e-12), (std::vector<int>{0, 2, 4}));
}

TEST(NeededReports, LeaveAnErrorWithinTheBound) {
  std::vector<double> time;
  Eigen::MatrixXd value(1, 60);
  for (int i = 0; i < 60; ++i) {
    time.push_back(i * (1 + 0.01 * i));
    value(0, i) = 100 * std::exp(-time.back() / 20);
  }
  for (const double bound : {0.0, 0.5, 5.0}) {
    const std::vector<int> kept = needed_reports(time, value, bound);
    EXPECT_EQ(kept.front(), 0);
    EXPECT_EQ(kept.back(), 59);
    EXPECT_EQ(kept.size() == 60, bound == 0);
    for (std::size_t k = 1; k < kept.size(); ++k) {
      const int a = kept[k - 1], b = kept[k];
      for (int i = a; i <= b; ++i) {
        const double share = (time[i] - time[a]) / (time[b] - time[a]);
        EXPECT_LE(std::abs(value(0, a) + share * (value(0, b) - value(0, a)) - value(0, i)),
                  bound + 1e-12);
      }
    }
  }
}

TEST(NeededReports, OfOneReportIsThatOne) {
  EXPECT_EQ(needed_reports({7}, Eigen::MatrixXd::Ones(3, 1), 0), std::vector<int>{0});
}

}  // namespace
}  // namespace faultsim
