#include "simulator/loads/fault_pressure_table.h"

#include <algorithm>
#include <cmath>

namespace faultsim {
namespace {

/// The two values around a place, and how far it is from the first to the second.
struct Between {
  std::size_t first = 0, second = 0;
  double share = 0;
};

Between between(const std::vector<double>& x, double at) {
  if (x.empty() || at <= x.front()) return {};
  if (at >= x.back()) return {x.size() - 1, x.size() - 1, 0};
  const auto next = static_cast<std::size_t>(std::upper_bound(x.begin(), x.end(), at) - x.begin());
  return {next - 1, next, (at - x[next - 1]) / (x[next] - x[next - 1])};
}

double mix(double share, double first, double second) { return first + share * (second - first); }

}  // namespace

double table_pressure(const FaultPressureTable& table, double dip, double strike, double time) {
  const Between i = between(table.dip, dip), j = between(table.strike, strike),
                t = between(table.time, time);
  const std::size_t n_strike = std::max<std::size_t>(table.strike.size(), 1);
  const auto at_time = [&](std::size_t row, std::size_t column) {
    const double* values = table.change.data() + (row * n_strike + column) * table.time.size();
    return mix(t.share, values[t.first], values[t.second]);
  };
  const auto at_dip = [&](std::size_t row) {
    return mix(j.share, at_time(row, j.first), at_time(row, j.second));
  };
  return mix(i.share, at_dip(i.first), at_dip(i.second));
}

TablePlace place_in_table(const Scene& scene, std::size_t fault, const OperatorNode& node) {
  const bool by_depth =
      scene.faults[fault].pressure.profile.place == FaultPressureTable::Place::depth;
  TablePlace place{-node.position.z(), node.position.y()};
  if (scene.geometry_kind == GeometryKind::field) return place;
  const PatchGeometry& patch = scene.box.patches[fault];
  const double s = std::sin(patch.strike), c = std::cos(patch.strike);
  const double dip = patch.dip_from_vertical;
  const Eigen::Vector3d down(c * std::sin(dip), -s * std::sin(dip), -std::cos(dip));
  const Eigen::Vector3d from =
      node.position - Eigen::Vector3d(patch.center[0], patch.center[1], patch.center[2]);
  place.strike = from.dot(Eigen::Vector3d(s, c, 0));
  if (!by_depth) place.dip = from.dot(down);
  return place;
}

}  // namespace faultsim
