// A fault that is a part of a cylinder, its facets flat, in a body under uniform stress: against
// the traction on the cylinder itself.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "simulator/condensation/condensation.h"
#include "tests/verification/grid_body.h"

namespace faultsim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kRadius = 1000;  // m
constexpr double kStart = 0.3;    // rad, from the x axis up: where the arc leaves the body
constexpr double kScale = 30e6;   // Pa, the largest stress

const ElasticMaterial kRock{11e9, 0.15};

Eigen::Matrix3d uniform_stress() {
  Eigen::Matrix3d stress;
  stress << -20, 3, 2, 3, -25, 1, 2, 1, -30;
  return 1e6 * stress;
}

/// Of the cylinder, outwards.
Vector3d normal_at(double angle) { return {std::cos(angle), 0, std::sin(angle)}; }

/// Where on the cylinder a point is: angle, y.
Vector2d chart(const Vector3d& x) { return {std::atan2(x.z(), x.x()), x.y()}; }

/// Facets of edge h on an arc of eight, and cells of that size beside them.
/// @param uneven  how far nodes of the fault move along it, in parts of h.
BulkProblem arc_problem(double h, double uneven) {
  test::GridBody grid({test::even_lines(-3 * h, 3 * h, 6), test::even_lines(0, 6 * h, 6),
                       test::even_lines(0, 8 * h, 8)});
  grid.add_fault("arc", 0, 0, [](const Vector3d&) { return true; });
  std::mt19937 random(3);
  std::uniform_real_distribution<double> move(-uneven * h, uneven * h);
  for (Vector3d& x : grid.body.nodes) {
    const Vector2d moved(move(random), move(random));
    const bool inside = x.y() > 0.5 * h && x.y() < 5.5 * h && x.z() > 0.5 * h && x.z() < 7.5 * h;
    if (x.x() == 0 && inside) x += Vector3d(0, moved.x(), moved.y());
    x = (kRadius + x.x()) * normal_at(kStart + x.z() / kRadius) + x.y() * Vector3d::UnitY();
  }
  BulkProblem problem;
  problem.mesh = cut(grid.body, "");
  problem.materials = {kRock};
  LoadCase load;
  load.key = {LoadKey::Kind::boundary, 0};
  load.stress = uniform_stress();
  for (const Side side :
       {Side::x_min, Side::x_max, Side::y_min, Side::y_max, Side::z_min, Side::z_max})
    load.stress_groups.emplace_back(side);
  problem.loads = {load};
  return problem;
}

Vector3d traction_of(const FaultOperator& op, const OperatorNode& node) {
  return op.loads.traction(node.dof[0], 0) * node.normal +
         op.loads.traction(node.dof[1], 0) * node.strike +
         op.loads.traction(node.dof[2], 0) * node.dip;
}

/// Of the normal of the cylinder over the part of it that the facets around a node stand for.
struct HatMean {
  Vector3d normal = Vector3d::Zero();
  double area = 0;  ///< m2
};

/// By three points on each facet, moved out to the cylinder.
std::vector<HatMean> hat_means(const FaultSurface& fault) {
  std::vector<HatMean> means(fault.nodes.size());
  for (const FaultFace& face : fault.faces) {
    std::array<Vector2d, 3> at;
    for (std::size_t v = 0; v < 3; ++v)
      at[v] = chart(fault.points[static_cast<std::size_t>(face.points[v])]);
    const Vector2d a = at[1] - at[0], b = at[2] - at[0];
    const double weight = kRadius * std::abs(a.x() * b.y() - a.y() * b.x()) / 6;
    for (const Vector3d& hat : {Vector3d(4, 1, 1), Vector3d(1, 4, 1), Vector3d(1, 1, 4)}) {
      const Vector2d point = (hat[0] * at[0] + hat[1] * at[1] + hat[2] * at[2]) / 6;
      for (std::size_t v = 0; v < 3; ++v) {
        HatMean& mean = means[static_cast<std::size_t>(face.nodes[v])];
        mean.normal += hat[static_cast<int>(v)] / 6 * weight * normal_at(point.x());
        mean.area += hat[static_cast<int>(v)] / 6 * weight;
      }
    }
  }
  for (HatMean& mean : means) mean.normal /= mean.area;
  return means;
}

struct Errors {
  double at_node = 0;   ///< of tractions against σ n at the node, of nodes inside of the fault.
  double hat_mean = 0;  ///< of theirs against their hat means.
  double at_edge = 0;   ///< of those on the outside of the body against their hat means.
  double area = 0;      ///< of A_k, relative.
};

