#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/mesh/mesh.h"
#include "simulator/mesh/mesh_spec.h"

/// What must hold for every mesh, and sums to compare.
namespace faultsim::testing_mesh {

using List = std::vector<std::string>;

inline const Eigen::Vector3d& node(const Mesh& mesh, int n) {
  return mesh.nodes[static_cast<size_t>(n)];
}

/// Volume of a hexahedron by 2x2x2 Gauss points (exact: the Jacobian is quadratic per variable).
inline double cell_volume(const Mesh& mesh, size_t cell) {
  const double g = 1 / std::sqrt(3.0);
  const double s[8] = {-1, 1, 1, -1, -1, 1, 1, -1}, t[8] = {-1, -1, 1, 1, -1, -1, 1, 1},
               r[8] = {-1, -1, -1, -1, 1, 1, 1, 1};
  double volume = 0;
  for (int q = 0; q < 8; ++q) {
    Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
    for (size_t k = 0; k < 8; ++k) {
      const double a = s[k] * g * s[q], b = t[k] * g * t[q], c = r[k] * g * r[q];
      const Eigen::Vector3d gradient(s[k] * (1 + b) * (1 + c) / 8, t[k] * (1 + a) * (1 + c) / 8,
                                     r[k] * (1 + a) * (1 + b) / 8);
      jacobian += node(mesh, mesh.cells[cell][k]) * gradient.transpose();
    }
    volume += jacobian.determinant();
  }
  return volume;
}

inline double total_volume(const Mesh& mesh) {
  double volume = 0;
  for (size_t cell = 0; cell < mesh.cells.size(); ++cell) volume += cell_volume(mesh, cell);
  return volume;
}

inline double region_volume(const Mesh& mesh, int region) {
  double volume = 0;
  for (size_t cell = 0; cell < mesh.cells.size(); ++cell)
    if (mesh.region[cell] == region) volume += mesh.region_fraction[cell] * cell_volume(mesh, cell);
  return volume;
}

inline Eigen::Vector3d cell_centre(const Mesh& mesh, int cell) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const int n : mesh.cells[static_cast<size_t>(cell)]) centre += 0.125 * node(mesh, n);
  return centre;
}

inline double node_area(const FaultSurface& fault) {
  double area = 0;
  for (const FaultNode& one : fault.nodes) area += one.area;
  return area;
}

inline double face_area(const FaultSurface& fault) {
  double area = 0;
  for (const FaultFace& face : fault.faces) area += face.area;
  return area;
}

inline size_t count_split(const Mesh& mesh) {
  size_t n = 0;
  for (const FaultSurface& fault : mesh.faults) n += fault.nodes.size();
  return n;
}

inline bool has_node(const Mesh& mesh, int cell, int wanted) {
  const auto& nodes = mesh.cells[static_cast<size_t>(cell)];
  return std::any_of(nodes.begin(), nodes.end(), [&](int n) {
    return n == wanted || mesh.tied_to[static_cast<size_t>(n)] == wanted;
  });
}

