#pragma once

#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "campaign/statistics/intervals.h"

/// Tables of coverage_study, as Markdown.
namespace faultsweep::testing {

inline constexpr double kConfidence = 0.95;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Of one row of a table.
class Tally {
 public:
  void add(const Interval& bounds, double truth) {
    // An index that is known exactly is off by rounding.
    held_ += bounds.low <= truth + 1e-12 && truth - 1e-12 <= bounds.high;
    ++n_, width_ += bounds.high - bounds.low;
  }
  /// The same, with the interval of what the expensive model says alone.
  void add(const Interval& bounds, double truth, const Interval& alone) {
    add(bounds, truth);
    alone_ += alone.high - alone.low;
  }
  void print(const std::string& first, const std::string& second) const {
    const double n = static_cast<double>(n_), width = width_ / n;
    char text[32], ratio[32] = "";
    std::snprintf(text, sizeof text, "%.3g", width);
    if (alone_ > 0) std::snprintf(ratio, sizeof ratio, " %.2f |", width_ / alone_);
    std::printf("| %s | %s | %.1f | %s |%s\n", first.c_str(), second.c_str(),
                100.0 * static_cast<double>(held_) / n, std::isfinite(width) ? text : "open",
                ratio);
  }

 private:
  long held_ = 0, n_ = 0;
  double width_ = 0, alone_ = 0;
};

inline void heading(const char* title, const char* columns) {
  std::printf("\n### %s\n\n| %s | covers, %% | mean width |\n|---|---|---|---|\n", title, columns);
}
/// With a column for Tally::add with what is known alone.
inline void heading_beside_alone(const char* title, const char* columns) {
  std::printf(
      "\n### %s\n\n| %s | covers, %% | mean width | over that of the expensive model alone |\n"
      "|---|---|---|---|---|\n",
      title, columns);
}

/// A size of sample, with a remark where it is below what is asked for.
inline std::string sized(long n, long fewest) {
  return std::to_string(n) + (n < fewest ? ", below the minimum" : "");
}

}  // namespace faultsweep::testing
