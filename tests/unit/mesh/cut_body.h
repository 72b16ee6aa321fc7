#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "simulator/mesh/uncut_mesh.h"
#include "tests/unit/mesh/simplices.h"

/// Cubes of tetrahedra whose faults are parts of planes, before they are cut.
namespace faultsim::test {

/// A part of the plane normal · x = distance of a cube of unit cells; what is beyond, where the
/// normal points to, is its plus side.
struct PlanePart {
  std::string name;
  Eigen::Vector3d normal;
  double distance;
  std::function<bool(const Eigen::Vector3d&)> is_inside = [](const Eigen::Vector3d&) {
    return true;
  };
};

/// Boundary groups are the sides of the cube, in the order of Side.
inline UncutMesh body_of(const Simplices& cube, int n, const std::vector<PlanePart>& faults) {
  UncutMesh body;
  body.nodes = cube.nodes;
  for (std::vector<int> cell : cube.cells) {
    const auto edge = [&](int k) -> Eigen::Vector3d {
      return cube.nodes[cell[static_cast<std::size_t>(k)]] - cube.nodes[cell[0]];
    };
    if (edge(1).cross(edge(2)).dot(edge(3)) < 0) std::swap(cell[2], cell[3]);
    body.corners.insert(body.corners.end(), cell.begin(), cell.end());
  }
  body.material.assign(cube.cells.size(), 0);
  body.region.assign(cube.cells.size(), -1);
  body.region_fraction.assign(cube.cells.size(), 0);
  for (const PlanePart& fault : faults) {
    FacetGroup group{fault.name, {}};
    for (const SharedFace& face : cube.faces) {
      const auto beyond = [&](int cell) {
        return cube.centre_of_cell(cell).dot(fault.normal) > fault.distance;
      };
      if (beyond(face.cells[0]) != beyond(face.cells[1]) &&
          fault.is_inside(cube.centre(face.nodes)))
        group.facets.push_back(face.nodes);
    }
    body.faults.push_back(group);
  }
  for (const char* side : {"x-", "x+", "y-", "y+", "z-", "z+"}) body.boundary.push_back({side, {}});
  for (std::size_t cell = 0; cell < cube.cells.size(); ++cell)
    for (std::size_t left_out = 0; left_out < 4; ++left_out) {
      std::array<int, 4> facet = {-1, -1, -1, -1};
      for (std::size_t v = 0, k = 0; v < 4; ++v)
        if (v != left_out) facet[k++] = cube.cells[cell][v];
      for (int side = 0; side < 6; ++side) {
        const double at = side % 2 == 0 ? 0 : n;
        const auto lies = [&](int node) { return cube.nodes[node][side / 2] == at; };
        if (lies(facet[0]) && lies(facet[1]) && lies(facet[2]))
          body.boundary[static_cast<std::size_t>(side)].facets.push_back(facet);
      }
    }
  return body;
}

/// Moves the inner nodes that are on no fault by up to this part of a cell.
inline void distort(UncutMesh& body, int n, double by) {
  std::vector<bool> keep(body.nodes.size(), false);
  for (const FacetGroup& fault : body.faults)
    for (const std::array<int, 4>& facet : fault.facets)
      for (const int node : facet)
        if (node >= 0) keep[node] = true;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> move(-by, by);
  for (std::size_t k = 0; k < body.nodes.size(); ++k) {
    Eigen::Vector3d& x = body.nodes[k];
    const Eigen::Vector3d moved(move(random), move(random), move(random));
    if (!keep[k] && x.minCoeff() > 0 && x.maxCoeff() < n) x += moved;
  }
}

}  // namespace faultsim::test
