#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

/// Closed forms of linear elasticity and poroelasticity that `faultsim verify` compares with. They
/// share no code with the simulator. SI, tension positive, pressure change positive when it rises.
///
/// Plane problems use the convention of their sources: y up from the fault's centre, θ the dip from
/// the horizontal, fault line x = y cot θ, S = sin θ, C = cos θ, normal n = (S, −C), up-dip
/// direction d = (C, S), σ_n = n·σ·n, τ = d·σ·n. The right block is the plus side.
namespace faultsim {

/// Normal and shear part of a traction on a plane.
struct PlaneTraction {
  double normal;      ///< t_N, Pa.
  double shear_norm;  ///< |t_T|, Pa.
};
/// Traction of a uniform stress on the plane with this unit normal.
PlaneTraction plane_traction(const Eigen::Matrix3d& stress, const Eigen::Vector3d& normal);

/// Uniaxial compaction coefficient c_m = (1−2ν)(1+ν)/(E(1−ν)), 1/Pa.
double uniaxial_compressibility(double youngs_modulus, double poisson_ratio);
/// γ_h = α(1−2ν)/(1−ν): Δσ_h = −γ_h Δp in a laterally confined layer.
double horizontal_stress_ratio(double poisson_ratio, double biot);

/// A thin depleted disc at depth D in a half space with a free surface (Geertsma 1973).
struct GeertsmaDisc {
  double youngs_modulus;  ///< Pa
  double poisson_ratio;
  double biot;
  double pressure_change;  ///< Pa
  double thickness;        ///< h, m
  double radius;           ///< R, m
  double depth;            ///< D, m, of the mid plane
};
/// Vertical displacement of the surface at distance r from the axis, m, positive up:
/// u_z = 2 c_m (1−ν) α Δp h R ∫₀^∞ exp(−Dk) J1(Rk) J0(rk) dk, by Simpson's rule (error < 1e-9).
double geertsma_surface_displacement(const GeertsmaDisc& disc, double distance);
/// The same at r = 0 in closed form: 2 c_m (1−ν) h α Δp (1 − C/√(1+C²)), C = D/R.
double geertsma_centre_displacement(const GeertsmaDisc& disc);

/// A reservoir cut by a fault with an offset, in a plane-strain full space: left block
/// −b < y < a, right block −a < y < b, a = (h−t)/2, b = (h+t)/2, both to infinity sideways.
struct DisplacedReservoir {
  double shear_modulus;  ///< G, Pa
  double poisson_ratio;
  double biot;
  double thickness;              ///< h, m
  double offset;                 ///< t, m: the right block is up by t
  double dip;                    ///< θ from the horizontal, rad
  double left_pressure_change;   ///< Pa
  double right_pressure_change;  ///< Pa
};
/// The heights between which the blocks lie beside the fault: −b to a and −a to b of a displaced
/// reservoir; others where the walls differ in thickness, or the throw exceeds them.
struct FaultBlocks {
  double left_base, left_top, right_base, right_top;  ///< y, m
};
FaultBlocks blocks_of(const DisplacedReservoir& reservoir);

struct FaultStressChange {
  double normal;  ///< Δσ_n, Pa
  double shear;   ///< Δτ, Pa, along d
};
/// Exact change of the fault's tractions while it is stuck, at height y: each block adds
/// −A [S² χ_B/2 + (SC/2π) L_B] and A [(S²/2π) L_B − SC χ_B/2], A = αΔp(1−2ν)/(1−ν),
/// L_left = ln|(y−a)/(y+b)|, L_right = ln|(y+a)/(y−b)|. Infinite at ±a, ±b.
FaultStressChange displaced_fault_stress(const DisplacedReservoir& reservoir, double y);
/// The same beside any two blocks: L_left = ln|(y − top)/(y − base)|, L_right with the other sign.
/// @param reservoir  its rock, dip and pressures.
FaultStressChange displaced_fault_stress(const DisplacedReservoir& reservoir,
                                         const FaultBlocks& blocks, double y);

/// Slip plateau for |y| < a of a vertical frictionless fault: α(1−2ν)|Δp|(b−a)/G, m; it falls
/// linearly to zero at ±b.
double frictionless_slip(const DisplacedReservoir& reservoir, double y);

/// A displaced fault that slips with constant friction in a linear initial state.
struct SlippingFault {
  DisplacedReservoir reservoir;
  double vertical_stress;           ///< σ_v at y = 0, Pa (total, negative)
  double vertical_stress_gradient;  ///< dσ_v/dy, Pa/m
  double pressure;                  ///< p0 at y = 0, Pa
  double pressure_gradient;         ///< dp0/dy, Pa/m
  double stress_ratio;              ///< σ'_h / σ'_v
  double initial_biot;              ///< α_0
  double fault_biot;                ///< α_f
  double fault_pressure_change;     ///< Δp_f where either side is depleted, Pa
  double friction_coefficient;      ///< μ, cohesion 0
  /// In place of those of thickness and offset.
  std::optional<FaultBlocks> blocks = std::nullopt;
  double beyond = 0;  ///< m of height above and below the blocks in which it may slip too.
};
/// Initial total tractions of the fault at height y.
FaultStressChange initial_fault_traction(const SlippingFault& fault, double y);

/// Slip along the fault, by boundary elements.
struct SlipProfile {
  std::vector<double> y;     ///< m, element centres, ascending
  std::vector<double> slip;  ///< m, > 0 with the plus side moving up-dip relative to the minus side
  double max_slip = 0;       ///< m, of |slip|
  double max_slip_y = 0;     ///< m, where
  double integral = 0;       ///< ∫|slip| ds along dip, m2
};
/// Constant-slip elements of at most the given height, from the lowest base to the highest top and
/// `beyond`, in a full space. A straight
/// fault's slip changes only its shear traction: element j with ends e_j, e_{j+1} along dip by
/// −G/(2π(1−ν)) δ_j [1/(s−e_j) − 1/(s−e_{j+1})] (edge dislocations at its ends), so Coulomb
/// friction is a linear complementarity problem, solved by an active set. First order in the
/// element height.
SlipProfile boundary_element_slip(const SlippingFault& fault, double element_height);

/// Friction that falls linearly with slip from μ of SlippingFault, and its onset of instability.
struct WeakeningOnset {
  double dynamic_coefficient;      ///< μ_d
  double slip_weakening_distance;  ///< d_c, m
};
/// The share of the pressure change, in (0, 1], up to which the same boundary elements have a
/// stable equilibrium: weakening subtracts N_i (μ − μ_d)/d_c from their diagonal stiffness, and
/// onset is where the matrix of what slips stops being positive definite. By bisection to 1e-8; 1
/// when it stays stable. Slip must stay below d_c up to there (InternalError).
double boundary_element_onset(const SlippingFault& fault, const WeakeningOnset& weakening,
                              double element_height);

/// Slip of a straight crack of half length b under uniform far stress, with friction, at distance s
/// from its centre (Phan 2003): 4(1−ν²)/E · σ sin ψ (cos ψ − sin ψ tan φ) √(b²−s²), m.
/// @param load  σ > 0: uniaxial compression at angle ψ to the crack, Pa.
double frictional_crack_slip(double youngs_modulus, double poisson_ratio, double load, double angle,
                             double friction_coefficient, double half_length, double s);

/// Slip of a penny-shaped shear crack with uniform stress drop: 8(1−ν)/(π(2−ν)) (ΔT/G) √(a²−r²), m.
double penny_crack_slip(double shear_modulus, double poisson_ratio, double stress_drop,
                        double radius, double r);
/// Its moment 16(1−ν)/(3(2−ν)) ΔT a³, N m.
double penny_crack_moment(double poisson_ratio, double stress_drop, double radius);

}  // namespace faultsim
