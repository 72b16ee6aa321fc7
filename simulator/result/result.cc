#include "simulator/result/result.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

bool plus_leads(const SidePressures& sides) {
  if (!sides.change_plus) return false;
  return !sides.change_minus || std::abs(*sides.change_plus) > std::abs(*sides.change_minus);
}

const FaultOnset* onset_on(const StageMetrics& stage, const std::string& fault,
                           std::optional<FaultOnset> FaultStageMetrics::*onset) {
  for (const FaultStageMetrics& one : stage.faults) {
    if (one.fault == fault && one.*onset) return &*(one.*onset);
  }
  return nullptr;
}

}  // namespace

void CaseCoupled::add(const StepCoupled& step) {
  for (const int n : step.krylov_iterations) {
    krylov_iterations += n;
    most_krylov_iterations = std::max(most_krylov_iterations, n);
  }
  setup_seconds += step.setup_seconds;
  solve_seconds += step.solve_seconds;
}

std::optional<double> leading_change(const SidePressures& sides) {
  return plus_leads(sides) ? sides.change_plus : sides.change_minus;
}
std::optional<double> leading_absolute(const SidePressures& sides) {
  return plus_leads(sides) ? sides.absolute_plus : sides.absolute_minus;
}

const FaultOnset* first_activation(const StageMetrics& stage) {
  return onset_on(stage, stage.activated_fault, &FaultStageMetrics::activation);
}
const FaultOnset* first_opening(const StageMetrics& stage) {
  return onset_on(stage, stage.opened_fault, &FaultStageMetrics::opening);
}

std::optional<double> moment_magnitude(double moment) {
  if (!(moment > 0) || !std::isfinite(moment)) return std::nullopt;
  return (2.0 / 3.0) * (std::log10(moment) - 9.1);
}

}  // namespace faultsim
