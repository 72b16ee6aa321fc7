#include "simulator/horizons/cut_map.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/disjoint_sets.h"
#include "simulator/common/ranges.h"

namespace faultsim::horizons {
namespace {

/// The sides that lie on the first n lines.
std::vector<const MapSide*> sides_on_lines(const MapMesh& map, const std::vector<MapSide>& sides,
                                           std::size_t n) {
  std::vector<const MapSide*> on;
  for (std::size_t line = 0; line < n; ++line)
    for (std::size_t k = 0; k + 1 < map.lines[line].size(); ++k)
      on.push_back(find_side(sides, map.lines[line][k], map.lines[line][k + 1]));
  std::ranges::sort(on);
  return on;
}

std::size_t corner_at(const std::array<int, 3>& triangle, int vertex) {
  return static_cast<std::size_t>(std::ranges::find(triangle, vertex) - triangle.begin());
}

bool holds(const MapMesh& map, const std::array<int, 3>& t, const Eigen::Vector2d& place) {
  for (std::size_t v = 0; v < 3; ++v)
    if (cross_of(map.vertices[t[v]], map.vertices[t[(v + 1) % 3]], place) < 0) return false;
  return true;
}

/// Places of the map in square bins, about one in each.
class BinnedPlaces {
 public:
  explicit BinnedPlaces(const std::vector<Eigen::Vector2d>& places) {
    for (const Eigen::Vector2d& place : places) {
      low_ = low_.cwiseMin(place);
      high_ = high_.cwiseMax(place);
    }
    constexpr double kLeast = 1e-3;  // m
    const Eigen::Vector2d size = (high_ - low_).cwiseMax(kLeast);
    const double n = static_cast<double>(places.size());
    width_ = std::max(std::sqrt(size.prod() / n), size.maxCoeff() / n);
    n_x_ = bin(size.x()) + 1;
    bins_.resize(n_x_ * (bin(size.y()) + 1));
    for (std::size_t p = 0; p < places.size(); ++p) {
      const Eigen::Vector2d at = places[p] - low_;
      bins_[bin(at.x()) + n_x_ * bin(at.y())].push_back(p);
    }
  }

  /// Calls do_it(place) for all within a box, and some beside it.
  void each_near(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const auto& do_it) const {
    if ((to - low_).minCoeff() < 0 || (high_ - from).minCoeff() < 0) return;
    const Eigen::Vector2d first = from.cwiseMax(low_) - low_, last = to.cwiseMin(high_) - low_;
    for (std::size_t y = bin(first.y()); y <= bin(last.y()); ++y)
      for (std::size_t x = bin(first.x()); x <= bin(last.x()); ++x)
        std::ranges::for_each(bins_[x + n_x_ * y], do_it);
  }

 private:
  std::size_t bin(double way) const { return static_cast<std::size_t>(way / width_); }

