#include "simulator/grid_scene/fault_dips.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulator/common/ranges.h"
#include "simulator/common/text.h"
#include "simulator/corner_point/fault_description.h"
#include "simulator/corner_point/straight_trace.h"

namespace faultsim::grid_scene {
namespace {

using corner_point::nearest_on_line;
using Eigen::Vector2d;

double median_of(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t n = values.size();
  return (values[(n - 1) / 2] + values[n / 2]) / 2;
}

/// The trace with points between, at most so far apart.
Polyline with_points(const Polyline& trace, double apart) {
  Polyline line = {trace.front()};
  for (std::size_t k = 1; k < trace.size(); ++k) {
    const int n =
        std::max(1, static_cast<int>(std::ceil((trace[k] - trace[k - 1]).norm() / apart)));
    for (int i = 1; i < n; ++i)
      line.push_back(trace[k - 1] + (trace[k] - trace[k - 1]) * (static_cast<double>(i) / n));
    line.push_back(trace[k]);
  }
  return line;
}

/// Degrees from the horizontal.
double dip_degrees(double lean) { return std::atan2(1, std::abs(lean)) * 180 / std::numbers::pi; }

/// "42", or "42 to 57"; through the vertical "42 over 90 to 85".
std::string dips_of(const std::vector<double>& leans) {
  const auto [least, most] = std::ranges::minmax(leans);
  if (least * most < 0)
    return formatted("%.0f over 90 to %.0f", dip_degrees(least), dip_degrees(most));
  const double one = dip_degrees(least), other = dip_degrees(most);
  const std::string first = formatted("%.0f", std::min(one, other)),
                    last = formatted("%.0f", std::max(one, other));
  return first == last ? first : first + " to " + last;
}

/// Of leans, at the points of a trace.
std::vector<double> means_along(const std::vector<FaultPillar>& pillars, double reach,
                                const Polyline& trace) {
  std::vector<double> along, means;
  for (const FaultPillar& pillar : pillars)
    along.push_back(nearest_on_line(trace, pillar.at).along);
  const auto [first, last] = std::ranges::minmax(along);
  double place = 0;
  for (std::size_t k = 0; k < trace.size(); ++k) {
    if (k > 0) place += (trace[k] - trace[k - 1]).norm();
    // Beyond the pillars as at the last of them.
    const double at = std::clamp(place, first, last);
    double sum = 0, weight = 0;
    for (std::size_t p = 0; p < pillars.size(); ++p) {
      const double away = (along[p] - at) / reach, one = std::exp(-away * away);
      sum += one * pillars[p].lean;
      weight += one;
    }
    means.push_back(sum / weight);
  }
  return means;
}

}  // namespace

std::vector<FaultPillar> fault_pillars(const corner_point::ColumnMap& map,
                                       const corner_point::Fault& fault, double reference_z) {
  const corner_point::CornerPointGrid& grid = map.grid();
  const std::vector<int> numbers = corner_point::pillars_of(fault);
  std::vector<FaultPillar> pillars;
  for (std::size_t p = 0; p < numbers.size(); ++p) {
    double top = -1e300, base = 1e300;
    for (const corner_point::FaultEdge& edge : fault.edges) {
      if (edge.from != numbers[p] && edge.to != numbers[p]) continue;
      for (const int column : {edge.left, edge.right}) {
        corner_point::CornerPlace corner = map.corner_at(column, numbers[p]);
        top = std::max(top, grid.z(column, map.top_layer(column), corner));
        corner.bottom = true;
        base = std::min(base, grid.z(column, map.base_layer(column), corner));
      }
    }
    const corner_point::Pillar& pillar = grid.pillars[numbers[p]];
    pillars.push_back(
        {pillar.at(reference_z), fault.lean[p], pillar.at(top), pillar.at(base), top, base});
  }
  return pillars;
}

void take_dips(const std::vector<FaultPillar>& pillars, double reach, double reference_z,
               ModelFault& fault) {
  fault.leans = {median_of(mapped(pillars, &FaultPillar::lean))};
  if (!(reach > 0)) return;
  ModelFault changing = fault;
  changing.trace = with_points(fault.trace, reach);
  changing.leans = means_along(pillars, reach, changing.trace);
  constexpr double kGain = 0.95;  // so that dips which are alike are one
  const double plain = mean_distance(pillars, fault, reference_z);
  if (mean_distance(pillars, changing, reference_z) < kGain * plain) fault = std::move(changing);
}

double mean_distance(const std::vector<FaultPillar>& pillars, const ModelFault& fault,
                     double reference_z) {
  double sum = 0;
  for (const FaultPillar& pillar : pillars) {
    const Polyline top = fault.at(pillar.top_z, reference_z),
                   base = fault.at(pillar.base_z, reference_z);
    sum += nearest_on_line(top, pillar.top).distance;
    sum += nearest_on_line(base, pillar.base).distance;
  }
  return sum / (2 * static_cast<double>(pillars.size()));
}

std::string dips_text(const std::vector<FaultPillar>& pillars, const ModelFault& fault,
                      double reach, double reference_z) {
  const std::string measured = dips_of(mapped(pillars, &FaultPillar::lean)),
                    taken = dips_of(fault.leans);
  const double away = mean_distance(pillars, fault, reference_z);
  if (fault.leans.size() == 1) {
    return fault.name + " has one dip, " + taken + " degrees, the median of its pillars' (" +
           measured + "), which are " + formatted("%.0f m", away) +
           " from it at the reservoir's top and base on average: with dips that change along it "
           "pillars would cross, or hardly be nearer";
  }
  ModelFault plain = fault;
  take_dips(pillars, 0, reference_z, plain);
  return fault.name + " dips by " + taken + " degrees along its trace, its pillars by " + measured +
         formatted(
             " (means over %.0f m); at the reservoir's top and base they are %.0f m from it "
             "on average, with one dip %.0f m",
             reach, away, mean_distance(pillars, plain, reference_z));
}

}  // namespace faultsim::grid_scene
