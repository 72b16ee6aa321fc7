#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace faultsim {

/// Where a line down dip meets the surface: on the edge from point `from` to point `to`.
struct DipCrossing {
  Eigen::Vector3d place;
  int from = -1, to = -1;  ///< the same where it is a point.
  double share = 0;        ///< 0 at `from`, 1 at `to`.
};

/// Unit vectors of a fault whose trace does not bend.
struct StrikeAndDip {
  Eigen::Vector3d strike, dip;
};

/// A fault as a surface, and the lines down its dip: where its position along strike is constant.
class DipLines {
 public:
  /// @param faces   of points, cyclic; corners may be there twice, as in OperatorFault::faces.
  /// @param straight  position along strike is the projection onto its strike; none: the fault may
  ///                  bend, and it is the strike_coordinate().
  DipLines(std::vector<Eigen::Vector3d> points, const std::vector<std::array<int, 4>>& faces,
           const std::optional<StrikeAndDip>& straight = std::nullopt);

  double along(int point) const { return along_[point]; }  ///< position along strike, m.
  /// Points that faces connect are one part, counted from 0; lines keep to a part.
  int part(int point) const { return part_[point]; }
  int n_points() const { return static_cast<int>(points_.size()); }
  const Eigen::Vector3d& point(int k) const { return points_[k]; }
  /// Mean direction of along().
  const Eigen::Vector3d& strike() const { return strike_; }
  /// From one crossing to another along strike, m. @param a, b  of lines at these positions.
  double between(const DipCrossing& a, const DipCrossing& b) const;
  /// Least extent of a face along strike, m; infinite where none has any (plane strain).
  double narrowest() const { return narrowest_; }
  /// Whether two positions along strike differ by rounding only.
  bool is_same(double along, double other) const;

  /// All points and edges of a part that the line at this position meets, down dip.
  std::vector<DipCrossing> line(double at, int part) const;

 private:
  void add_face(const std::array<int, 4>& face);
  double down(const Eigen::Vector3d& place) const { return place.dot(dip_); }
  double along_of(const DipCrossing& at) const;

  std::vector<Eigen::Vector3d> points_;
  std::vector<double> along_;
  std::vector<int> part_;
  Eigen::Vector3d strike_, dip_;
  bool is_straight_;
  double narrowest_;
  std::set<std::pair<int, int>> edges_;  // lower point first
};

}  // namespace faultsim
