#include "simulator/corner_point/fault_description.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <numeric>

#include "simulator/corner_point/straight_trace.h"

namespace faultsim::corner_point {
namespace {

Spread spread_of(std::vector<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  double median = *middle;
  if (values.size() % 2 == 0) median = (median + *std::max_element(values.begin(), middle)) / 2;
  const auto ends = std::ranges::minmax(values);
  return {median, ends.min, ends.max};
}

/// From the pillar further west at the reference height, then further south.
std::vector<int> from_the_west(const ColumnMap& map, std::vector<int> pillars, double z) {
  const Eigen::Vector2d first = map.grid().pillars[pillars.front()].at(z),
                        last = map.grid().pillars[pillars.back()].at(z);
  if (last.x() < first.x() || (last.x() == first.x() && last.y() < first.y()))
    std::ranges::reverse(pillars);
  return pillars;
}

void take_trace(const ColumnMap& map, const std::vector<int>& pillars, double z,
                double straightening, Fault& fault) {
  for (const int pillar : pillars) fault.pillars.push_back(map.grid().pillars[pillar].at(z));
  std::array<std::vector<double>, 2> lengths;  // along i and j
  for (std::size_t e = 0; e + 1 < pillars.size(); ++e) {
    const bool is_along_i = std::abs(pillars[e + 1] - pillars[e]) == 1;
    lengths[is_along_i ? 0 : 1].push_back((fault.pillars[e + 1] - fault.pillars[e]).norm());
  }
  for (const std::vector<double>& along : lengths) {
    if (!along.empty()) fault.cell = std::max(fault.cell, spread_of(along).median);
  }
  fault.trace = straight_trace(fault.pillars, straightening * fault.cell);
  if (pillars.front() == pillars.back())
    fault.trace.front() = fault.trace.back() = (fault.trace.front() + fault.trace.back()) / 2;
}

void take_offsets(Fault& fault) {
  const bool is_closed = fault.edges.front().from == fault.edges.back().to;
  const std::size_t n = fault.edges.size();
  for (std::size_t p = 0; p <= n; ++p) {
    double sum = 0;
    int count = 0;
    if (p > 0 || is_closed) {
      sum += fault.edges[(p + n - 1) % n].offset_to;
      count += 1;
    }
    if (p < n || is_closed) {
      sum += fault.edges[p % n].offset_from;
      count += 1;
    }
    fault.offset.push_back(sum / count);
  }
  double highest = 0, lowest = 0;
  for (const FaultEdge& edge : fault.edges) {
    fault.largest_offset = std::max(fault.largest_offset, edge.largest());
    const double mean = (edge.offset_from + edge.offset_to) / 2;
    highest = std::max(highest, mean);
    lowest = std::min(lowest, mean);
  }
  constexpr double kOtherWay = 0.1;  // of the largest: less is no second direction
  fault.down = highest >= -lowest ? Side::right : Side::left;
  if (std::min(highest, -lowest) > kOtherWay * std::max(highest, -lowest)) fault.down = Side::both;
}

/// Of one pillar: across the trace, horizontally down the fault, per height; its size is cot(dip).
Eigen::Vector2d lean_across(const Pillar& pillar, const Eigen::Vector2d& tangent) {
  const Eigen::Vector3d along = pillar.bottom - pillar.top;
  if (along.z() == 0) return {0, 0};
  const Eigen::Vector2d lean = along.head<2>() / -along.z();
  return lean - lean.dot(tangent) * tangent;
}

double pillar_angle(const Pillar& pillar) {
  const Eigen::Vector3d along = pillar.bottom - pillar.top;
  return along.z() == 0 ? 0 : std::atan2(along.head<2>().norm(), std::abs(along.z()));
}

/// The angle a in (−π, π].
double turned(double a) { return std::remainder(a, 2 * std::numbers::pi); }

void take_dips(const ColumnMap& map, const std::vector<int>& pillars, Fault& fault) {
  std::vector<double> dips, angles, directions;
  constexpr double kReach = 2;  // cells: so that short pieces do not matter
  double to_left = 0;
  Eigen::Vector2d sum(0, 0);
  for (std::size_t p = 0; p < pillars.size(); ++p) {
    const Pillar& pillar = map.grid().pillars[pillars[p]];
    const Eigen::Vector2d tangent = tangent_of(
        fault.trace, nearest_on_line(fault.trace, fault.pillars[p]).along, kReach * fault.cell);
    const Eigen::Vector2d lean = lean_across(pillar, tangent);
    dips.push_back(std::atan2(1, lean.norm()));
    angles.push_back(pillar_angle(pillar));
    directions.push_back(std::atan2(lean.x(), lean.y()));
    fault.lean.push_back(-cross_product(tangent, lean));
    to_left += cross_product(tangent, lean);
    sum += lean;
  }
  fault.dip = spread_of(dips);
  fault.pillar_angle = spread_of(angles);
  constexpr double kVertical = 0.1 * std::numbers::pi / 180;
  if (fault.dip.median > std::numbers::pi / 2 - kVertical) return;
  fault.dips_towards = to_left > 0 ? Side::left : Side::right;
  const double mean = std::atan2(sum.x(), sum.y());
  for (double& direction : directions) direction = turned(direction - mean);
  const Spread around = spread_of(directions);
  fault.direction_spread = std::max(around.most - around.median, around.median - around.least);
  const double azimuth = turned(mean + around.median);
  fault.dip_direction = azimuth < 0 ? azimuth + 2 * std::numbers::pi : azimuth;
}

}  // namespace

std::vector<int> pillars_of(const Fault& fault) {
  std::vector<int> pillars = {fault.edges.front().from};
  for (const FaultEdge& edge : fault.edges) pillars.push_back(edge.to);
  return pillars;
}

Fault described_fault(const ColumnMap& map, const EdgeChain& chain, double reference_z,
                      double straightening) {
  const std::vector<int> pillars = from_the_west(map, chain.pillars, reference_z);
  Fault fault;
  for (std::size_t p = 0; p + 1 < pillars.size(); ++p)
    fault.edges.push_back(map.measured(pillars[p], pillars[p + 1]));
  take_trace(map, pillars, reference_z, straightening, fault);
  for (const Eigen::Vector2d& middle : middles_of(fault.pillars)) {
    fault.largest_distance =
        std::max(fault.largest_distance, nearest_on_line(fault.trace, middle).distance);
  }
  take_offsets(fault);
  take_dips(map, pillars, fault);
  return fault;
}

}  // namespace faultsim::corner_point
