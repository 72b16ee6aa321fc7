#include "simulator/grid_scene/surface_points.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <tuple>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/common/text.h"
#include "simulator/corner_point/fault_description.h"
#include "simulator/corner_point/straight_trace.h"
#include "simulator/grid_scene/carried_heights.h"
#include "simulator/grid_scene/fault_columns.h"
#include "simulator/grid_scene/mesh_size.h"
#include "simulator/grid_scene/model_pillars.h"

namespace faultsim::grid_scene {
namespace {

using corner_point::ColumnMap;
using corner_point::CornerPlace;
using corner_point::CornerPointGrid;
using corner_point::RemarkKind;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::array<CornerPlace, 4> kFour = {
    {{false, false, false}, {true, false, false}, {false, true, false}, {true, true, false}}};

/// Columns around a pillar that no fault of the model separates there.
struct Group {
  int pillar = -1;
  std::vector<int> columns;
  std::vector<int> side;       ///< per fault: 1 left, −1 right, 0 neither.
  std::vector<char> is_on_it;  ///< per fault: the pillar is one of its, and the group has a side.
  int fault = -1;              ///< the first of these.
  Vector2d across = {0, 0};    ///< a unit vector across it.
};

/// Cells of a thinner layer would be flat, but a layer that is thin everywhere keeps its rock. What
/// the builder joins at faults, 0.03 of a cell, stays well below it.
double usual_least_layer(double strike, double mean_thickness) {
  return std::max(0.06 * strike, std::min(0.2 * strike, mean_thickness / 2));
}

class SurfaceMaker {
 public:
  SurfaceMaker(const CornerPointGrid& grid, const corner_point::GridStructure& structure,
               const ModelLines& lines, const SurfaceOptions& options, Remarks& remarks)
      : grid_(grid),
        structure_(structure),
        lines_(lines),
        options_(options),
        remarks_(remarks),
        map_(grid),
        least_(options.least_layer > 0
                   ? options.least_layer
                   : usual_least_layer(lines.strike, mean_thickness(structure))),
        pillars_(lines) {
    find_groups();
  }

  std::vector<ModelSurface> make();

 private:
  /// A point of the first surface, and the groups that it is of: one, or both sides of a tip.
  struct Place {
    Vector3d at;
    std::vector<std::size_t> groups;
  };

  void find_groups();
  void add_groups(int pillar, const std::set<int>& barriers,
                  const std::vector<std::vector<int>>& sides);
  Level in_column(int column, int pillar, int layer) const;
  Level in_group(const Group& group, int layer) const;
  Moved in_grid(std::size_t group, int layer) const;
  std::vector<int> chosen_layers();
  bool is_thick_enough(int above, int below) const;
  void place_points();
  ModelSurface first_surface(int layer) const;
  SideProfiles profiles_of(int layer);
  double height_below(const Place& place, int layer);
  ModelSurface hung_surface(int layer, const ModelSurface& above);
  std::optional<Vector2d> place_at(const Group& group, double z) const;
  std::size_t end_of_pillar(std::size_t group) const;
  std::vector<double> heights(
      const std::vector<Moved>& moved,
      const std::function<std::optional<Vector2d>(std::size_t side, double z)>& place);
  std::vector<std::optional<Vector3d>> placed(std::size_t begin, int layer);
  double along(const Group& group, const Vector3d& point) const;
  void add_tips();
  std::array<std::size_t, 2> beside_tip(const ModelFault& fault, const Vector2d& tip) const;
  double thinnest() const;

