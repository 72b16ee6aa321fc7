#pragma once

#include <string>
#include <vector>

namespace faultsim::figure {

/// A named place; both coordinates > 0.
struct LogPoint {
  double x = 1, y = 1;
  std::string name;
};
struct LogSeries {
  std::string name;
  std::vector<LogPoint> points;  ///< joined in this order.
};
/// Series of few points on two logarithmic axes, as errors against cost.
struct LogChart {
  std::string title, x_label, y_label;
  std::vector<LogSeries> series;
};
/// @pre some series has a point.
std::string draw(const LogChart& chart);

}  // namespace faultsim::figure
