#include "simulator/horizons/sided_horizon.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulator/common/ranges.h"
#include "simulator/horizons/map_operator.h"
#include "simulator/horizons/meet_pillar.h"

namespace faultsim::horizons {
namespace {

using Eigen::Vector2d;

constexpr double kOnTrace = 1e-3;  // of a cell: points so near belong to neither side
constexpr double kInside = 1e-4;   // of the way from a vertex into its triangle

std::vector<const MapSide*> sides_of_pieces(const std::vector<TracePiece>& pieces) {
  std::vector<const MapSide*> sides;
  for (const TracePiece& piece : pieces) sides.push_back(piece.side);
  std::ranges::sort(sides);
  return sides;
}

std::vector<PlaceOnMap> places_of_points(const SidedGround& ground, const PointSurface& surface) {
  std::vector<PlaceOnMap> stands;
  for (const Eigen::Vector3d& point : surface.points())
    stands.push_back(ground.locator.find(point));
  return stands;
}

std::vector<Vector2d> only_places(const std::vector<PlaceOnMap>& stands) {
  std::vector<Vector2d> at;
  for (const PlaceOnMap& one : stands) at.push_back(one.at);
  return at;
}

}  // namespace

SidedHorizon::SidedHorizon(const SidedGround& ground, int horizon, const PointSurface& surface,
                           std::vector<Problem>& problems)
    : ground_(ground),
      horizon_(horizon),
      stands_(places_of_points(ground, surface)),
      on_map_(only_places(stands_)),
      surface_(surface),
      points_(surface, on_map_),
      barriers_({}) {
  find_pieces();
  do {
    cut_along_pieces();
    find_depths();
  } while (join_beyond_ends());
  if (check_parts(problems)) fill_unseen(depth_);
}

/// Of faults without a throw, where points near them are not all above or below their ends.
void SidedHorizon::find_pieces() {
  for (const TracePiece& piece : trace_pieces(ground_.map, ground_.sides)) {
    const LayeredFault& fault = ground_.body.faults[piece.fault];
    if (fault.moved) continue;
    if (fault.top || fault.bottom) {
      const auto [least, most] = points_.depths_near(ground_.map.vertices[piece.side->a]);
      if (least > fault.top.value_or(ground_.body.top)) continue;
      if (most < fault.bottom.value_or(ground_.body.base)) continue;
    }
    pieces_.push_back(piece);
  }
}

void SidedHorizon::cut_along_pieces() {
  cut_ = cut_map(ground_.map, ground_.sides, sides_of_pieces(pieces_));
  barriers_ = MapBarriers(stretches());
  points_.leave_out(barriers_, kOnTrace * ground_.body.cells.at_faults);
  find_starts();
}

/// The pieces; and where one ends at the edge of the box, its way on: nothing looks around it.
std::vector<MapBarriers::Stretch> SidedHorizon::stretches() const {
  const MapMesh& map = ground_.map;
  const LayeredBody& body = ground_.body;
  std::vector<MapBarriers::Stretch> all;
  for (const TracePiece& piece : pieces_) {
    const std::vector<int>& line = map.lines[piece.fault];
    const std::array<std::size_t, 2> ends = {piece.k, piece.k + 1};
    all.push_back({map.vertices[line[ends[0]]], map.vertices[line[ends[1]]]});
    for (const std::size_t end : {0u, 1u}) {
      if (ends[end] != 0 && ends[end] + 1 != line.size()) continue;
      const Vector2d &at = all.back()[0], &to = all.back()[1];
      const Vector2d tip = end == 0 ? at : to, way = end == 0 ? at - to : to - at;
      if (((tip - body.low).array() * (body.high - tip).array()).minCoeff() > 0) continue;
      all.push_back({tip, tip + way.normalized() * (body.high - body.low).norm()});
    }
  }
  return all;
}

/// A place beside a piece looks from a little inside of the triangle that is least along pieces.
void SidedHorizon::find_starts() {
  const MapMesh& map = ground_.map;
  std::vector<std::vector<Vector2d>> along(map.vertices.size());
  for (const TracePiece& piece : pieces_) {
    const Vector2d way = (map.vertices[piece.side->b] - map.vertices[piece.side->a]).normalized();
    along[piece.side->a].push_back(way);
    along[piece.side->b].push_back(-way);
  }
  from_.clear();
  for (const int vertex : cut_.vertex) from_.push_back(map.vertices[vertex]);
  std::vector<double> least(cut_.n_places(), std::numeric_limits<double>::infinity());
  for (std::size_t t = 0; t < map.triangles.size(); ++t) {
    const std::array<int, 3>& corners = map.triangles[t];
    const Vector2d middle =
        (map.vertices[corners[0]] + map.vertices[corners[1]] + map.vertices[corners[2]]) / 3;
    for (std::size_t v = 0; v < 3; ++v) {
      if (along[corners[v]].empty()) continue;
      const Vector2d way = middle - map.vertices[corners[v]];
      double most = -1;
      for (const Vector2d& one : along[corners[v]])
        most = std::max(most, one.dot(way.normalized()));
      const int place = cut_.places[t][v];
      if (most >= least[place]) continue;
      least[place] = most;
      from_[place] = map.vertices[corners[v]] + kInside * way;
    }
  }
}

void SidedHorizon::find_depths() {
  depth_.assign(cut_.n_places(), std::numeric_limits<double>::quiet_NaN());
  const LayeredBody& body = ground_.body;
  const double reach = body.top - body.base;
  for (int place = 0; place < static_cast<int>(cut_.n_places()); ++place) {
    const int vertex = cut_.vertex[place];
    depth_[place] = depth(place, [&](const Surface& surface) {
      return meet_pillar(body.base - reach, body.top + reach,
                         [&](double z) { return z - surface(ground_.pillars.in_map(vertex, z)); });
    });
  }
}

double SidedHorizon::depth(int place, const Meet& meet) const {
  const double plain = meet([&](const Vector2d& xy) { return surface_.at(xy); });
  const Vector2d xy = ground_.pillars.in_map(cut_.vertex[place], plain);
  if (points_.is_seen(barriers_, from_[place], xy)) return plain;
  if (const auto fit = points_.fit(barriers_, from_[place]))
    return meet([&](const Vector2d& at) { return fit->at(at); });
  if (std::isnan(depth_[place])) return depth_[place];
  return meet([&](const Vector2d&) { return depth_[place]; });
}

/// Takes out pieces at an end of which the horizon lies above or below the fault's ends.
bool SidedHorizon::join_beyond_ends() {
  const auto is_beyond = [&](const TracePiece& piece) {
    const LayeredFault& fault = ground_.body.faults[piece.fault];
    for (const int triangle : {piece.side->left, piece.side->right})
      for (const int vertex : {piece.side->a, piece.side->b}) {
        const double z = depth_[place_at(ground_.map, cut_, triangle, vertex)];
        if (fault.top && z > *fault.top) return true;
        if (fault.bottom && z < *fault.bottom) return true;
      }
    return false;
  };
  return std::erase_if(pieces_, is_beyond) > 0;
}

std::string SidedHorizon::names_around(const std::vector<int>& parts, int part) const {
  std::string names;
  int last = -1;
  for (const TracePiece& piece : pieces_) {
    if (parts[piece.side->left] != part && parts[piece.side->right] != part) continue;
    if (piece.fault == last) continue;
    names += concat(names.empty() ? "\"" : ", \"", ground_.body.faults[piece.fault].name, "\"");
    last = piece.fault;
  }
  return names;
}

/// Whether there is a point in every part.
bool SidedHorizon::check_parts(std::vector<Problem>& problems) const {
  const MapMesh& map = ground_.map;
  const std::vector<int> parts = parts_of(map, ground_.sides, sides_of_pieces(pieces_));
  std::vector<bool> has_point(parts.size(), false), has_depth(parts.size(), false);
  for (std::size_t k = 0; k < stands_.size(); ++k)
    if (!points_.is_left_out(k)) has_point[parts[stands_[k].triangle]] = true;
  std::vector<double> largest(parts.size(), 0);
  std::vector<Vector2d> middle(parts.size());
  for (std::size_t t = 0; t < parts.size(); ++t) {
    const auto corner = [&](std::size_t v) { return map.vertices[map.triangles[t][v]]; };
    for (const int place : cut_.places[t])
      if (!std::isnan(depth_[place])) has_depth[parts[t]] = true;
    const double area = cross_of(corner(0), corner(1), corner(2));
    if (area <= largest[parts[t]]) continue;
    largest[parts[t]] = area;
    middle[parts[t]] = (corner(0) + corner(1) + corner(2)) / 3;
  }
  bool are_all_known = true;
  for (std::size_t t = 0; t < parts.size(); ++t) {
    if (parts[t] != static_cast<int>(t) || (has_point[t] && has_depth[t])) continue;
    are_all_known = false;
    const std::string names = names_around(parts, static_cast<int>(t));
    const bool is_one = names.find(',') == std::string::npos;
    problems.push_back(
        {concat("/horizons/", horizon_, "/depth"), 0,
         concat("\"", ground_.body.horizons[horizon_].name,
                "\" has no point in the part of the map around ", map_place(middle[t]), ", which ",
                names, is_one ? " without a throw cuts off" : " without throws cut off"),
         "give the horizon points there, or give the throw of one of these faults"});
  }
  return are_all_known;
}

void SidedHorizon::fill_unseen(std::vector<double>& values) const {
  std::vector<bool> is_known;
  for (const double value : values) is_known.push_back(!std::isnan(value));
  if (!contains(is_known, false)) return;
  const auto n = static_cast<Eigen::Index>(values.size());
  Eigen::VectorXd known = Eigen::VectorXd::Zero(n);
  for (Eigen::Index p = 0; p < n; ++p)
    if (is_known[p]) known[p] = values[p];
  const MapOperator op =
      map_operator(ground_.map.vertices, ground_.map.triangles, cut_.places, cut_.n_places());
  const Eigen::VectorXd filled = fill_between(op, Eigen::VectorXd::Zero(n), is_known, known);
  values.assign(filled.begin(), filled.end());
}

std::vector<double> SidedHorizon::beside(const std::vector<double>& values) const {
  std::vector<double> found;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t place = 0; place < cut_.n_places(); ++place) {
    const Vector2d xy = ground_.pillars.in_map(cut_.vertex[place], depth_[place]);
    const double value = points_.is_seen(barriers_, from_[place], xy)
                             ? surface_.support_at(xy).of(values)
                             : points_.fitted(values, barriers_, from_[place], xy)
                                   .value_or(std::numeric_limits<double>::quiet_NaN());
    if (value < least) least = value;
    found.push_back(value);
  }
  fill_unseen(found);
  // Filled by linear elements, whose values may leave the range of those that are known.
  for (double& value : found) value = std::max(value, least);
  return found;
}

}  // namespace faultsim::horizons
