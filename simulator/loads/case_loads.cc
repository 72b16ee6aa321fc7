#include "simulator/loads/case_loads.h"

#include <algorithm>
#include <cstdint>

#include "simulator/common/errors.h"

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

CaseLoads::CaseLoads(const Scene& scene, const FaultOperator& op, double noise,
                     const FieldHistory* field)
    : scene_(scene),
      op_(op),
      load_factors_(scene, op),
      initial_(initial_traction(scene, op.geometry, load_factors_.region_of_load())),
      noise_(noise),
      field_(field) {
  FAULTSIM_DEMAND(scene.has_field() == (field != nullptr), "the loads of the scene's field");
}

StepLoads CaseLoads::at(double time) const {
  StepLoads loads;
  loads.pressure_change = pressure_changes(scene_, time);
  loads.factors = load_factors_.at(time, loads.pressure_change);
  loads.locked = initial_.traction;
  const std::size_t n_condensed = op_.loads.traction.cols();
  for (std::size_t k = 0; k < std::min(n_condensed, loads.factors.size()); ++k) {
    if (loads.factors[k] != 0)
      loads.locked += loads.factors[k] * op_.loads.traction.col(static_cast<Eigen::Index>(k));
  }
  loads.fault_pressure_change = fault_pressure_change(
      scene_, op_.geometry, load_factors_.region_of_load(), time, loads.pressure_change);
  if (field_ != nullptr) {
    loads.locked += at_time(field_->time, field_->locked, time);
    loads.fault_pressure_change += at_time(field_->time, field_->fault_pressure, time);
    const Eigen::VectorXd regions = at_time(field_->time, field_->region_change, time);
    for (std::size_t r = 0; r < loads.pressure_change.size(); ++r)
      loads.pressure_change[r] += regions[static_cast<Eigen::Index>(r)];
    loads.observed = at_time(field_->time, field_->observed, time);
    loads.beside.resize(field_->beside_minus.rows(), 2);
    loads.beside.col(0) = at_time(field_->time, field_->beside_minus, time);
    loads.beside.col(1) = at_time(field_->time, field_->beside_plus, time);
  }
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
