#include "simulator/loading/warnings.h"

#include <algorithm>

#include "simulator/common/errors.h"
#include "simulator/common/text.h"
#include "simulator/initial_state/initial_state.h"
#include "simulator/loading/pressure_warnings.h"
#include "simulator/loads/history.h"

namespace faultsim {
namespace {

/// A number for people.
std::string brief(double value) { return formatted("%.4g", value); }

std::string place(const Eigen::Vector3d& p) {
  return "(" + brief(p.x()) + ", " + brief(p.y()) + ", " + brief(p.z()) + ") m";
}

class Warnings {
 public:
  Warnings(const Scene& scene, const FaultOperator& op, const FaultMeter& meter,
           const CaseResult& result)
      : scene_(scene), op_(op), meter_(meter), result_(result) {}

  std::vector<std::string> all() {
    for (const Remark& remark : scene_.remarks) texts_.push_back(remark_text(remark));
    prescribed_nowhere();
    neglected_weight();
    for (std::string& text : pressure_warnings(scene_)) texts_.push_back(std::move(text));
    held_closed();
    moved_observations();
    short_faults();
    start_beyond_strength();
    unresolved_weakening();
    open_with_partial_biot();
    activated_at_an_edge();
    creep_too_coarse();
    penetration();
    without_strength();
    return std::move(texts_);
  }

 private:
  /// A window, or the region beside a fault, that falls between its nodes.
  void prescribed_nowhere() {
    for (std::size_t f = 0; f < scene_.faults.size(); ++f) {
      const FaultPressure& law = scene_.faults[f].pressure;
      if (law.rule != FaultPressureRule::prescribed || law.prescribed == 0) continue;
      if (prescribed_pressure_acts(scene_, op_.geometry, f) || said_of_pressure()) continue;
      texts_.push_back("the prescribed pressure of fault " + scene_.faults[f].name +
                       " has no effect: it acts on none of the fault's nodes");
    }
  }

  /// The scene itself told that a prescribed pressure reaches no fault.
  bool said_of_pressure() const {
    return std::ranges::any_of(scene_.remarks, [](const Remark& remark) {
      return remark.pointer.ends_with("/prescribed") || remark.pointer.ends_with("/depth_window");
    });
  }

  void neglected_weight() {
    const double difference = neglected_weight_difference(scene_);
    if (difference <= 0) return;
    texts_.push_back(
        "columns of different weight start from one reference column: a weight difference of "
        "up to " +
        brief(difference / 1e5) + " bar is left out of the initial stress");
  }

  void held_closed() {
    const auto& held = op_.geometry.locked_positions;
    if (held.empty()) return;
    texts_.push_back(concat(held.size(),
                            " fault nodes are held closed by a boundary, the first at ",
                            place(held.front())));
  }

  void moved_observations() {
    const bool is_field = scene_.geometry_kind == GeometryKind::field;
    const double extent = is_field ? scene_.field.width : scene_.box.to[0] - scene_.box.from[0];
    const double near = extent / 1000;
    const auto& points = scene_.output.observation_points;
    for (std::size_t i = 0; i < std::min(points.size(), op_.observed.rows.size() / 3); ++i) {
      const Eigen::Vector3d asked(points[i].position.data());
      const Eigen::Vector3d& node = op_.observed.rows[3 * i].position;
      Eigen::Vector3d way = node - asked;
      if (op_.geometry.plane_strain) way.y() = 0;
      if (way.norm() <= near) continue;
      texts_.push_back("observation point " + points[i].name + " is taken at the mesh node " +
                       place(node) + ", " + brief(way.norm()) + " m away");
    }
  }

  void short_faults() {
    const double needed = scene_.numerics.activation_length;
    for (std::size_t f = 0; f < scene_.faults.size(); ++f) {
      const double length = meter_.down_dip_length(static_cast<int>(f));
      if (length >= needed) continue;
      texts_.push_back("fault " + scene_.faults[f].name + " extends " + brief(length) +
                       " m down dip, less than the activation_length of " + brief(needed) +
                       " m: it cannot be counted as sliding");
    }
  }

  void start_beyond_strength() {
    if (result_.steps.empty()) return;
    const int n = result_.steps.front().n_slip + result_.steps.front().n_open;
    if (n == 0) return;
    texts_.push_back(concat("the initial stress is beyond the strength of ", n,
                            " fault nodes; they were equilibrated in step 0"));
  }

