#include "simulator/model/dip_lines.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulator/model/strike_coordinate.h"

namespace faultsim {

using Eigen::Vector3d;

namespace {

constexpr double kOnLine = 1e-6;  // of the narrowest face: rounding of positions
constexpr double kFlat = 1e-9;    // of a face: rounding of an edge down dip

}  // namespace

DipLines::DipLines(std::vector<Vector3d> points, const std::vector<std::array<int, 4>>& faces,
                   const std::optional<StrikeAndDip>& straight)
    : points_(std::move(points)),
      is_straight_(straight.has_value()),
      narrowest_(std::numeric_limits<double>::infinity()) {
  if (straight) {
    strike_ = straight->strike;
    dip_ = straight->dip;
    part_ = connected_parts(points_.size(), faces);
    for (const Vector3d& point : points_) along_.push_back(point.dot(strike_));
  } else {
    StrikeCoordinate found = strike_coordinate(points_, faces);
    strike_ = found.mean;
    dip_ = -Vector3d::UnitZ();
    part_ = std::move(found.part);
    along_ = std::move(found.along);
  }
  for (const std::array<int, 4>& face : faces) add_face(face);
}

void DipLines::add_face(const std::array<int, 4>& face) {
  double low = along_[face[0]], high = low;
  for (std::size_t i = 0; i < 4; ++i) {
    low = std::min(low, along_[face[i]]);
    high = std::max(high, along_[face[i]]);
    const auto [from, to] = std::minmax(face[i], face[(i + 1) % 4]);
    if (from != to) edges_.emplace(from, to);
  }
  const double size = (points_[face[2]] - points_[face[0]]).norm();
  if (high - low > kFlat * size) narrowest_ = std::min(narrowest_, high - low);
}

bool DipLines::is_same(double along, double other) const {
  return std::abs(along - other) <= kOnLine * narrowest_;
}

double DipLines::along_of(const DipCrossing& at) const {
  return (1 - at.share) * along_[at.from] + at.share * along_[at.to];
}

double DipLines::between(const DipCrossing& a, const DipCrossing& b) const {
  return is_straight_ ? (b.place - a.place).dot(strike_) : along_of(b) - along_of(a);
}

std::vector<DipCrossing> DipLines::line(double at, int part) const {
  std::vector<DipCrossing> found;
  for (int i = 0; i < n_points(); ++i) {
    if (part_[i] == part && is_same(along_[i], at)) found.push_back({points_[i], i, i, 0});
  }
  for (const auto& [from, to] : edges_) {
    if (part_[from] != part || (along_[from] < at) == (along_[to] < at) ||
        is_same(along_[from], at) || is_same(along_[to], at))
      continue;
    const double share = (at - along_[from]) / (along_[to] - along_[from]);
    found.push_back({points_[from] + share * (points_[to] - points_[from]), from, to, share});
  }
  std::ranges::stable_sort(found, [&](const DipCrossing& a, const DipCrossing& b) {
    return down(a.place) < down(b.place);
  });
  return found;
}

}  // namespace faultsim
