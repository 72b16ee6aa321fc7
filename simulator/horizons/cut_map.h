#pragma once

#include <array>
#include <vector>

#include "simulator/horizons/map_mesh.h"

namespace faultsim::horizons {

/// The map cut along the faults' traces: a vertex has one place per sector of triangles that are
/// connected around it without crossing a trace. A tip has one, a T three, an X four.
struct CutMap {
  std::vector<int> vertex;                 ///< per place.
  std::vector<std::array<int, 3>> places;  ///< per triangle, of its corners.
  std::vector<std::vector<int>> at;        ///< per vertex its places, ascending.

  std::size_t n_places() const { return vertex.size(); }
};

/// The place of a triangle at one of its vertices.
int place_at(const MapMesh& map, const CutMap& cut, int triangle, int vertex);

/// Along all faults.
CutMap cut_map(const MapMesh& map);
/// Along some sides only, ascending.
CutMap cut_map(const MapMesh& map, const std::vector<MapSide>& sides,
               const std::vector<const MapSide*>& along);

/// A piece of a fault's trace between two neighbours along it.
struct TracePiece {
  int fault;
  std::size_t k;  ///< from lines[fault][k] to the next.
  const MapSide* side;
};

/// All pieces of all faults' traces. The sides must outlive them.
std::vector<TracePiece> trace_pieces(const MapMesh& map, const std::vector<MapSide>& sides);

/// Per triangle a number that is the same in triangles which are connected without crossing a wall.
/// @param walls  some of the sides, ascending.
std::vector<int> parts_of(const MapMesh& map, const std::vector<MapSide>& sides,
                          const std::vector<const MapSide*>& walls);

/// The same with all lines as walls: parts that faults and dividers bound.
std::vector<int> parts_between_lines(const MapMesh& map);

/// Per place the triangle that holds it, −1 where none does; in time about proportional to both.
std::vector<int> triangles_around(const MapMesh& map, const std::vector<Eigen::Vector2d>& places);

/// Per triangle the compartment it belongs to, or −1: filled from the points inside of each, up to
/// faults, dividers and the box. Points outside of the map, and those of two compartments in one
/// part of it, are appended to problems.
std::vector<int> fill_compartments(const MapMesh& map, const std::vector<Compartment>& compartments,
                                   std::vector<Problem>& problems);

}  // namespace faultsim::horizons
