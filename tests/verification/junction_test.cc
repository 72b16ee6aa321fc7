// A crack that ends at a fault (a T) is opened by pressure and the fault slips without friction, in
// tetrahedra; against displacement discontinuities in an infinite body.

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <map>
#include <numbers>

#include "simulator/condensation/condensation.h"
#include "tests/verification/grid_body.h"

namespace faultsim {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kLength = 100;  // m, of the branch; the fault has one to each side
constexpr double kPressure = 1e6;
const ElasticMaterial kRock{15e9, 0.25};

/// What opens and what slips, m2 (per metre of y).
struct Answer {
  double volume = 0;  ///< ∫ opening of the branch.
  double slip = 0;    ///< ∫ |slip| of the fault.
};

// ---- displacement discontinuities, in the plane

/// Stress of an edge dislocation at the origin (Hirth and Lothe) per G/(2π(1−ν)).
Matrix2d dislocation_stress(const Vector2d& at, const Vector2d& burgers) {
  const double x = at.x(), z = at.y(), r4 = std::pow(at.squaredNorm(), 2);
  const double xx = -burgers.x() * z * (3 * x * x + z * z) + burgers.y() * x * (x * x - z * z);
  const double zz = burgers.x() * z * (x * x - z * z) + burgers.y() * x * (x * x + 3 * z * z);
  const double xz = burgers.x() * x * (x * x - z * z) + burgers.y() * z * (x * x - z * z);
  return (Matrix2d() << xx, xz, xz, zz).finished() / r4;
}

/// A straight piece with one jump (of what is left of the way along it, less what is right) in one
/// direction.
struct Piece {
  Vector2d from, to, jump;
  double traction;  ///< along `jump` on it, Pa.
  Vector2d normal() const {
    const Vector2d along = (to - from).normalized();
    return {-along.y(), along.x()};
  }
  double length() const { return (to - from).norm(); }
};

VectorXd jumps_of(const std::vector<Piece>& pieces) {
  const auto n = static_cast<Eigen::Index>(pieces.size());
  const double stiffness =
      shear_modulus(kRock) / (2 * std::numbers::pi * (1 - kRock.poisson_ratio));
  Eigen::MatrixXd influence(n, n);
  VectorXd traction(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Piece& one = pieces[static_cast<std::size_t>(i)];
    const Vector2d middle = (one.from + one.to) / 2;
    traction[i] = one.traction;
    for (Eigen::Index j = 0; j < n; ++j) {
      const Piece& other = pieces[static_cast<std::size_t>(j)];
      const Matrix2d stress = dislocation_stress(middle - other.to, other.jump) -
                              dislocation_stress(middle - other.from, other.jump);
      influence(i, j) = stiffness * one.jump.dot(stress * one.normal());
    }
  }
  return influence.partialPivLu().solve(traction);
}

/// Pieces of a straight line, n per length, with one jump.
void add_line(std::vector<Piece>& pieces, const Vector2d& from, const Vector2d& to, int n,
              const Vector2d& jump, double traction) {
  const long parts = std::lround(n * (to - from).norm() / kLength);
  const auto at = [&](long k) -> Vector2d {
    return from + (to - from) * static_cast<double>(k) / static_cast<double>(parts);
  };
  for (long k = 0; k < parts; ++k) pieces.push_back({at(k), at(k + 1), jump, traction});
}

/// The branch runs from the middle of the fault to larger x.
Answer t_by_discontinuities(int n) {
  std::vector<Piece> pieces;
  const Vector2d x(1, 0), z(0, 1), end = kLength * x, top = kLength * z;
  add_line(pieces, -top, top, n, z, 0);
  add_line(pieces, Vector2d::Zero(), end, n, x, 0);
  add_line(pieces, Vector2d::Zero(), end, n, z, -kPressure);
  const VectorXd jumps = jumps_of(pieces);
  return {kLength / n * jumps.tail(n).sum(), kLength / n * jumps.head(2 * n).cwiseAbs().sum()};
}

/// The volume of both of two cracks that cross in their middles, under pressure.
double cross_by_discontinuities(int n) {
  std::vector<Piece> pieces;
  const Vector2d end(kLength, 0), top(0, kLength);
  // Neither slips, by symmetry. To the left of the way up is smaller x.
  add_line(pieces, -end, end, n, {0, 1}, -kPressure);
  add_line(pieces, -top, top, n, {-1, 0}, -kPressure);
  return kLength / n * jumps_of(pieces).sum();
}

// ---- tetrahedra

/// Even steps h in [from, to] and growing ones out to ± far.
std::vector<double> graded(double from, double to, double h, double far) {
  std::vector<double> lines;
  for (int k = 0; k <= std::lround((to - from) / h); ++k) lines.push_back(from + k * h);
  constexpr double kGrowth = 1.3;
  for (double step = h; lines.back() < far;) lines.push_back(lines.back() + (step *= kGrowth));
  for (double step = h; lines.front() > -far;)
    lines.insert(lines.begin(), lines.front() - (step *= kGrowth));
  return lines;
}

struct Setting {
  double h;
  bool branch_first = false;
  Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();
  bool holds_branch_at_end = true;  ///< across the fault, which is closed on both sides of it.
  bool crosses = false;             ///< the branch goes on to the other side, and the fault opens.
};

BulkProblem problem_of(const Setting& setting) {
  const double h = setting.h, margin = 5 * h, from = setting.crosses ? -kLength : 0;
  test::GridBody grid({graded(from - margin, kLength + margin, h, 20 * kLength),
                       {0, h},
                       graded(-kLength - margin, kLength + margin, h, 20 * kLength)});
  grid.add_fault("fault", 0, 0, [](const Vector3d& x) { return std::abs(x.z()) < kLength; });
  grid.add_fault("branch", 2, 0,
                 [&](const Vector3d& x) { return x.x() > from && x.x() < kLength; });
  if (setting.branch_first) std::swap(grid.body.faults[0], grid.body.faults[1]);
  grid.turn(setting.turned);
  BulkProblem problem;
  problem.mesh = cut(grid.body, "");
  problem.materials = {kRock};
  for (const Side side :
       {Side::x_min, Side::x_max, Side::y_min, Side::y_max, Side::z_min, Side::z_max}) {
    const bool flat = side == Side::y_min || side == Side::y_max;
    problem.conditions.push_back(
        {side, {!flat, true, !flat}, Vector3d::Zero(), Eigen::Matrix3d::Zero(), -1});
  }
  return problem;
}

bool is_end(const OperatorNode& node) {
  return std::hypot(node.position.x(), node.position.z()) < 1e-6 * kLength;
}

/// Jumps that are free, with the tractions −A⁻¹ H g on them.
struct FreeJumps {
  std::vector<int> dofs;
  std::vector<double> traction, area;
  void add(int dof, double of_traction, double of_area) {
    if (dof < 0) return;
    dofs.push_back(dof);
    traction.push_back(of_traction);
    area.push_back(of_area);
  }
};

FreeJumps free_jumps(const FaultOperator& op, const Setting& setting) {
  FreeJumps jumps;
  for (const OperatorFault& fault : op.geometry.faults)
    for (int k = 0; k < fault.n_nodes; ++k) {
      const OperatorNode& node = op.geometry.nodes[static_cast<std::size_t>(fault.first_node + k)];
      const bool is_branch = fault.name == "branch";
      if (is_branch || setting.crosses) jumps.add(node.dof[0], -kPressure, node.area);
      const bool is_closed_across = setting.holds_branch_at_end && !setting.crosses;
      if (is_branch && is_end(node) && is_closed_across) continue;
      jumps.add(node.dof[1], 0, node.area);
      jumps.add(node.dof[2], 0, node.area);
    }
  return jumps;
}

VectorXd solve(const FaultOperator& op, const FreeJumps& jumps) {
  const auto n = static_cast<Eigen::Index>(jumps.dofs.size());
  Eigen::MatrixXd h(n, n);
  VectorXd force(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    force[i] = -jumps.traction[at] * jumps.area[at];
    for (Eigen::Index j = 0; j < n; ++j)
      h(i, j) = op.h()(jumps.dofs[at], jumps.dofs[static_cast<std::size_t>(j)]);
  }
  const VectorXd solved = h.ldlt().solve(force);
  VectorXd g = VectorXd::Zero(op.geometry.n_dofs);
  for (Eigen::Index i = 0; i < n; ++i) g[jumps.dofs[static_cast<std::size_t>(i)]] = solved[i];
  return g;
}

/// By fault: ∫ opening and ∫ |slip|, without what slips at the end of the branch.
std::map<std::string, Answer> integrals(const FaultOperator& op, const VectorXd& g, double width) {
  std::map<std::string, Answer> found;
  for (const OperatorFault& fault : op.geometry.faults)
    for (int k = 0; k < fault.n_nodes; ++k) {
      const OperatorNode& node = op.geometry.nodes[static_cast<std::size_t>(fault.first_node + k)];
      const auto jump = [&](std::size_t c) { return node.dof[c] < 0 ? 0 : g[node.dof[c]]; };
      Answer& answer = found[fault.name];
      answer.volume += node.area / width * jump(0);
      if (!is_end(node)) answer.slip += node.area / width * std::hypot(jump(1), jump(2));
      // The fault slips there by half of the branch's opening, on one side up, on the other down.
      else if (fault.name == "branch")
        found["fault"].slip += node.area / width * jump(0);
    }
  return found;
}

std::map<std::string, Answer> solved(const Setting& setting) {
  SilentMonitor monitor;
  const FaultOperator op = CondensedBulk(problem_of(setting), monitor).condense();
  return integrals(op, solve(op, free_jumps(op, setting)), setting.h);
}

Answer by_tetrahedra(const Setting& setting) {
  const std::map<std::string, Answer> all = solved(setting);
  return {all.at("branch").volume, all.at("fault").slip};
}

/// From values of first order in h: those at h and at a half of it.
double limit(double coarse, double fine) { return 2 * fine - coarse; }

void expect_near(const Answer& answer, const Answer& exact, double by) {
  EXPECT_NEAR(answer.volume, exact.volume, by * exact.volume);
  EXPECT_NEAR(answer.slip, exact.slip, by * exact.slip);
}

Answer exact_t() {
  const Answer coarse = t_by_discontinuities(100), fine = t_by_discontinuities(200);
  return {limit(coarse.volume, fine.volume), limit(coarse.slip, fine.slip)};
}

TEST(Junction, DiscontinuitiesOpenASingleCrackAsItsClosedForm) {
  const auto volume = [](int n) {
    std::vector<Piece> pieces;
    add_line(pieces, {0, 0}, {2 * kLength, 0}, n, {0, 1}, -kPressure);
    return kLength / n * jumps_of(pieces).sum();
  };
  const double exact = 2 * std::numbers::pi * (1 - std::pow(kRock.poisson_ratio, 2)) * kPressure *
                       kLength * kLength / kRock.youngs_modulus;
  EXPECT_NEAR(limit(volume(50), volume(100)), exact, 1e-4 * exact);
}

/// What is missing is of first order, as at any tip; the body of 20 lengths takes 0.15 %.
TEST(Junction, ABranchOpensAndItsFaultSlips) {
  const Answer exact = exact_t();
  const Answer coarse = by_tetrahedra({kLength / 10}), fine = by_tetrahedra({kLength / 20});
  expect_near(coarse, exact, 0.025);
  expect_near(fine, exact, 0.013);
  expect_near({limit(coarse.volume, fine.volume), limit(coarse.slip, fine.slip)}, exact, 0.0015);
}

TEST(Junction, SlowFineBranchesConverge) {
  const Answer exact = exact_t();
  const Answer coarse = by_tetrahedra({kLength / 20}), fine = by_tetrahedra({kLength / 40});
  expect_near(by_tetrahedra({kLength / 30}), exact, 0.0085);
  expect_near({limit(coarse.volume, fine.volume), limit(coarse.slip, fine.slip)}, exact, 0.002);
}

/// A contact law need not know that the fault is closed on each side of a branch: its mean is.
TEST(Junction, HoldingTheBranchAcrossTheFaultChangesLittle) {
  const double h = kLength / 10;
  expect_near(by_tetrahedra({.h = h, .holds_branch_at_end = false}), by_tetrahedra({h}), 5e-5);
}

TEST(Junction, OrderSidesAndAxesChangeNothing) {
  const double h = kLength / 10;
  const Answer answer = by_tetrahedra({h});
  expect_near(by_tetrahedra({.h = h, .branch_first = true}), answer, 1e-9);
  Eigen::Matrix3d turned;
  turned << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  expect_near(by_tetrahedra({.h = h, .turned = turned}), answer, 1e-9);
  for (const Vector3d& mirrored : {Vector3d(-1, 1, 1), Vector3d(1, 1, -1)})
    expect_near(by_tetrahedra({.h = h, .turned = mirrored.asDiagonal()}), answer, 1e-9);
}

TEST(Junction, CracksThatCrossOpenAlikeWhicheverGoesOn) {
  const double exact = limit(cross_by_discontinuities(50), cross_by_discontinuities(100));
  std::vector<double> volumes;
  for (const bool branch_first : {false, true}) {
    const auto all = solved({.h = kLength / 10, .branch_first = branch_first, .crosses = true});
    const double volume = all.at("fault").volume + all.at("branch").volume;
    EXPECT_NEAR(all.at("fault").volume, volume / 2, 1e-9 * volume);
    EXPECT_NEAR(volume, exact, 0.02 * exact);
    volumes.push_back(volume);
  }
  EXPECT_NEAR(volumes[0], volumes[1], 1e-9 * exact);
}

}  // namespace
}  // namespace faultsim
