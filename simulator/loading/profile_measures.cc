#include "simulator/loading/profile_measures.h"

#include <algorithm>
#include <cmath>

namespace faultsim {
namespace {

constexpr double kEndShare = 0.5;  // of an end cell, by which the end of slip may be misplaced

/// Length of [0, width] where the line from a to b lies above the threshold.
double part_above(double a, double b, double width, double threshold) {
  if (a > threshold && b > threshold) return width;
  if (a <= threshold && b <= threshold) return 0;
  return width * (std::max(a, b) - threshold) / std::abs(a - b);
}

/// f0 + f1 t + f2 t² for 0 ≤ t ≤ 1.
struct Parabola {
  Parabola(double at_0, double at_half, double at_1)
      : f0(at_0), f1(-3 * at_0 + 4 * at_half - at_1), f2(2 * at_0 - 4 * at_half + 2 * at_1) {}
  double operator()(double t) const { return f0 + t * (f1 + t * f2); }
  /// Bounds of its values, by its control points.
  double upper() const { return std::max({f0, f0 + 0.5 * f1, f0 + f1 + f2}); }
  double lower() const { return std::min({f0, f0 + 0.5 * f1, f0 + f1 + f2}); }
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

/// Slip down a profile with its unsplit ends, from sample to sample.
struct SlipProfile {
  SlipProfile(const Profile& profile, const Eigen::VectorXd& slip) {
    s.reserve(profile.samples.size() + 2);
    value.reserve(profile.samples.size() + 2);
    if (!std::isnan(profile.tip_before)) add(profile.tip_before, 0);
    for (const ProfileSample& sample : profile.samples) add(sample.position, sample.slip(slip));
    if (!std::isnan(profile.tip_after)) add(profile.tip_after, 0);
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

/// Shear and strength in a dual cell and their integrals from the start of the profile.
struct WindowSearch::Cell {
  struct Part {
    double value = 0, slope = 0, before = 0;  // Pa, Pa/m, ∫ up to the cell
    /// The integral up to a place in the cell, m from its two ends.
    double to(double from_start, double to_end) const {
      return before + (value - 0.5 * slope * to_end) * from_start;
    }
  };
  Part shear, strength;
};

WindowSearch::WindowSearch(const Profile& profile, double length)
    : profile_(profile), window_(std::min(length, profile.edge.back() - profile.edge.front())) {
  const std::vector<double>& edge = profile.edge;
  const std::size_t n = profile.samples.size();
  const auto middle = [&](std::size_t k) { return 0.5 * (edge[k] + edge[k + 1]); };
  for (std::size_t i = 1; i < n; ++i) middle_distance_.push_back(middle(i) - middle(i - 1));
  if (window_ <= 0) return;
  const double last = edge.back() - window_;
  std::size_t i = 0, k = 0;
  for (double a = edge.front();;) {
    while (i + 1 < n && edge[i + 1] <= a) ++i;
    while (k + 1 < n && edge[k + 1] - window_ <= a) ++k;
    const double next = std::min({edge[i + 1], edge[k + 1] - window_, last});
    ranges_.push_back({i, k, a, next});
    if (next >= last) break;
    a = next;
  }
}

std::vector<WindowSearch::Cell> WindowSearch::cells(const Eigen::VectorXd& shear,
                                                    const Eigen::VectorXd& strength) const {
  const std::size_t n = profile_.samples.size();
  std::vector<Cell> cells(n);
  Cell last_slope;  // between the cells before and this one
  for (std::size_t i = 0; i < n; ++i) {
    Cell& cell = cells[i];
    cell.shear.value = profile_.samples[i].of(shear);
    cell.strength.value = profile_.samples[i].of(strength);
    if (i == 0) continue;
    for (Cell::Part Cell::*part : {&Cell::shear, &Cell::strength}) {
      Cell::Part &here = cell.*part, &previous = cells[i - 1].*part;
      here.before = previous.before + previous.value * profile_.share(i - 1);
      const double after = (here.value - previous.value) / middle_distance_[i - 1];
      double& before = (last_slope.*part).slope;
      if (i > 1 && before * after > 0)
        previous.slope = std::abs(before) < std::abs(after) ? before : after;
      before = after;
    }
  }
  return cells;
}

WindowIndex WindowSearch::most_loaded(const Eigen::VectorXd& shear,
                                      const Eigen::VectorXd& strength) const {
  const std::vector<Cell> cells = this->cells(shear, strength);
  const auto ratio_at = [&](std::size_t i) {
    return cells[i].shear.value / cells[i].strength.value;
  };
  if (ranges_.empty()) return {ratio_at(0), 1};  // nothing to average
  const std::vector<double>& edge = profile_.edge;
  const auto up_to = [&](Cell::Part Cell::*part, std::size_t i, double s) {
    return (cells[i].*part).to(s - edge[i], edge[i + 1] - s);
  };
  constexpr double kRounding = 1 - 1e-9;
  double largest = 0, place = 0;
  const Range* best = nullptr;
  for (const Range& range : ranges_) {
    // While neither end passes an edge both integrals are parabolas of the window's place.
    const std::size_t first = range.first, last = range.last;
    const auto over = [&](Cell::Part Cell::*part, double t) {
      const double from = range.begin + t * (range.end - range.begin);
      return up_to(part, last, from + window_) - up_to(part, first, from);
    };
    // Integrals grow with their ends, so most ranges need no more than this.
    if (best != nullptr &&
        up_to(&Cell::shear, last, range.end + window_) - up_to(&Cell::shear, first, range.begin) <
            largest * kRounding *
                (up_to(&Cell::strength, last, range.begin + window_) -
                 up_to(&Cell::strength, first, range.end)))
      continue;
    const auto parabola = [&](Cell::Part Cell::*part) {
      return Parabola(over(part, 0), over(part, 0.5), over(part, 1));
    };
    const Parabola load = parabola(&Cell::shear), bearing = parabola(&Cell::strength);
    if (best != nullptr && load.upper() < largest * bearing.lower() * kRounding) continue;
    const double t = place_of_largest_quotient(load, bearing);
    const double ratio = over(&Cell::shear, t) / over(&Cell::strength, t);
    if (best != nullptr && !(ratio > largest)) continue;
    largest = ratio;
    place = range.begin + t * (range.end - range.begin);
    best = &range;
  }
  const auto cells_to = [&](double s, std::size_t i) {
    return static_cast<double>(i) + (s - edge[i]) / profile_.share(i);
  };
  const double n_cells = cells_to(place + window_, best->last) - cells_to(place, best->first);
  // A mean is no more than the largest ratio, though the slopes of a cut cell may differ.
  double most = 0;
  for (std::size_t i = 0; i < cells.size() && most < largest; ++i)
    most = std::max(most, ratio_at(i));
  return {std::min(largest, most), n_cells};
}

double length_above(const Profile& profile, const Eigen::VectorXd& values, double threshold) {
  const std::vector<ProfileSample>& samples = profile.samples;
  double before = samples.front().of(values), length = 0;
  if (before > threshold) length += samples.front().position - profile.edge.front();
  if (samples.back().of(values) > threshold)
    length += profile.edge.back() - samples.back().position;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double value = samples[i].of(values);
    length += part_above(before, value, samples[i].position - samples[i - 1].position, threshold);
    before = value;
  }
  return length;
}

SlipExtent slip_extent(const Profile& profile, const Eigen::VectorXd& slip, double tolerance,
                       double length) {
  SlipExtent extent;
  const auto slips = [&](const ProfileSample& at) { return at.slip(slip) > tolerance; };
  if (std::none_of(profile.samples.begin(), profile.samples.end(), slips)) return extent;
  const SlipProfile line(profile, slip);
  bool possible = false;
  for (std::size_t i = 0; i < line.s.size(); ++i) {
    if (line.value[i] <= tolerance) continue;
    std::size_t last = i;
    while (last + 1 < line.s.size() && line.value[last + 1] > tolerance) ++last;
    const Stretch stretch = stretch_of(line, i, last, tolerance);
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