  Eigen::Vector2d low_ = Eigen::Vector2d::Constant(1e300), high_ = -low_;
  double width_ = 1;
  std::size_t n_x_ = 1;
  std::vector<std::vector<std::size_t>> bins_;
};

Problem not_apart(const std::string& pointer, const Compartment& one, const Eigen::Vector2d& at,
                  const Compartment& other, const Eigen::Vector2d& at_other) {
  return {pointer, 0,
          concat("\"", one.name, "\" and \"", other.name,
                 "\" are in one part of the map: nothing separates ", map_place(at), " from ",
                 map_place(at_other)),
          "draw a divider from the end of a fault, or make them one"};
}

/// A point inside of a compartment, and where it is given.
struct PointInside {
  std::size_t compartment;
  Eigen::Vector2d at;
  std::string pointer;
};

std::vector<PointInside> points_inside(const std::vector<Compartment>& compartments) {
  std::vector<PointInside> points;
  for (std::size_t c = 0; c < compartments.size(); ++c) {
    const std::string pointer = concat("/compartments/", c);
    points.push_back({c, compartments[c].inside, pointer + "/inside"});
    for (std::size_t k = 0; k < compartments[c].also_inside.size(); ++k)
      points.push_back({c, compartments[c].also_inside[k], concat(pointer, "/also_inside/", k)});
  }
  return points;
}

}  // namespace

int place_at(const MapMesh& map, const CutMap& cut, int triangle, int vertex) {
  return cut.places[triangle][corner_at(map.triangles[triangle], vertex)];
}

CutMap cut_map(const MapMesh& map) {
  const std::vector<MapSide> sides = sides_of(map.triangles);
  return cut_map(map, sides, sides_on_lines(map, sides, static_cast<std::size_t>(map.n_faults)));
}

CutMap cut_map(const MapMesh& map, const std::vector<MapSide>& sides,
               const std::vector<const MapSide*>& along) {
  // Corners of triangles are one place where triangles share a side that is no trace.
  DisjointSets corners(3 * map.triangles.size());
  const auto corner = [&](int triangle, int vertex) {
    return 3 * triangle + static_cast<int>(corner_at(map.triangles[triangle], vertex));
  };
  for (const MapSide& side : sides) {
    if (side.left < 0 || side.right < 0 || std::ranges::binary_search(along, &side)) continue;
    for (const int v : {side.a, side.b}) corners.join(corner(side.left, v), corner(side.right, v));
  }
  CutMap cut;
  cut.at.resize(map.vertices.size());
  std::vector<int> place(3 * map.triangles.size(), -1);
  for (std::size_t t = 0; t < map.triangles.size(); ++t) {
    std::array<int, 3>& places = cut.places.emplace_back();
    for (std::size_t v = 0; v < 3; ++v) {
      int& one = place[corners.find(static_cast<int>(3 * t + v))];
      if (one < 0) {
        one = static_cast<int>(cut.vertex.size());
        cut.vertex.push_back(map.triangles[t][v]);
        cut.at[map.triangles[t][v]].push_back(one);
      }
      places[v] = one;
    }
  }
  return cut;
}

std::vector<TracePiece> trace_pieces(const MapMesh& map, const std::vector<MapSide>& sides) {
  std::vector<TracePiece> pieces;
  for (int f = 0; f < map.n_faults; ++f)
    for (std::size_t k = 0; k + 1 < map.lines[f].size(); ++k)
      pieces.push_back({f, k, find_side(sides, map.lines[f][k], map.lines[f][k + 1])});
  return pieces;
}

std::vector<int> parts_of(const MapMesh& map, const std::vector<MapSide>& sides,
                          const std::vector<const MapSide*>& walls) {
  DisjointSets sets(map.triangles.size());
  for (const MapSide& side : sides)
    if (side.left >= 0 && side.right >= 0 && !std::ranges::binary_search(walls, &side))
      sets.join(side.left, side.right);
  std::vector<int> parts;
  for (std::size_t t = 0; t < map.triangles.size(); ++t)
    parts.push_back(sets.find(static_cast<int>(t)));
  return parts;
}

std::vector<int> parts_between_lines(const MapMesh& map) {
  const std::vector<MapSide> sides = sides_of(map.triangles);
  return parts_of(map, sides, sides_on_lines(map, sides, map.lines.size()));
}

std::vector<int> triangles_around(const MapMesh& map, const std::vector<Eigen::Vector2d>& places) {
  std::vector<int> around(places.size(), -1);
  if (places.empty()) return around;
  const BinnedPlaces binned(places);
  for (std::size_t t = 0; t < map.triangles.size(); ++t) {
    const auto& [a, b, c] = map.triangles[t];
    const Eigen::Vector2d &at_a = map.vertices[a], &at_b = map.vertices[b], &at_c = map.vertices[c];
    binned.each_near(at_a.cwiseMin(at_b).cwiseMin(at_c), at_a.cwiseMax(at_b).cwiseMax(at_c),
                     [&](std::size_t p) {
                       if (around[p] < 0 && holds(map, map.triangles[t], places[p]))
                         around[p] = static_cast<int>(t);
                     });
  }
  return around;
}

std::vector<int> fill_compartments(const MapMesh& map, const std::vector<Compartment>& compartments,
                                   std::vector<Problem>& problems) {
  const std::vector<int> parts = parts_between_lines(map);
  const std::vector<PointInside> points = points_inside(compartments);
  const std::vector<int> around = triangles_around(map, mapped(points, &PointInside::at));
  std::vector<int> owner(map.triangles.size(), -1);  // per part, into points
  for (std::size_t p = 0; p < points.size(); ++p) {
    const PointInside& point = points[p];
    const Compartment& one = compartments[point.compartment];
    if (around[p] < 0) {
      problems.push_back(
          {point.pointer, 0,
           concat("the point of \"", one.name, "\" lies outside the box, at ", map_place(point.at)),
           "give a point of the compartment"});
      continue;
    }
    int& part = owner[parts[around[p]]];
    if (part >= 0 && points[part].compartment != point.compartment) {
      const PointInside& other = points[part];
      problems.push_back(
          not_apart(point.pointer, one, point.at, compartments[other.compartment], other.at));
    }
    part = static_cast<int>(p);
  }
  std::vector<int> filled;
  for (const int part : parts)
    filled.push_back(owner[part] < 0 ? -1 : static_cast<int>(points[owner[part]].compartment));
  return filled;
}

}  // namespace faultsim::horizons