  const CornerPointGrid& grid_;
  const corner_point::GridStructure& structure_;
  const ModelLines& lines_;
  const SurfaceOptions& options_;
  Remarks& remarks_;
  ColumnMap map_;
  double least_;
  std::vector<Group> groups_;
  ModelPillars pillars_;
  std::vector<Place> places_;
  int n_left_out_ = 0;
  int n_not_carried_ = 0;
};

void SurfaceMaker::find_groups() {
  const std::set<int> barriers = edges_of_faults(map_, structure_, lines_);
  const std::vector<std::vector<int>> sides = sides_of_columns(map_, structure_, lines_);
  for (int pillar = 0; pillar < map_.n_pillars(); ++pillar) add_groups(pillar, barriers, sides);
  for (std::size_t f = 0; f < lines_.faults.size(); ++f) {
    const std::vector<int> own =
        corner_point::pillars_of(structure_.faults[lines_.faults[f].source]);
    const std::set<int> pillars(own.begin(), own.end());
    const Polyline& trace = lines_.faults[f].trace;
    for (Group& group : groups_) {
      const bool is_on_it = group.side[f] != 0 && pillars.contains(group.pillar);
      group.is_on_it.push_back(is_on_it ? 1 : 0);
      if (!is_on_it || group.fault >= 0) continue;
      group.fault = static_cast<int>(f);
      const Vector2d at = grid_.pillars[group.pillar].at(lines_.reference_z);
      const int piece = corner_point::nearest_on_line(trace, at).piece;
      const Vector2d along = (trace[piece + 1] - trace[piece]).normalized();
      group.across = {-along.y(), along.x()};
    }
  }
}

/// One side of all columns, or none.
int common_side(const std::vector<int>& side, const std::vector<int>& columns) {
  const int first = side[columns.front()];
  const bool all = std::ranges::all_of(columns, [&](int c) { return side[c] == first; });
  return all ? first : 0;
}

void SurfaceMaker::add_groups(int pillar, const std::set<int>& barriers,
                              const std::vector<std::vector<int>>& sides) {
  const std::array<int, 4> around = map_.columns_around(pillar);
  std::array<int, 4> set = {0, 1, 2, 3};
  for (int c = 0; c < 4; ++c) {
    const int next = (c + 1) % 4;
    if (!map_.is_inside(around[c]) || !map_.is_inside(around[next])) continue;
    if (barriers.contains(map_.edge_between_columns(around[c], around[next]))) continue;
    std::ranges::replace(set, std::max(set[c], set[next]), std::min(set[c], set[next]));
  }
  for (int s = 0; s < 4; ++s) {
    Group group{.pillar = pillar, .columns = {}, .side = {}, .is_on_it = {}};
    for (int c = 0; c < 4; ++c) {
      if (set[c] == s && map_.is_inside(around[c])) group.columns.push_back(around[c]);
    }
    if (group.columns.empty()) continue;
    for (const std::vector<int>& side : sides)
      group.side.push_back(common_side(side, group.columns));
    groups_.push_back(std::move(group));
  }
}

/// A surface in one column: at the pillar, and the plane next to its four corners.
Level SurfaceMaker::in_column(int column, int pillar, int layer) const {
  const int top = map_.top_layer(column), base = map_.base_layer(column);
  const auto corner_z = [&](CornerPlace corner) {
    const double highest = grid_.z(column, top, corner);
    if (layer < 0) return highest;
    const CornerPlace below{corner.right, corner.back, true};
    const double lowest = grid_.z(column, base, below);
    if (layer >= grid_.size[2]) return lowest;
    return std::max(lowest, std::min(highest, grid_.z(column, layer, corner)));
  };
  Eigen::Matrix<double, 4, 3> matrix;
  Eigen::Vector4d right;
  for (int c = 0; c < 4; ++c) {
    const double z = corner_z(kFour[static_cast<std::size_t>(c)]);
    const Vector2d at =
        grid_.pillars[grid_.pillar_of(column, kFour[static_cast<std::size_t>(c)])].at(z);
    matrix.row(c) << at.x(), at.y(), 1;
    right[c] = z;
  }
  const Eigen::RowVector3d middle = matrix.colwise().mean();
  matrix.leftCols<2>().rowwise() -= middle.head<2>();
  const Eigen::Vector3d plane = matrix.colPivHouseholderQr().solve(right);
  return {corner_z(map_.corner_at(column, pillar)), plane.head<2>()};
}

Level SurfaceMaker::in_group(const Group& group, int layer) const {
  Level mean;
  const auto n = static_cast<double>(group.columns.size());
  for (const int column : group.columns) {
    const Level one = in_column(column, group.pillar, layer);
    mean.z += one.z / n;
    mean.slope += one.slope / n;
  }
  return mean;
}

double SurfaceMaker::thinnest() const {
  double least = 1e300;
  for (const Group& group : groups_)
    least = std::min(least, in_group(group, -1).z - in_group(group, grid_.size[2]).z);
  return least;
}

bool SurfaceMaker::is_thick_enough(int above, int below) const {
  return std::ranges::all_of(groups_, [&](const Group& group) {
    return in_group(group, above).z - in_group(group, below).z >= least_;
  });
}

/// Tops of layers from the reservoir's top (−1) to its base (n_k).
std::vector<int> SurfaceMaker::chosen_layers() {
  const int n = grid_.size[2];
  std::vector<int> chosen = {-1}, thin;
  for (int k = options_.every; options_.every > 0 && k < n; k += options_.every) {
    if (is_thick_enough(chosen.back(), k) && is_thick_enough(k, n)) {
      chosen.push_back(k);
    } else {
      thin.push_back(k + 1);
    }
  }
  if (!thin.empty())
    remarks_.push_back({RemarkKind::left_out,
                        "the tops of layers " + joined(thin, ", ") +
                            formatted(" of the grid: less than %.3g m from another surface of the "
                                      "model somewhere",
                                      least_),
                        "--least-layer"});
  chosen.push_back(n);
  return chosen;
}

/// Where a group's point lies at a height, or none: the model's fault would put it on the wrong
/// side.
std::optional<Vector2d> SurfaceMaker::place_at(const Group& group, double z) const {
  Vector2d at = grid_.pillars[group.pillar].at(z);
  constexpr int kRounds = 4;  // of a pillar on several faults
  for (int round = 0; round < kRounds; ++round) {
    bool is_right = true;
    for (std::size_t f = 0; f < lines_.faults.size(); ++f) {
      if (group.side[f] == 0) continue;
      const Polyline line = pillars_.fault_line(f, z);
      const corner_point::PlaceOnLine on = corner_point::nearest_on_line(line, at);
      const bool is_beyond = on.along == 0 || on.along >= corner_point::line_length(line);
      if (is_beyond) continue;
      const Vector2d along = (line[on.piece + 1] - line[on.piece]).normalized();
      const double to_side =
          group.side[f] * corner_point::cross_product(along, at - line[on.piece]);
      const bool must_move = group.is_on_it[f] != 0 && round == 0;
      if (!must_move && to_side >= 0.999 * options_.beside_fault) continue;
      if (group.is_on_it[f] == 0) return std::nullopt;
      is_right = false;
      at = on.point + group.side[f] * options_.beside_fault * Vector2d(-along.y(), along.x());
    }
    if (is_right) return at;
  }
  return std::nullopt;
}

Moved SurfaceMaker::in_grid(std::size_t group, int layer) const {
  const Level level = in_group(groups_[group], layer);
  return {level, grid_.pillars[groups_[group].pillar].at(level.z), groups_[group].across};
}

/// After the last group of a pillar, from its first one.
std::size_t SurfaceMaker::end_of_pillar(std::size_t group) const {
  std::size_t end = group;
  while (end < groups_.size() && groups_[end].pillar == groups_[group].pillar) ++end;
  return end;
}

/// Where they are moved to; where none are found those before, counted.
std::vector<double> SurfaceMaker::heights(
    const std::vector<Moved>& moved,
    const std::function<std::optional<Vector2d>(std::size_t side, double z)>& place) {
  const CarriedHeights found = carried(moved, place);
  n_not_carried_ += found.is_found ? 0 : 1;
  return found.z;
}

/// Points of a surface of all groups of a pillar, from its first one, or none.
std::vector<std::optional<Vector3d>> SurfaceMaker::placed(std::size_t begin, int layer) {
  std::vector<Moved> moved;
  for (std::size_t g = begin; g < end_of_pillar(begin); ++g) moved.push_back(in_grid(g, layer));
  const std::vector<double> z = heights(
      moved, [&](std::size_t k, double height) { return place_at(groups_[begin + k], height); });
  std::vector<std::optional<Vector3d>> points;
  for (std::size_t k = 0; k < z.size(); ++k) {
    const std::optional<Vector2d> at = place_at(groups_[begin + k], z[k]);
    points.push_back(at ? std::optional(Vector3d(at->x(), at->y(), z[k])) : std::nullopt);
  }
  return points;
}

/// How far along the trace of its fault the model's pillar through a point of a group stands, m.
double SurfaceMaker::along(const Group& group, const Vector3d& point) const {
  return corner_point::nearest_on_line(lines_.faults[static_cast<std::size_t>(group.fault)].trace,
                                       pillars_.at(point, lines_.reference_z))
      .along;
}

/// Of the points on either side of a fault those nearest to its tip.
std::array<std::size_t, 2> SurfaceMaker::beside_tip(const ModelFault& fault,
                                                    const Vector2d& tip) const {
  std::array<double, 2> nearest = {1e300, 1e300};
  std::array<std::size_t, 2> found = {0, 0};
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const Vector2d at = places_[k].at.head<2>();
    const auto on = corner_point::nearest_on_line(fault.trace, at);
    const Vector2d along = fault.trace[on.piece + 1] - fault.trace[on.piece];
    const std::size_t side =
        corner_point::cross_product(along, at - fault.trace[on.piece]) > 0 ? 0 : 1;
    const double away = (at - tip).norm();
    if (away >= nearest[side]) continue;
    nearest[side] = away;
    found[side] = k;
  }
  return found;
}

/// Beyond the active map a fault ends in the rock: there both sides have one depth.
void SurfaceMaker::add_tips() {
  std::vector<Place> tips;
  for (const ModelFault& fault : lines_.faults) {
    const corner_point::Fault& source = structure_.faults[fault.source];
    for (const bool is_last : {false, true}) {
      const auto& end = is_last ? source.end : source.begin;
      if (end.kind != corner_point::EndKind::grid_edge) continue;
      const Vector2d tip = is_last ? fault.trace.back() : fault.trace.front();
      const auto [left, right] = beside_tip(fault, tip);
      const double mean = (places_[left].at.z() + places_[right].at.z()) / 2;
      const Polyline line = fault.at(mean, lines_.reference_z);
      const Vector2d at = is_last ? line.back() : line.front();
      tips.push_back(
          {{at.x(), at.y(), mean}, {places_[left].groups.front(), places_[right].groups.front()}});
    }
  }
  places_.insert(places_.end(), tips.begin(), tips.end());
}

/// Points of the reservoir's top; surfaces below hang from them.
void SurfaceMaker::place_points() {
  std::set<std::tuple<std::size_t, int, long>> taken;  // fault, side, place along it
  std::vector<std::optional<Vector3d>> points;
  while (points.size() < groups_.size()) {
    const auto of_pillar = placed(points.size(), -1);
    points.insert(points.end(), of_pillar.begin(), of_pillar.end());
  }
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const Group& group = groups_[g];
    const std::optional<Vector3d>& point = points[g];
    if (!point) {
      n_left_out_ += 1;
      continue;
    }
    bool is_there = false;
    for (std::size_t f = 0; f < lines_.faults.size(); ++f) {
      if (group.is_on_it[f] == 0) continue;
      const double along =
          corner_point::nearest_on_line(lines_.faults[f].trace, point->head<2>()).along;
      constexpr double kSame = 5;  // m
      is_there |= !taken.emplace(f, group.side[f], std::lround(along / kSame)).second;
    }
    if (!is_there) places_.push_back({*point, {g}});
  }
  add_tips();
}

