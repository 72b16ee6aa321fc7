#include "simulator/horizons/map_operator.h"

#include <Eigen/SparseCholesky>

#include "simulator/common/disjoint_sets.h"
#include "simulator/common/errors.h"

namespace faultsim::horizons {

using Eigen::Vector2d;
using Eigen::VectorXd;

MapOperator map_operator(const std::vector<Vector2d>& vertices, const Triangles& triangles,
                         const std::vector<std::array<int, 3>>& numbers, std::size_t n) {
  MapOperator op;
  op.area = VectorXd::Zero(static_cast<Eigen::Index>(n));
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(9 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const std::array<int, 3>& corners = triangles[t];
    const double twice = cross_of(vertices[corners[0]], vertices[corners[1]], vertices[corners[2]]);
    for (std::size_t v = 0; v < 3; ++v) {
      op.area[numbers[t][v]] += twice / 6;
      // ∇φ_i · ∇φ_j = e_i · e_j / (2A)², with e_i the side opposite to corner i.
      const auto opposite = [&](std::size_t i) -> Vector2d {
        return vertices[corners[(i + 2) % 3]] - vertices[corners[(i + 1) % 3]];
      };
      for (std::size_t w = 0; w < 3; ++w)
        entries.emplace_back(numbers[t][v], numbers[t][w],
                             opposite(v).dot(opposite(w)) / (2 * twice));
    }
  }
  op.stiffness.resize(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  op.stiffness.setFromTriplets(entries.begin(), entries.end());
  return op;
}

namespace {

/// Fixed ones, and all of parts of the map that nothing holds: these keep their values.
std::vector<bool> with_loose_parts(const MapOperator& op, const VectorXd& extra,
                                   const std::vector<bool>& fixed) {
  DisjointSets parts(fixed.size());
  for (Eigen::Index j = 0; j < op.stiffness.outerSize(); ++j)
    for (Eigen::SparseMatrix<double>::InnerIterator at(op.stiffness, j); at; ++at)
      parts.join(static_cast<int>(at.row()), static_cast<int>(j));
  std::vector<bool> is_held(fixed.size(), false), all(fixed.size());
  for (std::size_t k = 0; k < fixed.size(); ++k)
    if (fixed[k] || extra[static_cast<Eigen::Index>(k)] > 0)
      is_held[parts.find(static_cast<int>(k))] = true;
  for (std::size_t k = 0; k < fixed.size(); ++k)
    all[k] = fixed[k] || !is_held[parts.find(static_cast<int>(k))];
  return all;
}

}  // namespace

VectorXd fill_between(const MapOperator& op, const VectorXd& extra,
                      const std::vector<bool>& fixed_by_caller, const VectorXd& values) {
  const Eigen::Index n = op.area.size();
  const std::vector<bool> fixed = with_loose_parts(op, extra, fixed_by_caller);
  std::vector<int> number(fixed.size(), -1);
  int n_free = 0;
  for (std::size_t k = 0; k < fixed.size(); ++k)
    if (!fixed[k]) number[k] = n_free++;
  VectorXd u = values;
  if (n_free == 0) return u;
  std::vector<Eigen::Triplet<double>> entries;
  VectorXd right = VectorXd::Zero(n_free);
  for (Eigen::Index j = 0; j < n; ++j) {
    if (number[j] >= 0) entries.emplace_back(number[j], number[j], extra[j]);
    for (Eigen::SparseMatrix<double>::InnerIterator at(op.stiffness, j); at; ++at) {
      if (number[at.row()] < 0) continue;
      if (number[j] >= 0) {
        entries.emplace_back(number[at.row()], number[j], at.value());
      } else {
        right[number[at.row()]] -= at.value() * values[j];
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(n_free, n_free);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
  FAULTSIM_DEMAND(factor.info() == Eigen::Success, "a map of ", n, " places");
  const VectorXd between = factor.solve(right);
  for (Eigen::Index k = 0; k < n; ++k)
    if (number[k] >= 0) u[k] = between[number[k]];
  return u;
}

VectorXd solve_potential(const MapOperator& op, const VectorXd& right) {
  Eigen::SparseMatrix<double> held = op.stiffness;
  held.coeffRef(0, 0) += op.stiffness.coeff(0, 0);
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(held);
  FAULTSIM_DEMAND(factor.info() == Eigen::Success, "a potential of ", right.size(), " places");
  return factor.solve(right);
}

}  // namespace faultsim::horizons
