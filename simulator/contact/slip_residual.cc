#include "simulator/contact/slip_residual.h"

namespace faultsim {
namespace {

struct Strength {
  Eigen::Vector2d direction;
  double norm;  ///< |y|
  LimitShearTraction limit;
  Eigen::Vector2d d_slip;  ///< ∂τ_L/∂Δg_T
};

Strength strength_at(const ContactProblem& problem, int k, const SlipPoint& point) {
  const auto i = static_cast<std::size_t>(k);
  const Eigen::Vector2d y = point.shear_traction + point.stiffness * point.slip_increment;
  const double norm = y.norm();
  Strength at{norm > 0 ? Eigen::Vector2d(y / norm) : Eigen::Vector2d(0, 0), norm, {}, {0, 0}};
  if (problem.nodes[i].weakens) {
    const SlipMeasure measure = slip_measure(problem.laws.cumulated[i] != 0, point.path_before,
                                             point.slip_before, point.slip_increment, at.direction);
    at.limit = problem.strength(k, point.cohesive, point.normal_traction, measure.value);
    at.d_slip = at.limit.d_slip * measure.gradient;
  } else {
    at.limit = problem.strength(k, point.cohesive, point.normal_traction, 0);
  }
  if (point.damping > 0) {
    const double slip = point.slip_increment.norm();
    at.limit.value += point.damping * slip;
    at.d_slip +=
        point.damping * (slip > 0 ? Eigen::Vector2d(point.slip_increment / slip) : at.direction);
  }
  return at;
}

}  // namespace

SlipResidual slip_residual(const ContactProblem& problem, int k, const SlipPoint& point) {
  const Strength at = strength_at(problem, k, point);
  const Eigen::Vector2d& m = at.direction;
  const Eigen::Matrix2d across = Eigen::Matrix2d::Identity() - m * m.transpose();
  const double ratio = at.norm > 0 ? at.limit.value / at.norm : 0;
  SlipResidual residual;
  residual.value = point.shear_traction - at.limit.value * m;
  residual.d_normal = -at.limit.d_normal_traction * m;
  residual.d_shear = Eigen::Matrix2d::Identity() - ratio * across;
  residual.d_slip = -m * at.d_slip.transpose() - ratio * point.stiffness * across;
  residual.excess = at.norm - at.limit.value;
  return residual;
}

double slip_excess(const ContactProblem& problem, int k, const SlipPoint& point) {
  const Strength at = strength_at(problem, k, point);
  return at.norm - at.limit.value;
}

}  // namespace faultsim
