#include "simulator/flow/mirror.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

namespace faultsim {
namespace {

using CornerKey =
    std::vector<long>;  // of the corners, mm, in an order that does not depend on theirs

CornerKey corner_key(const FlowCell& cell, double y_sign) {
  std::vector<std::array<long, 3>> corners;
  const auto add = [&](const Eigen::Vector3d& at) {
    corners.push_back(
        {std::lround(1e3 * at.x()), std::lround(1e3 * y_sign * at.y()), std::lround(1e3 * at.z())});
  };
  if (cell.corners) {
    for (const Eigen::Vector3d& corner : *cell.corners) add(corner);
  } else {
    for (const double x : {cell.low.x(), cell.high.x()})
      for (const double y : {cell.low.y(), cell.high.y()})
        for (const double z : {cell.low.z(), cell.high.z()}) add({x, y, z});
  }
  std::ranges::sort(corners);
  CornerKey key;
  for (const auto& corner : corners) key.insert(key.end(), corner.begin(), corner.end());
  return key;
}

}  // namespace

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
