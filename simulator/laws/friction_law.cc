#include "simulator/laws/friction_law.h"

#include <cmath>
#include <limits>

namespace faultsim {

NodeLaw::NodeLaw(const CoulombLaw& constants)
    : constants_(constants),
      static_friction_(std::tan(constants.static_friction_angle)),
      dynamic_friction_(std::tan(constants.dynamic_friction_angle)),
      weakens_(constants.dynamic_friction_angle != constants.static_friction_angle) {}

NodeLaw::MeasuredSlip NodeLaw::measure(const Eigen::Vector2d& slip_increment,
                                       const FrictionState& before,
                                       const Eigen::Vector2d& direction) const {
  const bool cumulated = constants_.slip_measure == SlipMeasure::cumulated;
  const Eigen::Vector2d slip =
      cumulated ? slip_increment : Eigen::Vector2d(before.slip + slip_increment);
  const double norm = slip.norm();
  const Eigen::Vector2d gradient = norm > 0 ? Eigen::Vector2d(slip / norm) : direction;
  return {cumulated ? before.path + norm : norm, gradient};
}

/// φ_d ≠ φ_s. Beyond d_c the dynamic angle is taken as it is, not as the end of a sum.
Strength NodeLaw::weakened(double normal_traction, const MeasuredSlip& s) const {
  const double angle_s = constants_.static_friction_angle;
  const double angle_d = constants_.dynamic_friction_angle;
  const double d_c = constants_.slip_weakening_distance;
  double friction = dynamic_friction_;
  double d_friction = 0;
  if (!(s.value >= d_c)) {
    switch (constants_.weakening) {
      case WeakeningLaw::angle: {
        friction = std::tan(angle_s + (angle_d - angle_s) * (s.value / d_c));
        d_friction = (1 + friction * friction) * (angle_d - angle_s) / d_c;
        break;
      }
      case WeakeningLaw::coefficient: {
        const double drop = dynamic_friction_ - static_friction_;
        friction = static_friction_ + drop * (s.value / d_c);
        d_friction = drop / d_c;
        break;
      }
    }
  }
  const double normal = std::min(normal_traction, 0.0);
  Strength at;
  at.value = constants_.cohesion - normal * friction;
  at.d_normal = normal_traction > 0 ? 0 : -friction;
  at.d_measure = -normal * d_friction;
  at.d_slip = at.d_measure * s.gradient;
  return at;
}

FrictionState NodeLaw::after(const FrictionState& before, const Eigen::Vector2d& slip_increment,
                             bool opened) const {
  const double length = slip_increment.norm();
  const bool lost = (opened && !constants_.cohesion_after_opening) ||
                    (length > 0 && !constants_.cohesion_after_slip);
  return {before.slip + slip_increment, before.path + length, before.cohesive && !lost};
}

/// Both laws weaken fastest at the smallest s met on the way.
double NodeLaw::fastest_weakening(double normal_traction, const Eigen::Vector2d& slip_increment,
                                  const FrictionState& before) const {
  const auto rate_at = [&](double share) {
    return -strength(normal_traction, share * slip_increment, 0, before).d_measure;
  };
  if (constants_.slip_measure == SlipMeasure::cumulated) return rate_at(0);
  const double length = slip_increment.norm();
  const Eigen::Vector2d end = before.slip + slip_increment;
  const double outward = end.dot(slip_increment);
  if (outward <= 0) return 0;  // s shrinks all the way: the node heals
  const double nearest = std::clamp(-before.slip.dot(slip_increment) / (length * length), 0.0, 1.0);
  return rate_at(nearest) * (end.norm() > 0 ? outward / (length * end.norm()) : 1);
}

NodeLaws::NodeLaws(std::span<const CoulombLaw> constants) {
  for (const CoulombLaw& own : constants) {
    if (laws_.empty() || own != laws_.back().constants()) laws_.emplace_back(own);
    number_.push_back(static_cast<std::uint32_t>(laws_.size() - 1));
  }
}

bool NodeLaws::any_weakens() const { return std::ranges::any_of(laws_, &NodeLaw::weakens); }

double nucleation_length(double modulus, double weakening_rate) {
  constexpr double kUenishiRice = 1.157773883699;  // Uenishi and Rice (2003), 0.579 x 2
  if (!(weakening_rate > 0)) return std::numeric_limits<double>::infinity();
  return kUenishiRice * modulus / weakening_rate;
}

}  // namespace faultsim