inline void check_fault(const Mesh& mesh, const FaultSurface& fault) {
  ASSERT_FALSE(fault.nodes.empty());
  ASSERT_EQ(fault.node_of_point.size(), fault.points.size());
  for (const FaultNode& one : fault.nodes) {
    EXPECT_EQ(node(mesh, one.minus_node), node(mesh, one.plus_node));
    EXPECT_NE(one.minus_node, one.plus_node);
    EXPECT_EQ(mesh.tied_to[static_cast<size_t>(one.minus_node)], one.minus_node);
    EXPECT_EQ(mesh.tied_to[static_cast<size_t>(one.plus_node)], one.plus_node);
    EXPECT_NEAR(one.normal.norm(), 1, 1e-14);
    EXPECT_NEAR(one.strike.z(), 0, 1e-14);
    EXPECT_LE(one.dip.z(), 1e-14);
    EXPECT_LT((one.normal.cross(one.strike) - one.dip).norm(), 1e-14);
    EXPECT_NEAR(one.normal.dot(one.strike), 0, 1e-14);
    EXPECT_GT(one.area, 0);
  }
  std::vector<char> used(fault.points.size(), 0);
  for (const FaultFace& face : fault.faces) {
    EXPECT_GT(face.area, 0);
    const Eigen::Vector3d normal = fault.nodes[0].normal;
    const Eigen::Vector3d place = fault.points[static_cast<size_t>(face.points[0])];
    EXPECT_LT((cell_centre(mesh, face.minus_cell) - place).dot(normal), 0);
    EXPECT_GT((cell_centre(mesh, face.plus_cell) - place).dot(normal), 0);
    for (size_t v = 0; v < 4; ++v) {
      const size_t point = static_cast<size_t>(face.points[v]);
      used[point] = 1;
      EXPECT_EQ(face.nodes[v], fault.node_of_point[point]);
      EXPECT_NEAR((fault.points[point] - place).dot(normal), 0, 1e-9 * (1 + place.norm()));
      if (face.nodes[v] < 0) continue;
      const FaultNode& one = fault.nodes[static_cast<size_t>(face.nodes[v])];
      EXPECT_TRUE(has_node(mesh, face.minus_cell, one.minus_node));
      EXPECT_TRUE(has_node(mesh, face.plus_cell, one.plus_node));
      EXPECT_FALSE(has_node(mesh, face.minus_cell, one.plus_node));
      EXPECT_FALSE(has_node(mesh, face.plus_cell, one.minus_node));
    }
  }
  EXPECT_EQ(used, std::vector<char>(used.size(), 1));
}

inline void check_mesh(const Mesh& mesh) {
  ASSERT_EQ(mesh.material.size(), mesh.cells.size());
  ASSERT_EQ(mesh.region.size(), mesh.cells.size());
  ASSERT_EQ(mesh.region_fraction.size(), mesh.cells.size());
  ASSERT_EQ(mesh.tied_to.size(), mesh.nodes.size());
  EXPECT_EQ(check_quality(mesh).refusal, "");
  for (const int root : mesh.tied_to) EXPECT_EQ(mesh.tied_to[static_cast<size_t>(root)], root);
  for (size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    EXPECT_EQ(mesh.region[cell] < 0, mesh.region_fraction[cell] == 0);
    EXPECT_LE(mesh.region_fraction[cell], 1);
  }
  std::vector<char> used(mesh.nodes.size(), 0);
  for (size_t cell = 0; cell < mesh.cells.size(); ++cell)
    for (const int n : mesh.cells[cell]) used[static_cast<size_t>(n)] = 1;
  EXPECT_EQ(std::count(used.begin(), used.end(), 0), 0) << "nodes without a cell";
  for (const FaultSurface& fault : mesh.faults) check_fault(mesh, fault);
}

/// Σ over boundary faces of ∫ x·n dA / 3 is the volume: faces closed and seen from outside.
inline double volume_by_boundary(const Mesh& mesh) {
  double volume = 0;
  for (const BoundaryFace& face : mesh.boundary) {
    const Eigen::Vector3d &a = node(mesh, face.places[0]), &b = node(mesh, face.places[1]),
                          &c = node(mesh, face.places[2]), &d = node(mesh, face.places[3]);
    volume += (a.dot(b.cross(c)) + a.dot(c.cross(d))) / 6;
  }
  return volume;
}

/// Pointers of the problems that make_mesh reports; empty = none.
template <typename Spec>
std::vector<std::string> problem_pointers(const Spec& spec) {
  std::vector<std::string> pointers;
  try {
    make_mesh(spec);
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems()) {
      pointers.push_back(problem.pointer);
      EXPECT_FALSE(problem.what.empty());
      EXPECT_FALSE(problem.cure.empty());
    }
  }
  return pointers;
}

}  // namespace faultsim::testing_mesh