ModelSurface SurfaceMaker::first_surface(int layer) const {
  return {.name = "", .layer = layer, .points = mapped(places_, &Place::at), .thickness = {}};
}

/// A surface along both sides of the faults, of the pillars that the first surface has points of.
SideProfiles SurfaceMaker::profiles_of(int layer) {
  std::set<std::size_t> used;
  for (const Place& place : places_)
    if (place.groups.size() == 1) used.insert(place.groups.front());
  SideProfiles profiles;
  for (std::size_t begin = 0; begin < groups_.size(); begin = end_of_pillar(begin)) {
    if (std::ranges::all_of(groups_.begin() + static_cast<std::ptrdiff_t>(begin),
                            groups_.begin() + static_cast<std::ptrdiff_t>(end_of_pillar(begin)),
                            [](const Group& group) { return group.fault < 0; }))
      continue;
    const auto points = placed(begin, layer);
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Group& group = groups_[begin + k];
      if (group.fault < 0 || !points[k] || !used.contains(begin + k)) continue;
      profiles.add(group.fault, group.side[static_cast<std::size_t>(group.fault)],
                   along(group, *points[k]), points[k]->z());
    }
  }
  return profiles;
}

/// Where the model's pillar through a place meets the plane of its own columns.
double SurfaceMaker::height_below(const Place& place, int layer) {
  double mean = 0;
  for (const std::size_t g : place.groups) {
    Moved own = in_grid(g, layer);
    own.across = {0, 0};
    const std::vector<double> z =
        heights({own}, [&](std::size_t, double height) { return pillars_.at(place.at, height); });
    mean += z.front() / static_cast<double>(place.groups.size());
  }
  return mean;
}

