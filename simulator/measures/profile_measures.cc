#include "simulator/measures/profile_measures.h"

#include <algorithm>
#include <cmath>
#include <utility>

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

/// Slip down a profile with its unsplit ends, from point to point.
struct SlipProfile {
  SlipProfile(const Profile& of, const Eigen::VectorXd& per_node)
      : profile(of),
        slip(per_node),
        has_tip(std::isnan(of.tip_before) ? 0 : 1),
        n_points(of.samples.size() + has_tip + (std::isnan(of.tip_after) ? 0 : 1)) {}
  bool is_sample(std::size_t i) const {
    return i >= has_tip && i - has_tip < profile.samples.size();
  }
  double s(std::size_t i) const {
    if (is_sample(i)) return profile.samples[i - has_tip].position;
    return i < has_tip ? profile.tip_before : profile.tip_after;
  }
  double value(std::size_t i) const {
    return is_sample(i) ? profile.samples[i - has_tip].slip(slip) : 0;
  }

  const Profile& profile;
  const Eigen::VectorXd& slip;
  std::size_t has_tip, n_points;
};

/// Length of the stretch of points first … last, all above the tolerance, and by how much its ends
/// may be misplaced.
struct Stretch {
  double length, doubt;  // m
};
Stretch stretch_of(const SlipProfile& p, std::size_t first, std::size_t last, double tolerance) {
  Stretch stretch{p.s(last) - p.s(first), 0};
  const auto add_end = [&](std::size_t inside, std::size_t outside) {
    const double cell = std::abs(p.s(outside) - p.s(inside));
    stretch.length += part_above(p.value(inside), p.value(outside), cell, tolerance);
    stretch.doubt += kEndShare * cell;
  };
  if (first > 0) add_end(first, first - 1);
  if (last + 1 < p.n_points) add_end(last, last + 1);
  return stretch;
}

}  // namespace

/// Shear and strength, side by side, in a dual cell and their integrals from the start of the
/// profile.
struct WindowSearch::Cell {
  Eigen::Array2d value{0, 0}, slope{0, 0}, before{0, 0};  // Pa, Pa/m, ∫ up to the cell
  /// The integrals up to a place in the cell, m from its two ends.
  Eigen::Array2d to(double from_start, double to_end) const {
    return before + (value - 0.5 * slope * to_end) * from_start;
  }
  double ratio() const { return value[0] / value[1]; }
};

WindowSearch::WindowSearch(const Profile& profile, double length)
    : profile_(profile), window_(std::min(length, profile.edge.back() - profile.edge.front())) {
  const std::vector<double>& edge = profile.edge;
  const std::size_t n = profile.samples.size();
  const auto middle = [&](std::size_t k) { return 0.5 * (edge[k] + edge[k + 1]); };
  for (std::size_t i = 1; i < n; ++i) middle_distance_.push_back(middle(i) - middle(i - 1));
  if (window_ <= 0) return;
  places_.reserve(2 * n + 1);
  const double last = edge.back() - window_;
  std::size_t i = 0, k = 0;
  for (double a = edge.front();;) {
    while (i + 1 < n && edge[i + 1] <= a) ++i;
    while (k + 1 < n && edge[k + 1] - window_ <= a) ++k;
    const double next = std::min({edge[i + 1], edge[k + 1] - window_, last});
    places_.push_back(place(i, k, a, next));
    a = next;
    if (next >= last) break;
  }
  places_.push_back(place(i, k, last, last));
}

/// @param first, last  dual cells of the window's ends.  @param end  of the place after.
WindowSearch::Place WindowSearch::place(std::size_t first, std::size_t last, double begin,
                                        double end) const {
  const auto cut = [this](std::size_t i, double s) {
    return Cut{i, s - profile_.edge[i], profile_.edge[i + 1] - s};
  };
  return {begin, cut(first, begin), cut(last, begin + window_), (end - begin) * (end - begin) / 8};
}