  void unresolved_weakening() {
    if (result_.weakening_resolved) return;
    texts_.push_back("slip weakening is not resolved: cells are " +
                     brief(result_.max_nucleation_ratio) +
                     " times the nucleation length, 1/3 is needed");
  }

  void open_with_partial_biot() {
    const bool opened =
        std::ranges::any_of(result_.steps, [](const StepResult& step) { return step.n_open > 0; });
    const bool partial = std::ranges::any_of(
        scene_.faults, [](const Fault& fault) { return fault.fault_biot != 1; });
    if (!opened || !partial) return;
    texts_.push_back(
        "a fault opened although fault_biot < 1: an open fault then carries only the share "
        "fault_biot of its fluid pressure");
  }

  void activated_at_an_edge() {
    std::vector<char> told(result_.fault_names.size(), 0);
    for (const StepResult& step : result_.steps) {
      for (std::size_t f = 0; f < step.faults.size(); ++f) {
        if (!step.faults[f].activated_at_edge || told[f]) continue;
        told[f] = 1;
        texts_.push_back(concat(
            "fault ", result_.fault_names[f], " slides up to its edge in load step ", step.step,
            " (", brief(step.faults[f].activated_area), result_.plane_strain ? " m2/m" : " m2",
            "): slip might go on beyond; make the fault longer"));
      }
    }
  }

  void creep_too_coarse() {
    int n_steps = 0;
    double worst = 0;
    for (const StepResult& step : result_.steps) {
      if (!step.creep || step.creep->time_resolved) continue;
      ++n_steps;
      worst = std::max(worst, step.creep->time_error);
    }
    if (n_steps == 0) return;
    if (scene_.numerics.creep_time_step > 0) {  // fixed steps: no error was estimated
      texts_.push_back(concat("a fault jumps while the salt creeps in ", n_steps,
                              " load steps, whose loads were then applied at once; shorten "
                              "/numerics/creep_time_step"));
      return;
    }
    texts_.push_back(concat("the time steps of creep are too long in ", n_steps,
                            " load steps: halving them changes fault tractions by up to ",
                            brief(worst / 1e6), " MPa, ",
                            brief(scene_.numerics.creep_tolerance / 1e6),
                            " MPa are allowed, or a fault jumps while the salt creeps, or only the "
                            "shortest steps have an answer; raise /numerics/creep_refinements or "
                            "use shorter load steps"));
  }

  void penetration() {
    constexpr double kSmall = 1e-9;  // m
    if (result_.max_penetration <= kSmall) return;
    texts_.push_back("the sides of a fault overlap by up to " + brief(result_.max_penetration) +
                     " m: tighten /numerics/traction_tolerance");
  }

  void without_strength() {
    for (const Fault& fault : scene_.faults) {
      const CoulombLaw& friction = fault.friction;
      if (friction.cohesion > 0 || friction.static_friction_angle > 0) continue;
      texts_.push_back("fault " + fault.name +
                       " has neither friction nor cohesion: it slips under any shear, and its "
                       "critical index is relative to a strength of 1 kPa");
    }
  }

  const Scene& scene_;
  const FaultOperator& op_;
  const FaultMeter& meter_;
  const CaseResult& result_;
  std::vector<std::string> texts_;
};

}  // namespace

std::vector<std::string> case_warnings(const Scene& scene, const FaultOperator& op,
                                       const FaultMeter& meter, const CaseResult& result) {
  return Warnings(scene, op, meter, result).all();
}

std::string surface_warning(const CaseSurface& surface) {
  const std::string stability =
      surface.stability ? ", the weakening at which faults jump by " + brief(*surface.stability)
                        : std::string();
  const std::string cases =
      surface.chi_bar
          ? concat("; in ", surface.n_cases, " cases there χ̄ is off by up to ",
                   brief(*surface.chi_bar), ", the largest slip by ", brief(*surface.largest_slip),
                   " of the case's, and ", *surface.flags_that_differ, " flags differ")
          : std::string();
  return concat("the operator is interpolated between ", surface.n_operators, " exact ones (",
                surface.n_basis, " columns): at ", surface.n_checks,
                " check points H is off by up to ", brief(surface.stiffness),
                ", locked tractions by ", brief(surface.traction), ", slip without friction by ",
                brief(surface.slip), stability, " (relative)", cases,
                "; faultsim run --exact uses the exact one");
}

}  // namespace faultsim
