#include "simulator/loading/column_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace faultsim {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kEndShare = 0.5;  // of an end cell, by which the end of slip may be misplaced

/// Length of [0, width] where the line from a to b lies above the threshold.
double part_above(double a, double b, double width, double threshold) {
  if (a > threshold && b > threshold) return width;
  if (a <= threshold && b <= threshold) return 0;
  return width * (std::max(a, b) - threshold) / std::abs(a - b);
}

/// Integral of a nodal profile from the start of the column: the sum of each dual cell is kept, and
/// within it the profile is sloped by the lesser of the slopes to its neighbours, 0 where these
/// differ in sign and in the end cells.
class ProfileIntegral {
 public:
  ProfileIntegral(const Column& column, const Eigen::VectorXd& profile) : column_(column) {
    sum_.push_back(0);
    for (std::size_t i = 0; i < column.nodes.size(); ++i) {
      value_.push_back(profile[column.nodes[i]]);
      sum_.push_back(sum_.back() + value_[i] * column.share(i));
    }
    for (std::size_t i = 0; i < value_.size(); ++i) slope_.push_back(limited_slope(i));
  }
  /// Up to s, which lies in dual cell i.
  double to(double s, std::size_t i) const {
    const double from = column_.edge[i], end = column_.edge[i + 1];
    return sum_[i] + (value_[i] - 0.5 * slope_[i] * (end - s)) * (s - from);
  }

 private:
  double limited_slope(std::size_t i) const {
    if (i == 0 || i + 1 == value_.size()) return 0;
    const auto middle = [&](std::size_t k) {
      return 0.5 * (column_.edge[k] + column_.edge[k + 1]);
    };
    const double before = (value_[i] - value_[i - 1]) / (middle(i) - middle(i - 1));
    const double after = (value_[i + 1] - value_[i]) / (middle(i + 1) - middle(i));
    if (before * after <= 0) return 0;
    return std::abs(before) < std::abs(after) ? before : after;
  }

  const Column& column_;
  std::vector<double> value_, slope_, sum_;
};

/// Dual cells from the start of the column to s, which lies in cell i.
double cells_to(const Column& column, double s, std::size_t i) {
  return static_cast<double>(i) + (s - column.edge[i]) / column.share(i);
}

/// f0 + f1 t + f2 t² for 0 ≤ t ≤ 1.
struct Parabola {
  Parabola(double at_0, double at_half, double at_1)
      : f0(at_0), f1(-3 * at_0 + 4 * at_half - at_1), f2(2 * at_0 - 4 * at_half + 2 * at_1) {}
  double operator()(double t) const { return f0 + t * (f1 + t * f2); }
  double f0, f1, f2;
};

/// Where f/g is largest in [0, 1]: at an end, or at a root of f' g − f g', which is quadratic.
double place_of_largest_quotient(const Parabola& f, const Parabola& g) {
  const double c = f.f1 * g.f0 - f.f0 * g.f1, b = f.f2 * g.f0 - f.f0 * g.f2,
               a = f.f2 * g.f1 - f.f1 * g.f2;  // a t² + 2 b t + c
  double best = f(1) / g(1) > f(0) / g(0) ? 1 : 0;
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return best;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  for (const double root : {a != 0 ? q / a : -1, q != 0 ? c / q : -1}) {
    if (root > 0 && root < 1 && f(root) / g(root) > f(best) / g(best)) best = root;
  }
  return best;
}

/// The slip profile of a column with its unsplit ends, from cell to cell.
struct SlipProfile {
  SlipProfile(const Column& column, const std::vector<double>& slip) {
    if (!std::isnan(column.tip_before)) add(column.tip_before, 0);
    for (std::size_t i = 0; i < slip.size(); ++i) add(column.position[i], slip[i]);
    if (!std::isnan(column.tip_after)) add(column.tip_after, 0);
  }
  void add(double at, double slip) {
    s.push_back(at);
    value.push_back(slip);
  }
  std::vector<double> s, value;
};

/// Length of the stretch of points first … last, all above the tolerance, and by how much its ends
/// may be misplaced.
struct Stretch {
  double length, doubt;  // m
};
Stretch stretch_of(const SlipProfile& p, std::size_t first, std::size_t last, double tolerance) {
  Stretch stretch{p.s[last] - p.s[first], 0};
  const auto add_end = [&](std::size_t inside, std::size_t outside) {
    const double cell = std::abs(p.s[outside] - p.s[inside]);
    stretch.length += part_above(p.value[inside], p.value[outside], cell, tolerance);
    stretch.doubt += kEndShare * cell;
  };
  if (first > 0) add_end(first, first - 1);
  if (last + 1 < p.s.size()) add_end(last, last + 1);
  return stretch;
}

}  // namespace

double Column::length() const {
  return (std::isnan(tip_after) ? position.back() : tip_after) -
         (std::isnan(tip_before) ? position.front() : tip_before);
}