std::vector<WindowSearch::Cell> WindowSearch::cells(const Eigen::VectorXd& shear,
                                                    const Eigen::VectorXd& strength) const {
  const std::size_t n = profile_.samples.size();
  std::vector<Cell> cells(n);
  Eigen::Array2d slope_before(0, 0);  // between the cells before and this one
  for (std::size_t i = 0; i < n; ++i) {
    Cell& cell = cells[i];
    cell.value = {profile_.samples[i].of(shear), profile_.samples[i].of(strength)};
    if (i == 0) continue;
    Cell& previous = cells[i - 1];
    cell.before = previous.before + previous.value * profile_.share(i - 1);
    const Eigen::Array2d after = (cell.value - previous.value) / middle_distance_[i - 1];
    for (Eigen::Index part = 0; i > 1 && part < 2; ++part) {
      const double before = slope_before[part];
      if (before * after[part] > 0)
        previous.slope[part] = std::abs(before) < std::abs(after[part]) ? before : after[part];
    }
    slope_before = after;
  }
  return cells;
}

/// Both integrals over a window are parabolas of its begin from one place to the next. How much
/// they may differ from their chords there is known from the slopes at the ends of the window; so
/// only next to the largest quotient are parabolas formed.
WindowIndex WindowSearch::most_loaded(const Eigen::VectorXd& shear,
                                      const Eigen::VectorXd& strength) const {
  const std::vector<Cell> cells = this->cells(shear, strength);
  if (places_.empty()) return {cells[0].ratio(), 1};  // nothing to average
  const auto to = [&](const Cut& cut) { return cells[cut.cell].to(cut.from_start, cut.to_end); };
  std::vector<Eigen::Array2d> forces(places_.size());  // over the windows that begin at places
  Eigen::Array2d most_known(0, 1);
  for (std::size_t p = 0; p < places_.size(); ++p) {
    forces[p] = to(places_[p].end) - to(places_[p].start);
    if (forces[p][0] * most_known[1] > most_known[0] * forces[p][1]) most_known = forces[p];
  }
  constexpr double kRounding = 1 - 1e-9;
  const double known = most_known[0] / most_known[1] * kRounding;
  // How far a load is below what would be the known quotient; of both ends of a way the nearer.
  const auto lack = [known](const Eigen::Array2d& at) { return known * at[1] - at[0]; };
  double lack_here = lack(forces[0]);
  const std::vector<double>& edge = profile_.edge;
  double largest = 0, begin = 0;
  const Place* best = nullptr;
  for (std::size_t p = 0; p + 1 < places_.size(); ++p) {
    const Place& here = places_[p];
    const std::size_t first = here.start.cell, last = here.end.cell;
    const Eigen::Array2d off = (cells[last].slope - cells[first].slope).abs() * here.bulge;
    const double lack_next = lack(forces[p + 1]);
    const double nearer = std::min(std::exchange(lack_here, lack_next), lack_next);
    if (best != nullptr && nearer > off[0] + known * off[1]) continue;
    const auto over = [&](double t) -> Eigen::Array2d {
      const double from = here.begin + t * (places_[p + 1].begin - here.begin);
      const double until = from + window_;
      return cells[last].to(until - edge[last], edge[last + 1] - until) -
             cells[first].to(from - edge[first], edge[first + 1] - from);
    };
    const Eigen::Array2d at_0 = over(0), at_half = over(0.5), at_1 = over(1);
    const Parabola load(at_0[0], at_half[0], at_1[0]), bearing(at_0[1], at_half[1], at_1[1]);
    const double t = place_of_largest_quotient(load, bearing);
    const Eigen::Array2d at_largest = over(t);
    const double ratio = at_largest[0] / at_largest[1];
    if (best != nullptr && !(ratio > largest)) continue;
    largest = ratio;
    begin = here.begin + t * (places_[p + 1].begin - here.begin);
    best = &here;
  }
  const auto cells_to = [&](double s, std::size_t i) {
    return static_cast<double>(i) + (s - edge[i]) / profile_.share(i);
  };
  const double n_cells =
      cells_to(begin + window_, best->end.cell) - cells_to(begin, best->start.cell);
  // A mean is no more than the largest ratio, though the slopes of a cut cell may differ.
  double most = 0;
  for (std::size_t i = 0; i < cells.size() && most < largest; ++i)
    most = std::max(most, cells[i].ratio());
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
  if (std::ranges::none_of(profile.samples, slips)) return extent;
  const SlipProfile line(profile, slip);
  bool possible = false;
  for (std::size_t i = 0; i < line.n_points; ++i) {
    if (line.value(i) <= tolerance) continue;
    std::size_t last = i;
    while (last + 1 < line.n_points && line.value(last + 1) > tolerance) ++last;
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
