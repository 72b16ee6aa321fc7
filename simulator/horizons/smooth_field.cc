#include "simulator/horizons/smooth_field.h"

#include <Eigen/Dense>
#include <utility>

#include "simulator/common/errors.h"
#include "simulator/horizons/map_operator.h"

namespace faultsim::horizons {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

}  // namespace

SmoothField::Freedom::Freedom(const std::vector<FieldRule>& rules) {
  if (rules.empty()) return;
  const Vector2d n = rules[0].direction.normalized();
  basis.col(0) = Vector2d(-n.y(), n.x());
  n_free = rules.size() == 1 ? 1 : 0;
}

SmoothField::SmoothField(const MapMesh& map, std::vector<std::vector<FieldRule>> rules)
    : rules_(std::move(rules)) {
  const std::size_t n = map.vertices.size();
  const MapOperator op = map_operator(map.vertices, map.triangles, map.triangles, n);
  bending_ = op.stiffness * op.area.cwiseInverse().asDiagonal() * op.stiffness;
  for (std::size_t v = 0; v < n; ++v) {
    free_.emplace_back(rules_[v]);
    free_.back().first = n_free_;
    n_free_ += free_.back().n_free;
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < static_cast<int>(n); ++j)
    for (Sparse::InnerIterator at(bending_, j); at; ++at) {
      const Freedom &row = free_[at.row()], &column = free_[j];
      for (int p = 0; p < row.n_free; ++p)
        for (int q = 0; q < column.n_free; ++q)
          entries.emplace_back(row.first + p, column.first + q,
                               at.value() * row.basis.col(p).dot(column.basis.col(q)));
    }
  Sparse matrix(n_free_, n_free_);
  matrix.setFromTriplets(entries.begin(), entries.end());
  factor_.compute(matrix);
  FAULTSIM_DEMAND(factor_.info() == Eigen::Success, "a smooth field of ", n, " vertices");
}

Vector2d SmoothField::fixed(std::size_t vertex, const Vector2d& values) const {
  const std::vector<FieldRule>& rules = rules_[vertex];
  if (rules.empty()) return Vector2d::Zero();
  const Vector2d& n = rules[0].direction;
  if (rules.size() == 1) return n * (values[0] / n.squaredNorm());
  Eigen::Matrix2d both;
  both << n.transpose(), rules[1].direction.transpose();
  return both.partialPivLu().solve(values);
}

std::vector<Vector2d> SmoothField::solve(const std::vector<Vector2d>& fixed) const {
  std::vector<Vector2d> field;
  for (std::size_t v = 0; v < free_.size(); ++v)
    field.push_back(rules_[v].empty() ? Vector2d::Zero() : fixed[v]);
  VectorXd right = VectorXd::Zero(n_free_);
  for (int j = 0; j < bending_.outerSize(); ++j) {
    if (field[j].isZero(0)) continue;
    for (Sparse::InnerIterator at(bending_, j); at; ++at)
      for (int p = 0; p < free_[at.row()].n_free; ++p)
        right[free_[at.row()].first + p] -= at.value() * free_[at.row()].basis.col(p).dot(field[j]);
  }
  const VectorXd found = factor_.solve(right);
  for (std::size_t v = 0; v < free_.size(); ++v)
    for (int p = 0; p < free_[v].n_free; ++p)
      field[v] += free_[v].basis.col(p) * found[free_[v].first + p];
  return field;
}

}  // namespace faultsim::horizons
