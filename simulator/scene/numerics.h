#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "simulator/laws/maxwell.h"
#include "simulator/scene/geometry.h"

/// How a scene is solved: knobs of its numerics, and operators that are interpolated.
namespace faultsim {

/// Raised by hand when a change may alter results on surfaces, and no others.
inline constexpr int kSurfaceMethod = 6;

/// What becomes of the turning points of histories that lie within the steps of a stage.
enum class TurningPoints {
  steps,   ///< each becomes the end of a load step.
  report,  ///< they are skipped, and the case is warned about.
};
constexpr auto words(TurningPoints) { return std::array{"steps", "report"}; }

constexpr auto words(MaxwellScheme) { return std::array{"exponential", "backward_euler"}; }

/// A parameter in which a surface of operators is continuous, and its range.
struct SurfaceParameter {
  enum class Kind { youngs_modulus, poisson_ratio, dip, offset };
  Kind kind = Kind::youngs_modulus;
  int index = 0;            ///< into Scene::materials, Scene::faults or FieldGeometry::blocks.
  double from = 0, to = 0;  ///< Pa, 1, rad or m; from < to.
  bool operator==(const SurfaceParameter&) const = default;
};

/// Cases that are run on a surface and on exact operators at its check points: it is fine enough
/// when they are alike. Texts of the scene's document (reading/surface_probes.h).
struct SurfaceProbes {
  double tolerance = 3e-3;  ///< in χ̄.
  /// Fingerprint of the cases, and of all in the document that neither they nor the surface's
  /// parameters replace: the surface depends on it.
  std::string cases;
  bool operator==(const SurfaceProbes&) const = default;
};
void for_each_key(Of<SurfaceProbes> auto& p, auto&& visit) {
  visit({"tolerance"}, p.tolerance);
  visit({"cases", kByHand}, p.cases);
}

/// Operators interpolated over parameters in place of exact ones (simulator/surface). Without
/// parameters: none.
struct SurfaceRequest {
  std::vector<SurfaceParameter> over;
  double tolerance = 1e-3;                   ///< relative, at check points.
  int most_operators = 300;                  ///< nodes at most.
  std::optional<SurfaceProbes> probes = {};  ///< none: `tolerance` alone says what is fine enough.
  bool wanted() const { return !over.empty(); }
  bool operator==(const SurfaceRequest&) const = default;
};
void for_each_key(Of<SurfaceRequest> auto& s, auto&& visit) {
  visit({"over", kByHand}, s.over);
  visit({"method", kByHand}, kSurfaceMethod);
  visit({"tolerance"}, s.tolerance);
  visit({"most_operators"}, s.most_operators);
  visit({"probes", kByHand}, s.probes);
}

/// Knobs of the numerics that are part of a case's identity (those of creep only where something
/// is made of viscous material).
struct Numerics {
  double slip_tolerance = 1e-4;      ///< m, of `activated`.
  double activation_length = 40;     ///< m, of `activated` and χ̄.
  double activation_tolerance = 0;   ///< Pa, to which a first sliding is located in its load step;
                                     ///< 0 = it counts as at the step's end.
  double traction_tolerance = 1e-8;  ///< relative to the local traction level.
  int max_newton_iterations = 30;
  int max_active_set_passes = 100;
  int max_step_cuts = 6;
  bool follow_events = true;        ///< false: a case ends where equilibrium jumps.
  double onset_tolerance = 2.5e-4;  ///< of a load step, to which the onset of an event is located.
  int max_events = 256;             ///< per load step.
  TurningPoints turning_points = TurningPoints::steps;
  int max_added_steps = 1000;  ///< more than that at turning points are refused.
  bool b_bar = true;
  Switch half_domain = Switch::automatic;  ///< field: symmetry about y = 0.
  Switch plane_strain = Switch::off;       ///< one cell in y, front and back tied, u_y = 0.
  Switch creep = Switch::automatic;        ///< of viscous materials; off: they are elastic.
  double creep_time_step = 0;    ///< s, longest step of creep; 0 = found by error control.
  int creep_refinements = 1;     ///< error control: how often a load step may be halved, 0 to 6;
                                 ///< not given: 4 in plane strain, 1 in 3D.
  double creep_tolerance = 2e4;  ///< Pa, largest difference of fault traction between one step of
                                 ///< creep and two of half its length that is accepted.
  MaxwellScheme creep_scheme = MaxwellScheme::exponential;
  SurfaceRequest surface;
  bool operator==(const Numerics&) const = default;
};
/// What creeps is told by the keys of for_each_creep_key besides.
void for_each_key(Of<Numerics> auto& n, auto&& visit) {
  visit({"slip_tolerance"}, n.slip_tolerance);
  visit({"activation_length"}, n.activation_length);
  visit({"activation_tolerance", unless(n.activation_tolerance > 0, kSilent)},
        n.activation_tolerance);
  visit({"traction_tolerance"}, n.traction_tolerance);
  visit({"max_newton_iterations"}, n.max_newton_iterations);
  visit({"max_active_set_passes"}, n.max_active_set_passes);
  visit({"max_step_cuts"}, n.max_step_cuts);
  visit({"follow_events"}, n.follow_events);
  visit({"onset_tolerance"}, n.onset_tolerance);
  visit({"max_events"}, n.max_events);
  // The added steps follow from stages and histories, which are there.
  visit({"turning_points", unless(n.turning_points == TurningPoints::report, kSilent) | kWord},
        n.turning_points);
  visit({"max_added_steps", kSilent}, n.max_added_steps);
  visit({"b_bar"}, n.b_bar);
  visit({"half_domain"}, n.half_domain);
  visit({"plane_strain"}, n.plane_strain);
}

void for_each_creep_key(Of<Numerics> auto& n, auto&& visit) {
  visit({"creep", 0, "switch"}, n.creep);
  visit({"creep_time_step", 0, "time_step"}, n.creep_time_step);
  visit({"creep_refinements", 0, "refinements"}, n.creep_refinements);
  visit({"creep_tolerance", 0, "tolerance"}, n.creep_tolerance);
  visit({"creep_scheme", 0, "scheme"}, n.creep_scheme);
}

/// Points at which the error of a surface is measured.
inline int n_surface_checks(const SurfaceRequest& surface) {
  return 4 + 2 * static_cast<int>(surface.over.size());
}

}  // namespace faultsim
