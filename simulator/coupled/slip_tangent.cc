#include "simulator/coupled/slip_tangent.h"

namespace faultsim {

SlipTangent slip_tangent(const NodeLaw& law, const SlippingPoint& point) {
  const double slip = point.slip_increment.norm();
  const Eigen::Vector2d m =
      slip > 0 ? Eigen::Vector2d(point.slip_increment / slip) : point.traction_direction;
  const Strength limit =
      law.strength(point.normal_traction, point.slip_increment, 0, point.before, m);
  SlipTangent tangent;
  tangent.traction = limit.value * m;
  tangent.d_slip = m * limit.d_slip.transpose();
  if (slip > 0) {
    tangent.d_slip += limit.value / slip * (Eigen::Matrix2d::Identity() - m * m.transpose());
  }
  tangent.d_normal = limit.d_normal * m;
  return tangent;
}

}  // namespace faultsim
