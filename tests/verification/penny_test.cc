// A penny-shaped shear crack on quadratic tetrahedra, against its closed form and against hexahedra
// on the same nodes.

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "simulator/condensation/condensation.h"
#include "tests/verification/closed_forms/elastic_solutions.h"
#include "tests/verification/grid_body.h"

namespace faultsim {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kRadius = 100, kFar = 600;  // m
constexpr double kDrop = 5e6;                // Pa
const ElasticMaterial kRock{25e9, 0.25};

/// Errors against the closed form, relative.
struct Errors {
  int n_unknowns, n_jumps;
  double slip = 0;    ///< in L2, of nodes within 0.8 of the radius.
  double moment = 0;  ///< what is missing.
};

/// The jumps along strike and dip that a shear traction along dip leaves free; the crack is closed.
VectorXd slip_of(const FaultOperator& op) {
  std::vector<int> free;
  VectorXd force = VectorXd::Zero(op.geometry.n_dofs);
  for (const OperatorNode& node : op.geometry.nodes) {
    free.push_back(node.dof[1]);
    free.push_back(node.dof[2]);
    force[node.dof[2]] = kDrop * node.area;
  }
  const auto n = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd h(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      h(i, j) = op.h()(free[static_cast<std::size_t>(i)], free[static_cast<std::size_t>(j)]);
  return h.llt().solve(force(free));
}

Errors errors_of(const FaultOperator& op) {
  const VectorXd slip = slip_of(op);
  const double modulus = shear_modulus(kRock), nu = kRock.poisson_ratio;
  double off = 0, all = 0, moment = 0;
  for (std::size_t k = 0; k < op.geometry.nodes.size(); ++k) {
    const OperatorNode& node = op.geometry.nodes[k];
    const double own = slip[2 * static_cast<Eigen::Index>(k) + 1], r = node.position.norm();
    moment += modulus * node.area * own;
    if (r > 0.8 * kRadius) continue;
    const double exact = penny_crack_slip(modulus, nu, kDrop, kRadius, r);
    off += node.area * (own - exact) * (own - exact);
    all += node.area * exact * exact;
  }
  return {op.n_unknowns, op.geometry.n_dofs, std::sqrt(off / all),
          1 - moment / penny_crack_moment(nu, kDrop, kRadius)};
}

/// Even steps h to both sides as far as `to`, then twice the last.
std::vector<double> graded(double to, double h) {
  std::vector<double> up = {0};
  while (up.back() < to - 1e-9) up.push_back(up.back() + h);
  for (double step = h; up.back() < kFar;) up.push_back(up.back() + (step *= 2));
  std::vector<double> lines;
  for (auto x = up.rbegin(); x != up.rend(); ++x) lines.push_back(-*x);
  lines.insert(lines.end(), up.begin() + 1, up.end());
  return lines;
}

/// With a line between each two.
std::vector<double> halved(const std::vector<double>& lines) {
  std::vector<double> all = {lines.front()};
  for (std::size_t k = 1; k < lines.size(); ++k) {
    all.push_back((lines[k - 1] + lines[k]) / 2);
    all.push_back(lines[k]);
  }
  return all;
}

/// Squares around the middle of the plane x = 0 become circles, less so outside of the crack.
Vector3d rounded(const Vector3d& x) {
  const double square = std::max(std::abs(x.y()), std::abs(x.z()));
  if (square == 0) return x;
  const double share = std::clamp((3 * kRadius - square) / (2 * kRadius), 0., 1.);
  const double by = 1 + share * (square / std::hypot(x.y(), x.z()) - 1);
  return {x.x(), by * x.y(), by * x.z()};
}

/// Hexahedra have half of the size, so that their nodes are those of the tetrahedra.
Errors solve(CellShape shape, int cells_per_radius, bool mean_dilatation) {
  const double h = kRadius / cells_per_radius;
  std::array<std::vector<double>, 3> lines = {graded(h, h), graded(1.25 * kRadius, h),
                                              graded(1.25 * kRadius, h)};
  if (shape == CellShape::hexahedron)
    for (std::vector<double>& of_axis : lines) of_axis = halved(of_axis);
  test::GridBody grid(lines, {0, 0, 0}, shape);
  grid.add_fault("crack", 0, 0, [](const Vector3d& x) {
    return std::max(std::abs(x.y()), std::abs(x.z())) < kRadius;
  });
  for (Vector3d& x : grid.body.nodes) x = rounded(x);
  BulkProblem problem;
  problem.mesh = cut(grid.body, "");
  problem.materials = {kRock};
  problem.mean_dilatation = mean_dilatation;
  SilentMonitor monitor;
  return errors_of(CondensedBulk(problem, monitor).condense());
}

/// Jumps of tetrahedra are twice as far from each other, and the last ones inside the rim with
/// them: a fifth more of the moment is missing. With as many jumps less is.
TEST(Penny, TetrahedraSlipCloserThanHexahedraOnTheSameNodes) {
  const Errors tetrahedra = solve(CellShape::tetrahedron, 3, true);
  const Errors hexahedra = solve(CellShape::hexahedron, 3, true);
  EXPECT_NEAR(tetrahedra.n_unknowns, hexahedra.n_unknowns, 0.01 * hexahedra.n_unknowns);
  EXPECT_LT(4 * tetrahedra.n_jumps, hexahedra.n_jumps);
  EXPECT_LT(tetrahedra.slip, 0.018);
  EXPECT_LT(tetrahedra.slip, 0.3 * hexahedra.slip);
  EXPECT_LT(tetrahedra.moment, 0.16);
  EXPECT_LT(tetrahedra.moment, 1.25 * hexahedra.moment);
  EXPECT_LT(solve(CellShape::tetrahedron, 3, false).slip, 0.8 * hexahedra.slip);
}

TEST(Penny, SlowTetrahedraWithAsManyJumpsAreBetter) {
  const Errors tetrahedra = solve(CellShape::tetrahedron, 4, true);
  const Errors hexahedra = solve(CellShape::hexahedron, 2, true);
  EXPECT_EQ(tetrahedra.n_jumps, hexahedra.n_jumps);
  EXPECT_LT(tetrahedra.slip, 0.021);
  EXPECT_LT(tetrahedra.slip, 0.25 * hexahedra.slip);
  EXPECT_LT(tetrahedra.moment, 0.115);
  EXPECT_LT(tetrahedra.moment, 0.65 * hexahedra.moment);
}

}  // namespace
}  // namespace faultsim