Column make_column(const OperatorFault& fault, int fault_index, int j) {
  Column column{fault_index, fault.column_width[j], {}, {}, {}, kNaN, kNaN, false};
  double s = 0;
  const Eigen::Vector3d* last = nullptr;
  for (int row = 0; row < fault.n_rows; ++row) {
    const int point = j * fault.n_rows + row;
    if (fault.grid_used[point] == 0) continue;
    if (last != nullptr) s += (fault.grid_position[point] - *last).norm();
    last = &fault.grid_position[point];
    if (fault.grid_node[point] >= 0) {
      column.nodes.push_back(fault.grid_node[point]);
      column.position.push_back(s);
    } else if (column.nodes.empty()) {
      column.tip_before = s;
    } else if (std::isnan(column.tip_after)) {
      column.tip_after = s;
    }
  }
  if (column.nodes.empty()) return column;
  const std::vector<double>& x = column.position;
  const auto end = [](double tip, double node) {
    return std::isnan(tip) ? node : 0.5 * (tip + node);
  };
  column.edge.push_back(end(column.tip_before, x.front()));
  for (std::size_t i = 1; i < x.size(); ++i) column.edge.push_back(0.5 * (x[i - 1] + x[i]));
  column.edge.push_back(end(column.tip_after, x.back()));
  return column;
}

WindowIndex window_critical_index(const Column& column, const Eigen::VectorXd& shear,
                                  const Eigen::VectorXd& strength, double length) {
  const std::size_t n = column.nodes.size();
  if (n == 0) return {};
  const ProfileIntegral load(column, shear), bearing(column, strength);
  const std::vector<double>& edge = column.edge;
  const double window = std::min(length, edge.back() - edge.front());
  // One node between faces of the body: nothing to average.
  if (window <= 0) return {shear[column.nodes[0]] / strength[column.nodes[0]], 1};
  const double last = edge.back() - window;
  WindowIndex best;
  std::size_t i = 0, k = 0;  // dual cells of the two ends
  for (double a = edge.front();;) {
    while (i + 1 < n && edge[i + 1] <= a) ++i;
    while (k + 1 < n && edge[k + 1] - window <= a) ++k;
    // While neither end passes an edge both integrals are parabolas of the window's place.
    const double next = std::min({edge[i + 1], edge[k + 1] - window, last});
    const auto over = [&](const ProfileIntegral& integral, double t) {
      const double from = a + t * (next - a);
      return integral.to(from + window, k) - integral.to(from, i);
    };
    const auto parabola = [&](const ProfileIntegral& integral) {
      return Parabola(over(integral, 0), over(integral, 0.5), over(integral, 1));
    };
    const double t = place_of_largest_quotient(parabola(load), parabola(bearing));
    const double ratio = over(load, t) / over(bearing, t), from = a + t * (next - a);
    if (best.n_cells == 0 || ratio > best.critical_index)
      best = {ratio, cells_to(column, from + window, k) - cells_to(column, from, i)};
    if (next >= last) break;
    a = next;
  }
  double most = 0;  // a mean is no more, though the slopes of a cut cell may differ
  for (const int node : column.nodes) most = std::max(most, shear[node] / strength[node]);
  best.critical_index = std::min(best.critical_index, most);
  return best;
}

double length_above(const Column& column, const Eigen::VectorXd& profile, double threshold) {
  const auto& x = column.position;
  const std::size_t n = x.size();
  if (n == 0) return 0;
  double length = 0;
  if (profile[column.nodes.front()] > threshold) length += x.front() - column.edge.front();
  if (profile[column.nodes.back()] > threshold) length += column.edge.back() - x.back();
  for (std::size_t i = 1; i < n; ++i) {
    length += part_above(profile[column.nodes[i - 1]], profile[column.nodes[i]], x[i] - x[i - 1],
                         threshold);
  }
  return length;
}

SlipExtent slip_extent(const Column& column, const std::vector<double>& slip, double tolerance,
                       double length) {
  const SlipProfile profile(column, slip);
  SlipExtent extent;
  bool possible = false;
  for (std::size_t i = 0; i < profile.s.size(); ++i) {
    if (profile.value[i] <= tolerance) continue;
    std::size_t last = i;
    while (last + 1 < profile.s.size() && profile.value[last + 1] > tolerance) ++last;
    const Stretch stretch = stretch_of(profile, i, last, tolerance);
    extent.total += stretch.length;
    extent.longest = std::max(extent.longest, stretch.length);
    extent.surely =
        extent.surely || (stretch.length - stretch.doubt >= length && last - i >= kLeastCells);
    possible = possible || stretch.length + stretch.doubt >= length;
    i = last;
  }
  extent.reaches = extent.longest >= length;
  extent.resolved = extent.surely || !possible;
  return extent;
}

}  // namespace faultsim
