#include "simulator/flow/flow_field.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "simulator/common/text.h"

namespace faultsim {
namespace {

constexpr double kHydrostatic = 1e4;  ///< Pa/m
constexpr double kFarAbove = 4;       ///< beyond rock's own weight, 2.3, with room for shallow gas.
constexpr double kFarBelow = 0.1;     ///< a field begins depleted at times, but not at 1 bar.

/// The corners of a box.
CellCorners corners_of(const FlowCell& box) {
  const Eigen::Vector3d &a = box.low, &b = box.high;
  return {{{a.x(), a.y(), a.z()},
           {b.x(), a.y(), a.z()},
           {b.x(), b.y(), a.z()},
           {a.x(), b.y(), a.z()},
           {a.x(), a.y(), b.z()},
           {b.x(), a.y(), b.z()},
           {b.x(), b.y(), b.z()},
           {a.x(), b.y(), b.z()}}};
}

/// Where a field's cells are in other coordinates.
class Placement {
 public:
  Placement(const std::array<double, 2>& origin, double azimuth)
      : origin_(origin),
        cos_(std::cos(azimuth)),
        sin_(std::sin(azimuth)),
        stays_(origin == std::array<double, 2>{0, 0} && azimuth == 0) {}
  FlowCell moved(const FlowCell& cell) const {
    if (stays_) return cell;
    CellCorners corners = cell.corners.value_or(corners_of(cell));
    for (Eigen::Vector3d& corner : corners) {
      const double x = corner.x() - origin_[0], y = corner.y() - origin_[1];
      corner = {cos_ * x - sin_ * y, sin_ * x + cos_ * y, corner.z()};
    }
    return flow_cell_around(corners);
  }

 private:
  std::array<double, 2> origin_;
  double cos_, sin_;
  bool stays_;
};

/// Of the corners, mm, in an order that does not depend on theirs.
using CornerKey = std::vector<std::array<long, 3>>;

CornerKey corner_key(const FlowCell& cell, double y_sign) {
  CornerKey key;
  for (const Eigen::Vector3d& at : cell.corners.value_or(corners_of(cell))) {
    key.push_back(
        {std::lround(1e3 * at.x()), std::lround(1e3 * y_sign * at.y()), std::lround(1e3 * at.z())});
  }
  std::ranges::sort(key);
  return key;
}

}  // namespace

FlowCell flow_cell_around(const CellCorners& corners) {
  FlowCell cell{.low = corners[0], .high = corners[0]};
  for (const Eigen::Vector3d& corner : corners) {
    cell.low = cell.low.cwiseMin(corner);
    cell.high = cell.high.cwiseMax(corner);
  }
  if (corners != corners_of(cell)) cell.corners = corners;
  return cell;
}

FlowField placed(const FlowField& field, const std::array<double, 2>& origin, double azimuth) {
  FlowField moved = field;
  const Placement place(origin, azimuth);
  for (FlowCell& cell : moved.cells) cell = place.moved(cell);
  return moved;
}

FlowField placed_within(const FlowField& field, const std::array<double, 2>& origin, double azimuth,
                        const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  FlowField part{.cells = {}, .date = field.date};
  const Placement place(origin, azimuth);
  std::vector<Eigen::Index> rows;
  for (std::size_t f = 0; f < field.cells.size(); ++f) {
    const FlowCell cell = place.moved(field.cells[f]);
    if ((cell.low.array() >= high.array()).any() || (cell.high.array() <= low.array()).any())
      continue;
    part.cells.push_back(cell);
    rows.push_back(static_cast<Eigen::Index>(f));
  }
  part.value = field.value(rows, Eigen::all);
  return part;
}

std::string pressure_doubt(const FlowField& field) {
  std::vector<double> ratios;
  for (std::size_t f = 0; f < field.cells.size(); ++f) {
    const double depth = -0.5 * (field.cells[f].low.z() + field.cells[f].high.z());
    const Eigen::Index row = static_cast<Eigen::Index>(f);
    if (depth > 0) ratios.push_back(field.value(row, 0) / (kHydrostatic * depth));
  }
  if (ratios.empty()) return "";
  const auto middle = ratios.begin() + std::ssize(ratios) / 2;
  std::nth_element(ratios.begin(), middle, ratios.end());
  if (*middle >= kFarBelow && *middle <= kFarAbove) return "";
  return formatted(
      "the first report's pressures are %.3g times hydrostatic (median over cells); %s, and depths "
      "in another unit look the same: check the units in the header",
      *middle,
      *middle > kFarAbove ? "psi read as bar is 14.5 times too high"
                          : "bar read as psi is 14.5 times too low");
}

std::optional<double> asymmetry(const FlowField& field) {
  std::map<CornerKey, Eigen::Index> cell_at;
  for (std::size_t c = 0; c < field.cells.size(); ++c)
    cell_at[corner_key(field.cells[c], 1)] = static_cast<Eigen::Index>(c);
  double difference = 0;
  for (std::size_t c = 0; c < field.cells.size(); ++c) {
    const auto image = cell_at.find(corner_key(field.cells[c], -1));
    if (image == cell_at.end()) return std::nullopt;
    const auto row = static_cast<Eigen::Index>(c);
    difference = std::max(
        difference, (field.value.row(row) - field.value.row(image->second)).cwiseAbs().maxCoeff());
  }
  const double largest = field.value.cwiseAbs().maxCoeff();
  return largest > 0 ? difference / largest : difference;
}

}  // namespace faultsim