/// Whether a node of an arc is not on the outside of the body.
bool is_inside(const Vector3d& x, double h) {
  const double along = kRadius * (chart(x).x() - kStart);
  return along > 0.5 * h && along < 7.5 * h && x.y() > 0.5 * h && x.y() < 5.5 * h;
}

Errors errors_of(double h, double uneven) {
  const BulkProblem problem = arc_problem(h, uneven);
  SilentMonitor monitor;
  const FaultOperator op = CondensedBulk(problem, monitor).condense();
  const std::vector<HatMean> means = hat_means(problem.mesh.faults[0]);
  Errors errors;
  for (std::size_t k = 0; k < means.size(); ++k) {
    const OperatorNode& node = op.geometry.nodes[k];
    const auto off = [&](const Vector3d& n) {
      return (traction_of(op, node) - uniform_stress() * n).norm() / kScale;
    };
    const bool inside = is_inside(node.position, h);
    double& error = inside ? errors.hat_mean : errors.at_edge;
    error = std::max(error, off(means[k].normal));
    if (inside) errors.at_node = std::max(errors.at_node, off(normal_at(chart(node.position).x())));
    errors.area = std::max(errors.area, std::abs(node.area / means[k].area - 1));
  }
  return errors;
}

TEST(CurvedFault, TractionsOfEvenFacetsAreOfSecondOrder) {
  const Errors coarse = errors_of(kRadius / 20, 0), fine = errors_of(kRadius / 40, 0);
  EXPECT_LT(coarse.at_node, 3e-4);
  EXPECT_LT(fine.at_node, 0.26 * coarse.at_node);
  EXPECT_LT(coarse.area, 1.1e-4);
  EXPECT_LT(fine.area, 0.26 * coarse.area);
}

/// A flat facet has one normal, its part of the cylinder has a mean by each hat: where the facets
/// around a node do not balance, what they leave is of first order.
TEST(CurvedFault, TractionsOfUnevenFacetsAreTheirHatMeans) {
  const Errors coarse = errors_of(kRadius / 20, 0.2), fine = errors_of(kRadius / 40, 0.2);
  EXPECT_LT(coarse.hat_mean, 0.004);
  EXPECT_LT(fine.hat_mean, 0.55 * coarse.hat_mean);
  EXPECT_LT(coarse.at_edge, 0.013);
  EXPECT_LT(fine.at_edge, 0.55 * coarse.at_edge);
  EXPECT_LT(coarse.at_node, 0.016);  // The hat's centre is not at the node either.
  EXPECT_LT(fine.at_node, 0.55 * coarse.at_node);
}

/// The largest changes of normal and of shear traction, G s / R, when the block inside turns about
/// the axis of the cylinder by s at the fault: nothing holds it in truth.
Vector2d held_by_frames(double h, double uneven) {
  SilentMonitor monitor;
  const FaultOperator op = CondensedBulk(arc_problem(h, uneven), monitor).condense();
  Eigen::VectorXd g = Eigen::VectorXd::Zero(op.geometry.n_dofs);
  for (const OperatorNode& node : op.geometry.nodes) {
    const Vector3d along = Vector3d::UnitY().cross(normal_at(chart(node.position).x()));
    g[node.dof[1]] = along.dot(node.strike);
    g[node.dof[2]] = along.dot(node.dip);
  }
  const Eigen::VectorXd force = op.h() * g;
  Vector2d largest = Vector2d::Zero();
  for (const OperatorNode& node : op.geometry.nodes)
    for (std::size_t c = 0; c < 3; ++c) {
      double& one = largest[c == 0 ? 0 : 1];
      one = std::max(one, std::abs(force[node.dof[c]]) / node.area);
    }
  return largest / (shear_modulus(kRock) / kRadius);
}

/// The normal of a frame is the mean over the facets, which on uneven ones is not that of the
/// cylinder: slip along it opens the fault a little here and closes it there. That does not fall
/// with h, but with the curvature.
TEST(CurvedFault, SlipAlongItHardlyChangesItsTraction) {
  const Vector2d even = held_by_frames(kRadius / 20, 0);
  EXPECT_LT(even[0], 0.25);
  EXPECT_LT(even[1], 0.03);
  const Vector2d uneven = held_by_frames(kRadius / 20, 0.2);
  EXPECT_LT(uneven[0], 0.3);
  EXPECT_LT(uneven[1], 0.03);
}

}  // namespace
}  // namespace faultsim
