#include "simulator/contact/slip_residual.h"

namespace faultsim {
namespace {

struct Pull {
  Eigen::Vector2d direction;  ///< y/|y|
  double norm;                ///< |y|
  Strength limit;
};

Pull pull_at(const NodeLaw& law, const SlipPoint& point) {
  const Eigen::Vector2d y = point.shear_traction + point.stiffness * point.slip_increment;
  const double norm = y.norm();
  const Eigen::Vector2d m = norm > 0 ? Eigen::Vector2d(y / norm) : Eigen::Vector2d(0, 0);
  return {
      m, norm,
      law.strength(point.normal_traction, point.slip_increment, point.per_second, point.before, m)};
}

}  // namespace

SlipResidual slip_residual(const NodeLaw& law, const SlipPoint& point) {
  const Pull at = pull_at(law, point);
  const Eigen::Vector2d& m = at.direction;
  const Eigen::Matrix2d across = Eigen::Matrix2d::Identity() - m * m.transpose();
  const double ratio = at.norm > 0 ? at.limit.value / at.norm : 0;
  SlipResidual residual;
  residual.value = point.shear_traction - at.limit.value * m;
  residual.d_normal = -at.limit.d_normal * m;
  residual.d_shear = Eigen::Matrix2d::Identity() - ratio * across;
  residual.d_slip = -m * at.limit.d_slip.transpose() - ratio * point.stiffness * across;
  residual.excess = at.norm - at.limit.value;
  return residual;
}

double slip_excess(const NodeLaw& law, const SlipPoint& point) {
  const Pull at = pull_at(law, point);
  return at.norm - at.limit.value;
}

}  // namespace faultsim
