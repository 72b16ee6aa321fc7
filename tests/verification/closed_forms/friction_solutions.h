#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

/// Closed forms of faults under friction: initial state, onset of slip, spring and slider. They
/// share no code with the simulator. SI; normal stresses N here are positive in compression.
namespace faultsim {

/// Initial critical index of a plane dipping β from the vertical in effective stresses σ'_h = M
/// σ'_v, cohesion 0: χ0 = (1−M) sin β cos β / ((M cos²β + sin²β) tan φ).
double initial_critical_index(double stress_ratio, double dip_from_vertical, double friction_angle);

/// A through-going fault in a laterally infinite reservoir without offset; cohesion 0.
struct UniformDepletion {
  double effective_vertical_stress;    ///< σ'_v > 0, Pa, compression
  double effective_horizontal_stress;  ///< σ'_h > 0, Pa
  double dip_from_vertical;            ///< rad
  double friction_angle;               ///< rad
  double biot;
  double fault_biot;
  double poisson_ratio;
};
struct FaultLoad {
  double normal;  ///< N, effective, > 0 in compression, Pa
  double shear;   ///< τ, Pa
};
/// N = N0 − Δp(α_f − γ_h S²), τ = τ0 − Δp γ_h S C (θ = 90° − β).
FaultLoad fault_load(const UniformDepletion& state, double pressure_change);
/// Depletion > 0 at which τ = μN: (μN0 − τ0)/(γ_h S C − μ(α_f − γ_h S²)), Pa; may be < 0 (never).
double critical_depletion(const UniformDepletion& state);

/// A block on a spring k per area under constant normal stress N; friction weakens linearly with
/// slip, either the coefficient or the angle.
struct Slider {
  double stiffness;                ///< k, Pa/m
  double normal_stress;            ///< N > 0, Pa
  double static_friction_angle;    ///< rad
  double dynamic_friction_angle;   ///< rad
  double slip_weakening_distance;  ///< d_c, m
  bool weakens_angle;              ///< else the coefficient
};
/// N tan φ(d), Pa.
double slider_strength(const Slider& slider, double slip);
/// Spring displacement at which slip starts: N tan φ_s / k, m.
double slider_onset(const Slider& slider);
/// Smallest d_c with a continuous path: N sec²φ_s Δφ/k (angle) or N Δμ/k (coefficient), m.
double slider_critical_distance(const Slider& slider);
/// The root d ≥ 0 of k(u − d) = N tan φ(d) by bisection, 0 before onset: the slip when u grows from
/// 0. It is the only root when d_c exceeds slider_critical_distance.
double slider_slip(const Slider& slider, double u);

/// Slip after each of the spring displacements in turn, constant friction: stick until |k(u − d)| =
/// N μ.
struct SliderPath {
  std::vector<double> slip;  ///< m, signed
  double dissipated = 0;     ///< Σ strength |Δd|, J/m2
};
SliderPath slider_path(const Slider& slider, const std::vector<double>& u);

/// A contact problem of solvers of the form u = W r + q, r in the Coulomb cone (normal first per
/// contact): the residual |r − P_K(r − (u + μ|u_t| e_n))| over all contacts, 0 for a solution.
double cone_residual(const Eigen::MatrixXd& w, const Eigen::VectorXd& q,
                     double friction_coefficient, const Eigen::VectorXd& r);

}  // namespace faultsim