/// A surface as much below another as it is in the grid, on pillars of the model: beside a fault at
/// the same place along it, as pillars of the grid lean along faults too, if any of that side has a
/// place at this depth.
ModelSurface SurfaceMaker::hung_surface(int layer, const ModelSurface& above) {
  const SideProfiles profiles = profiles_of(layer);
  ModelSurface surface{.name = "", .layer = layer, .points = {}, .thickness = {}};
  for (std::size_t p = 0; p < places_.size(); ++p) {
    const Group& group = groups_[places_[p].groups.front()];
    std::optional<double> height;
    if (group.fault >= 0 && places_[p].groups.size() == 1)
      height = profiles.at(group.fault, group.side[static_cast<std::size_t>(group.fault)],
                           along(group, places_[p].at));
    const double grids = height ? *height : height_below(places_[p], layer);
    surface.thickness.push_back(std::max(least_, above.points[p].z() - grids));
    const double z = above.points[p].z() - surface.thickness.back();
    const Vector2d at = pillars_.at(places_[p].at, z);
    surface.points.emplace_back(at.x(), at.y(), z);
  }
  return surface;
}

std::vector<ModelSurface> SurfaceMaker::make() {
  const double thin = thinnest();
  if (thin < least_)
    remarks_.push_back(
        {RemarkKind::warning,
         formatted("the reservoir is %.3g m thick at its thinnest: its base lies deeper in the "
                   "model wherever less than %.3g m would be left, and pressures of the grid are "
                   "spread over that",
                   std::max(0.0, thin), least_),
         "--least-layer"});
  std::vector<ModelSurface> surfaces;
  const std::vector<int> layers = chosen_layers();
  place_points();
  for (std::size_t s = 0; s < layers.size(); ++s) {
    ModelSurface surface =
        s == 0 ? first_surface(layers[s]) : hung_surface(layers[s], surfaces.back());
    const bool is_one = layers.size() == 2;
    surface.name = s + 1 == layers.size() ? "underburden"
                   : is_one               ? "reservoir"
                                          : concat("reservoir", s + 1);
    surfaces.push_back(std::move(surface));
  }
  if (n_left_out_ > 0)
    remarks_.push_back({RemarkKind::left_out,
                        counted(n_left_out_, "pillar", "pillars") +
                            " that straightened faults would put on the wrong side",
                        "--straightening"});
  if (n_not_carried_ > 0)
    remarks_.push_back(
        {RemarkKind::warning,
         concat("surfaces keep their heights in the grid at ",
                counted(n_not_carried_, "pillar", "pillars"),
                " that straightened faults move by leaps: their slope is not taken into account"),
         "--straightening"});
  return surfaces;
}

}  // namespace

std::vector<ModelSurface> model_surfaces(const CornerPointGrid& grid,
                                         const corner_point::GridStructure& structure,
                                         const ModelLines& lines, const SurfaceOptions& options,
                                         Remarks& remarks) {
  return SurfaceMaker(grid, structure, lines, options, remarks).make();
}

}  // namespace faultsim::grid_scene
