#pragma once

namespace faultsim {

enum class MaxwellScheme {
  exponential,     ///< exact for a constant strain rate within the step (docs/model.md, 13).
  backward_euler,  ///< first order; kept to measure what the other gains.
};

/// A Maxwell material over one time step Δt: deviatoric stress s and strain e (tensor components)
/// obey ė = ṡ/2G + s/2η (factor convention ε̇_v = s/2η), with τ = η/G and x = Δt/τ as
///
///   s_{n+1} = decay s_n + 2 G shear_factor (e_{n+1} − e_n). (docs/model.md, 13)
///
/// exponential: decay = e^{−x}, shear_factor = (1 − e^{−x})/x; backward Euler: both 1/(1 + x).
/// Source: the exponential integrator of linear viscoelasticity with one relaxation time, Simo &
/// Hughes, Computational Inelasticity (1998), section 10.3.
struct MaxwellStep {
  double decay = 1;         ///< of the deviator that was there, in [0, 1].
  double relaxed = 0;       ///< 1 − decay, without cancellation.
  double shear_factor = 1;  ///< of the shear modulus that acts in the step, in (0, 1].
};

/// @param shear_modulus  G, Pa, > 0.
/// @param viscosity      η, Pa s, > 0; infinite = elastic.
/// @param duration       Δt, s, ≥ 0; 0 = instantaneous, elastic.
MaxwellStep maxwell_step(double shear_modulus, double viscosity, double duration,
                         MaxwellScheme scheme);

}  // namespace faultsim
