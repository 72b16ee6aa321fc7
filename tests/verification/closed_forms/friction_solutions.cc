#include "tests/verification/closed_forms/friction_solutions.h"

#include <algorithm>
#include <cmath>

#include "tests/verification/closed_forms/elastic_solutions.h"

namespace faultsim {

double initial_critical_index(double stress_ratio, double dip_from_vertical,
                              double friction_angle) {
  const double s = std::sin(dip_from_vertical), c = std::cos(dip_from_vertical);
  return (1 - stress_ratio) * s * c / ((stress_ratio * c * c + s * s) * std::tan(friction_angle));
}

FaultLoad fault_load(const UniformDepletion& state, double pressure_change) {
  // θ from the horizontal: sin θ = cos β.
  const double s = std::cos(state.dip_from_vertical), c = std::sin(state.dip_from_vertical);
  const double gamma = horizontal_stress_ratio(state.poisson_ratio, state.biot);
  const double normal =
      state.effective_horizontal_stress * s * s + state.effective_vertical_stress * c * c;
  const double shear =
      (state.effective_vertical_stress - state.effective_horizontal_stress) * s * c;
  return {normal - pressure_change * (state.fault_biot - gamma * s * s),
          shear - pressure_change * gamma * s * c};
}

double critical_depletion(const UniformDepletion& state) {
  const double mu = std::tan(state.friction_angle);
  const FaultLoad start = fault_load(state, 0);
  const double s = std::cos(state.dip_from_vertical), c = std::sin(state.dip_from_vertical);
  const double gamma = horizontal_stress_ratio(state.poisson_ratio, state.biot);
  return (mu * start.normal - start.shear) /
         (gamma * s * c - mu * (state.fault_biot - gamma * s * s));
}

double slider_strength(const Slider& slider, double slip) {
  const double share = std::min(std::abs(slip) / slider.slip_weakening_distance, 1.0);
  if (slider.weakens_angle) {
    const double angle = slider.static_friction_angle +
                         (slider.dynamic_friction_angle - slider.static_friction_angle) * share;
    return slider.normal_stress * std::tan(angle);
  }
  const double mu_s = std::tan(slider.static_friction_angle);
  const double mu_d = std::tan(slider.dynamic_friction_angle);
  return slider.normal_stress * (mu_s + (mu_d - mu_s) * share);
}

double slider_onset(const Slider& slider) { return slider_strength(slider, 0) / slider.stiffness; }

double slider_critical_distance(const Slider& slider) {
  if (!slider.weakens_angle)
    return slider.normal_stress *
           (std::tan(slider.static_friction_angle) - std::tan(slider.dynamic_friction_angle)) /
           slider.stiffness;
  const double cosine = std::cos(slider.static_friction_angle);
  return slider.normal_stress * (slider.static_friction_angle - slider.dynamic_friction_angle) /
         (cosine * cosine * slider.stiffness);
}

double slider_slip(const Slider& slider, double u) {
  const auto excess = [&](double d) {
    return slider.stiffness * (u - d) - slider_strength(slider, d);
  };
  if (excess(0) <= 0) return 0;
  double low = 0, high = u;  // excess(u) = −strength < 0
  constexpr int halvings = 200;
  for (int i = 0; i < halvings && low < high; ++i) {
    const double middle = low + (high - low) / 2;
    (excess(middle) > 0 ? low : high) = middle;
  }
  return low + (high - low) / 2;
}

SliderPath slider_path(const Slider& slider, const std::vector<double>& u) {
  SliderPath path;
  const double strength = slider_strength(slider, 0);
  double slip = 0;
  for (const double value : u) {
    const double before = slip;
    const double trial = slider.stiffness * (value - slip);
    if (std::abs(trial) > strength)
      slip = value - std::copysign(strength, trial) / slider.stiffness;
    path.dissipated += strength * std::abs(slip - before);
    path.slip.push_back(slip);
  }
  return path;
}

namespace {

/// Orthogonal projection onto the cone |x_t| ≤ μ x_n.
Eigen::Vector3d project_on_cone(const Eigen::Vector3d& x, double mu) {
  const double tangential = x.tail<2>().norm();
  if (tangential <= mu * x[0]) return x;
  if (mu * tangential <= -x[0]) return Eigen::Vector3d::Zero();
  const double normal = (x[0] + mu * tangential) / (1 + mu * mu);
  Eigen::Vector3d projected;
  projected << normal, x.tail<2>() * (mu * normal / tangential);
  return projected;
}

}  // namespace

double cone_residual(const Eigen::MatrixXd& w, const Eigen::VectorXd& q,
                     double friction_coefficient, const Eigen::VectorXd& r) {
  const Eigen::VectorXd u = w * r + q;
  double squares = 0;
  for (Eigen::Index k = 0; k < r.size(); k += 3) {
    Eigen::Vector3d velocity = u.segment<3>(k);
    velocity[0] += friction_coefficient * velocity.tail<2>().norm();
    const Eigen::Vector3d reaction = r.segment<3>(k);
    squares +=
        (reaction - project_on_cone(reaction - velocity, friction_coefficient)).squaredNorm();
  }
  return std::sqrt(squares);
}

}  // namespace faultsim
