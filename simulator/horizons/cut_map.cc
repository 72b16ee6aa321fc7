#include "simulator/horizons/cut_map.h"

#include <algorithm>

#include "simulator/common/disjoint_sets.h"

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

/// The triangle that holds a place, or −1.
int triangle_around(const MapMesh& map, const Eigen::Vector2d& place) {
  const auto holds = [&](const std::array<int, 3>& t) {
    for (std::size_t v = 0; v < 3; ++v)
      if (cross_of(map.vertices[t[v]], map.vertices[t[(v + 1) % 3]], place) < 0) return false;
    return true;
  };
  const auto found = std::ranges::find_if(map.triangles, holds);
  return found == map.triangles.end() ? -1 : static_cast<int>(found - map.triangles.begin());
}

Problem not_apart(const std::string& pointer, const Compartment& one, const Compartment& other) {
  return {pointer, 0,
          concat("\"", one.name, "\" and \"", other.name,
                 "\" are in one part of the map: nothing separates ", map_place(one.inside),
                 " from ", map_place(other.inside)),
          "draw a divider from the end of a fault, or make them one"};
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

std::vector<int> fill_compartments(const MapMesh& map, const std::vector<Compartment>& compartments,
                                   std::vector<Problem>& problems) {
  const std::vector<MapSide> sides = sides_of(map.triangles);
  const std::vector<int> parts = parts_of(map, sides, sides_on_lines(map, sides, map.lines.size()));
  std::vector<int> owner(map.triangles.size(), -1);
  for (std::size_t c = 0; c < compartments.size(); ++c) {
    const Compartment& one = compartments[c];
    const std::string pointer = concat("/compartments/", c, "/inside");
    const int triangle = triangle_around(map, one.inside);
    if (triangle < 0) {
      problems.push_back({pointer, 0,
                          concat("the point of \"", one.name, "\" lies outside the box, at ",
                                 map_place(one.inside)),
                          "give a point of the compartment"});
      continue;
    }
    int& part = owner[parts[triangle]];
    if (part >= 0) problems.push_back(not_apart(pointer, one, compartments[part]));
    part = static_cast<int>(c);
  }
  std::vector<int> filled(map.triangles.size());
  for (std::size_t t = 0; t < filled.size(); ++t) filled[t] = owner[parts[t]];
  return filled;
}

}  // namespace faultsim::horizons
