#include "simulator/coupled/slip_tangent.h"

#include "simulator/contact/contact_problem.h"

namespace faultsim {

SlipTangent slip_tangent(const CoulombLaw& law, const SlippingPoint& point) {
  const double slip = point.slip_increment.norm();
  const Eigen::Vector2d m =
      slip > 0 ? Eigen::Vector2d(point.slip_increment / slip) : point.traction_direction;
  const SlipMeasure measure =
      slip_measure(point.cumulated, point.path_before, point.slip_before, point.slip_increment, m);
  const LimitShearTraction limit = limit_shear_traction(law, point.normal_traction, measure.value);
  SlipTangent tangent;
  tangent.traction = limit.value * m;
  tangent.d_slip = limit.d_slip * m * measure.gradient.transpose();
  if (slip > 0) {
    tangent.d_slip += limit.value / slip * (Eigen::Matrix2d::Identity() - m * m.transpose());
  }
  tangent.d_normal = limit.d_normal_traction * m;
  return tangent;
}

}  // namespace faultsim
