#pragma once

#include <Eigen/SparseCore>

#include "simulator/horizons/delaunay.h"

namespace faultsim::horizons {

/// Integrals of linear hats over triangles of the plane.
struct MapOperator {
  Eigen::SparseMatrix<double> stiffness;  ///< ∫ ∇φ_i · ∇φ_j; n x n.
  Eigen::VectorXd area;                   ///< ∫ φ_i, m2.
};

/// @param numbers  per triangle, the unknowns of its corners: vertices, or places of a cut map.
MapOperator map_operator(const std::vector<Eigen::Vector2d>& vertices, const Triangles& triangles,
                         const std::vector<std::array<int, 3>>& numbers, std::size_t n);

/// The u with (K + diag(extra)) u = 0 at the unknowns that are not fixed. A part of the map where
/// none is, and no `extra` above 0, keeps its values.
/// @param fixed  per unknown, whether `values` says what it is.
Eigen::VectorXd fill_between(const MapOperator& op, const Eigen::VectorXd& extra,
                             const std::vector<bool>& fixed, const Eigen::VectorXd& values);

/// A u with K u = right, 0 at the first unknown. @pre the sum of right is 0.
Eigen::VectorXd solve_potential(const MapOperator& op, const Eigen::VectorXd& right);

}  // namespace faultsim::horizons
