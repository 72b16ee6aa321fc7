#include "campaign/rounds/limit_search.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/errors.h"

namespace faultsweep {
namespace {

constexpr double kRounding = 1e-9;  // of the tolerance: -37 and -38 are 1 apart

/// As many digits as a person would write: 0.3, not 0.30000000000000004.
double round_number(double value) { return std::stod(formatted("%.12g", value)); }

/// A value well between two others, on the grid if one of its points is.
double middle(double a, double b, double origin, double tolerance) {
  const double exact = 0.5 * (a + b);
  const double low = std::min(a, b), high = std::max(a, b);
  const double step = std::floor((exact - origin) / tolerance + kRounding);
  const double on_grid = round_number(origin + step * tolerance);
  const double margin = 0.25 * (high - low);  // a grid through an end would not halve
  const bool is_inside = on_grid >= low + margin && on_grid <= high - margin;
  return is_inside ? on_grid : round_number(exact);
}

/// The middle of the widest gap between neighbours from the crossing's one end to the other.
double widest_gap(const LimitFinding& finding, const Crossing& crossing, double origin,
                  double tolerance) {
  const auto at = [&](const SearchPoint& point) {
    return std::ranges::find(finding.points, point.value, &SearchPoint::value);
  };
  auto widest = at(crossing.before);
  for (auto one = widest; one != at(crossing.after); ++one) {
    if (std::abs(one[1].value - one->value) > std::abs(widest[1].value - widest->value))
      widest = one;
  }
  return middle(widest->value, widest[1].value, origin, tolerance);
}

LimitVerdict verdict_of(const LimitFinding& finding) {
  const auto known = std::ranges::find_if(
      finding.points, [](const auto& one) { return one.state != PointState::unknown; });
  if (known == finding.points.end() || known != finding.points.begin())
    return LimitVerdict::unknown;
  if (finding.crossings.empty())
    return known->state == PointState::safe ? LimitVerdict::safe_throughout
                                            : LimitVerdict::unsafe_throughout;
  const bool is_one = finding.crossings.size() == 1 && finding.crossings.front().is_limit();
  return is_one ? LimitVerdict::limit : LimitVerdict::non_monotone;
}

void find_crossings(LimitFinding& finding, double tolerance) {
  const SearchPoint* last = nullptr;
  int n_unknown = 0;  // since the last
  for (const SearchPoint& one : finding.points) {
    if (one.state == PointState::unknown) {
      ++n_unknown;
      ++finding.n_unknown;
      continue;
    }
    if (last != nullptr && last->state != one.state) {
      Crossing crossing{*last, one, n_unknown, false};
      crossing.narrow = crossing.width() <= tolerance * (1 + kRounding);
      finding.crossings.push_back(crossing);
    }
    last = &one;
    n_unknown = 0;
  }
}

void find_sure_points(LimitFinding& finding) {
  auto one = finding.points.begin();
  for (; one != finding.points.end(); ++one) {
    if (one->state == PointState::unsafe) break;
    if (one->state == PointState::unknown) continue;
    if (!one->resolved) break;
    finding.surely_safe = *one;
  }
  const auto unsafe = std::find_if(one, finding.points.end(), [](const SearchPoint& other) {
    return other.state == PointState::unsafe && other.resolved;
  });
  if (unsafe != finding.points.end()) finding.surely_unsafe = *unsafe;
}

}  // namespace

double Crossing::width() const { return std::abs(after.value - before.value); }

const Crossing* LimitFinding::limit() const {
  const bool has_one = verdict != LimitVerdict::unknown && !crossings.empty();
  return has_one && crossings.front().is_limit() ? &crossings.front() : nullptr;
}

LimitFinding judge(std::vector<SearchPoint> points, bool ascending, double tolerance) {
  std::ranges::sort(points, [&](const SearchPoint& a, const SearchPoint& b) {
    return ascending ? a.value < b.value : a.value > b.value;
  });
  LimitFinding finding;
  finding.points = std::move(points);
  find_crossings(finding, tolerance);
  finding.verdict = verdict_of(finding);
  find_sure_points(finding);
  return finding;
}

std::vector<double> next_values(const LimitFinding& finding, double origin, double tolerance) {
  std::vector<double> values;
  for (const Crossing& one : finding.crossings) {
    if (one.narrow || one.n_unknown >= kMostUnknown) continue;
    values.push_back(one.n_unknown == 0
                         ? middle(one.before.value, one.after.value, origin, tolerance)
                         : widest_gap(finding, one, origin, tolerance));
  }
  return values;
}

}  // namespace faultsweep
