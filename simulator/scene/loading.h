#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "simulator/flow/mapping_rules.h"
#include "simulator/scene/scene_key.h"

/// What loads a scene: its stages, the histories of its compartments, the results of flow
/// simulators. In SI, as all of a scene (scene.h).
namespace faultsim {

struct FlowField;

/// Raised by hand when a change of how flow results are read or mapped may alter results with them,
/// and no others.
inline constexpr int kFieldMethod = 3;
constexpr auto words(OutsideRule) { return std::array{"nearest", "unchanged"}; }
constexpr auto words(IntegralRule) { return std::array{"mapped", "flow_grid"}; }

/// One named stage of the loading; steps are equal in time unless times are given.
struct Stage {
  std::string name;
  double duration = 0;  ///< s.
  int n_steps = 1;
  /// Change of the regional stress since the start, reached linearly at the stage's end: total,
  /// tension > 0, rows x y z, Pa; none: as at its start.
  std::optional<std::array<double, 9>> stress_change = {};
  bool operator==(const Stage&) const = default;
};
void for_each_key(Of<Stage> auto& s, auto&& visit) {
  visit({"name"}, s.name);
  visit({"duration", kByHand}, s.duration);
  visit({"steps"}, s.n_steps);
  visit({"stress_change"}, s.stress_change);
}

/// Pressure change history of one compartment or region: piecewise linear in time from 0 at t = 0.
struct PressureHistory {
  std::string region;
  std::vector<double> time;             ///< s, strictly increasing, first > 0 or = 0.
  std::vector<double> pressure_change;  ///< Pa, Δp.
  double scale = 1;                     ///< multiplies Δp.
  double lag = 0;                       ///< s, ≥ 0: Δp(t) = scale · history(t − lag).
  bool from_csv = false;  ///< a CSV file replaced what the stages say; for messages only.
  bool operator==(const PressureHistory&) const = default;
};
/// A compartment; its history is what the stages or a CSV file say.
void for_each_key(Of<PressureHistory> auto& h, auto&& visit) {
  visit({"region", kByHand}, h.region);
  visit({"time", kByHand}, h.time);
  visit({"pressure_change", kByHand}, h.pressure_change);
  visit({"scale"}, h.scale);
  visit({"lag"}, h.lag);
}

/// Temperature change history of one region: piecewise linear in time from 0 at t = 0.
struct TemperatureHistory {
  int region = 0;              ///< index into Scene::pressure.
  std::vector<double> time;    ///< s, strictly increasing.
  std::vector<double> change;  ///< K, ΔT.
  bool operator==(const TemperatureHistory&) const = default;
};

/// The result of a flow simulator as a load: pressures or temperatures of all regions, cell by
/// cell.
struct FlowLoad {
  std::shared_ptr<const FlowField> field = nullptr;  ///< none: the regions have histories.
  std::string fingerprint;                           ///< of the file's bytes.
  OutsideRule outside = OutsideRule::nearest;
  IntegralRule integral = IntegralRule::mapped;
  std::array<double, 2> origin = {0, 0};  ///< m, of the scene in the field's coordinates.
  double azimuth = 0;                     ///< rad, of the scene's y there, from y clockwise.
  double y = 0;                           ///< m, of the section of plane strain; else 0.
  bool outside_given = false;  ///< whether the scene says `outside`: never part of its identity.
  int reference = 0;           ///< report whose values are the initial ones, of change 0.
  /// The reports that are taken, from the reference on, and their times since the scene's start, s:
  /// strictly increasing, the first >= 0. The field is linear in between.
  std::vector<int> reports;
  std::vector<double> time;
  /// asymmetry() of the field about the scene's y = 0, where half of a domain may be modelled;
  /// follows from the rest.
  std::optional<double> asymmetry = {};
  bool is_given() const { return field != nullptr; }
  /// Whether it is its own mirror image, but for rounding of its values.
  bool is_symmetric() const { return asymmetry && *asymmetry <= 1e-9; }
  /// Fields are told by their fingerprints.
  bool operator==(const FlowLoad& other) const {
    return fingerprint == other.fingerprint && outside == other.outside &&
           integral == other.integral && origin == other.origin && azimuth == other.azimuth &&
           y == other.y && reference == other.reference && reports == other.reports &&
           time == other.time;
  }
};
/// Which file it was does not matter, what was in it does.
void for_each_key(Of<FlowLoad> auto& l, auto&& visit) {
  visit({"method", kByHand}, kFieldMethod);
  visit({"outside"}, l.outside);
  visit({"integral", unless(l.integral != IntegralRule::mapped, kSilent)}, l.integral);
  visit({"origin"}, l.origin);
  visit({"azimuth"}, l.azimuth);
  visit({"y", kByHand}, l.y);
  visit({"file", kByHand, "fingerprint"}, l.fingerprint);
  visit({"reference", kByHand}, l.reference);
  visit({"reports", kByHand}, l.reports);
  visit({"time", kByHand}, l.time);
}

/// The field in the scene's coordinates. @pre it is given.
std::shared_ptr<const FlowField> field_in_scene(const FlowLoad& load);

}  // namespace faultsim
