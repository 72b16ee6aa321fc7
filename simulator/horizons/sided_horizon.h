#pragma once

#include <functional>
#include <string>
#include <vector>

#include "simulator/horizons/cut_map.h"
#include "simulator/horizons/map_locator.h"
#include "simulator/horizons/sided_points.h"

namespace faultsim::horizons {

/// What all horizons of points share.
struct SidedGround {
  const LayeredBody& body;
  const MapMesh& map;
  const std::vector<MapSide>& sides;
  const Pillars& pillars;
  const MapLocator& locator;
};

/// A horizon of points that are interpolated on either side of faults by themselves.
///
/// It is cut along faults without a throw, where it is not above or below their ends in depth. A
/// place of the map takes the depth of the points' triangulation, as a horizon without such faults
/// does, where the place sees all points that it comes from; the LocalFit to the points that it
/// sees, elsewhere: beside faults. Points stand on the map where their pillars do.
///
/// A place that sees none takes what is as even as can be between its neighbours (∫|∇z|² is
/// least).
class SidedHorizon {
 public:
  using Surface = std::function<double(const Eigen::Vector2d& xy)>;
  /// The depth at which a pillar meets a surface.
  using Meet = std::function<double(const Surface& surface)>;

  /// A part of the map that faults close off and that has no point is appended to problems, with
  /// its place; then depths are not to be asked.
  SidedHorizon(const SidedGround& ground, int horizon, const PointSurface& surface,
               std::vector<Problem>& problems);

  /// The horizon's places, a vertex having one per side of what it is cut along.
  const CutMap& cut() const { return cut_; }
  /// Of a place, m, where nothing is moved.
  double depth(int place) const { return depth_[place]; }
  /// The same where throws are added: `meet` knows them.
  double depth(int place, const Meet& meet) const;
  /// What else points have, > 0, per place: from the points, and by the rule, that its depth is
  /// from; of places that see none as even as can be.
  std::vector<double> beside(const std::vector<double>& values) const;

 private:
  using Pieces = std::vector<TracePiece>;

  void find_pieces();
  void cut_along_pieces();
  std::vector<MapBarriers::Stretch> stretches() const;
  void find_starts();
  bool check_parts(std::vector<Problem>& problems) const;
  std::string names_around(const std::vector<int>& parts, int part) const;
  void find_depths();
  bool join_beyond_ends();
  void fill_unseen(std::vector<double>& values) const;

  SidedGround ground_;
  int horizon_;
  std::vector<PlaceOnMap> stands_;       ///< per point of the surface.
  std::vector<Eigen::Vector2d> on_map_;  ///< the same.
  const PointSurface& surface_;
  SidedPoints points_;
  Pieces pieces_;  ///< that it is cut along.
  MapBarriers barriers_;
  CutMap cut_;
  std::vector<Eigen::Vector2d> from_;  ///< per place, from where points are looked at.
  std::vector<double> depth_;          ///< per place; NaN while nothing is seen.
};

}  // namespace faultsim::horizons
