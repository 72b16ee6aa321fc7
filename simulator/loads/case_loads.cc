#include "simulator/loads/case_loads.h"

#include <algorithm>
#include <cstdint>

#include "simulator/common/errors.h"
#include "simulator/loads/regional_stress.h"

namespace faultsim {
namespace {

/// ±1 without pattern: a bit of a mixed index (Steele, Lea and Flood, OOPSLA 2014).
double sign_of(std::uint64_t index) {
  std::uint64_t z = (index + 1) * 0x9e3779b97f4a7c15;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return (z >> 63) != 0 ? 1 : -1;
}

}  // namespace

PressureChanges between(const PressureChanges& before, const PressureChanges& after, double share) {
  PressureChanges there = after;
  for (std::size_t r = 0; r < there.pressure_change.size(); ++r) {
    const double start = before.pressure_change[r];
    there.pressure_change[r] = start + share * (after.pressure_change[r] - start);
  }
  there.fault_pressure_change =
      before.fault_pressure_change * (1 - share) + after.fault_pressure_change * share;
  there.beside = before.beside * (1 - share) + after.beside * share;
  return there;
}

CaseLoads::CaseLoads(const Scene& scene, const FaultOperator& op, const LoadSources& further,
                     double noise)
    : scene_(scene),
      op_(op),
      load_factors_(scene, op),
      initial_(initial_traction(scene, op.geometry, load_factors_.region_of_load())),
      sources_{std::make_shared<RegionalStress>(scene, op.geometry)},
      noise_(noise) {
  FAULTSIM_DEMAND(!scene.has_field() || !further.empty(), "the loads of the scene's field");
  sources_.insert(sources_.end(), further.begin(), further.end());
  has_forces_ =
      std::ranges::any_of(further, [](const auto& source) { return source->has_forces(); });
}

StepLoads CaseLoads::at(double time) const {
  StepLoads loads;
  loads.time = time;
  loads.locked = initial_.traction;
  loads.pressure_change = pressure_changes(scene_, time);
  if (scene_.has_temperatures()) loads.temperature_change = temperature_changes(scene_, time);
  loads.factors = load_factors_.at(time, loads.pressure_change);
  const Eigen::MatrixXd& unit = op_.loads.traction;
  for (Eigen::Index k = 0; k < std::min(unit.cols(), std::ssize(loads.factors)); ++k) {
    if (loads.factors[k] != 0) loads.locked += loads.factors[k] * unit.col(k);
  }
  loads.fault_pressure_change = fault_pressure_change(
      scene_, op_.geometry, load_factors_.region_of_load(), time, loads.pressure_change);
  for (const auto& source : sources_) source->add(time, loads);
  for (std::size_t f = 0; f < op_.geometry.faults.size(); ++f) {
    const OperatorFault& fault = op_.geometry.faults[f];
    for (int k = fault.first_node; k < fault.first_node + fault.n_nodes; ++k) {
      loads.locked[op_.geometry.nodes[k].dof[0]] +=
          scene_.faults[f].fault_biot * loads.fault_pressure_change[k];
    }
  }
  if (noise_ != 0) {
    for (Eigen::Index d = 0; d < loads.locked.size(); ++d) {
      loads.locked[d] *= 1 + noise_ * sign_of(static_cast<std::uint64_t>(d));
    }
  }
  return loads;
}

Eigen::VectorXd CaseLoads::forces_at(double time, Eigen::Index n_unknowns) const {
  if (!has_forces_) return {};
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(n_unknowns);
  for (const auto& source : sources_) source->add_forces(time, forces);
  return forces;
}

Eigen::VectorXd CaseLoads::forces(double from, double to, Eigen::Index n_unknowns) const {
  return has_forces_ ? forces_at(to, n_unknowns) - forces_at(from, n_unknowns) : Eigen::VectorXd();
}

void CaseLoads::check_fault_pressure(const LoadStep& step, const StepLoads& loads) const {
  const double slack = 1.0;  // Pa
  for (std::size_t f = 0; f < op_.geometry.faults.size(); ++f) {
    const FaultPressureRule rule = scene_.faults[f].pressure.rule;
    if (rule != FaultPressureRule::prescribed && rule != FaultPressureRule::table) continue;
    const OperatorFault& fault = op_.geometry.faults[f];
    for (int k = fault.first_node; k < fault.first_node + fault.n_nodes; ++k) {
      const double p = initial_.pressure[k] + loads.fault_pressure_change[k];
      if (p >= -slack) continue;
      throw InputError("scene",
                       {{concat("/faults/", f, "/fault_pressure"), 0,
                         concat("the given fault pressure of ", fault.name, " falls to ", p / 1e5,
                                " bar at depth ", -op_.geometry.nodes[k].position.z(),
                                " m in load step ", step.step),
                         "prescribe a smaller drop or a narrower depth window"}});
    }
  }
}

}  // namespace faultsim
