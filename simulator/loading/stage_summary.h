#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "simulator/loading/metrics.h"
#include "simulator/output/result.h"

namespace faultsim {

/// Gathers StageMetrics while the steps of a stage (or of the whole case) go by.
class StageSummary {
 public:
  /// @param reference  jump at the start of the stage; nullptr = the start of the case.
  StageSummary(std::string name, int first_step, const Eigen::VectorXd* reference, bool whole,
               bool plane_strain);
  /// @param fault_names  to name the first fault activated.
  /// @param events  of this step.
  void add(const StepResult& step, const FaultMeter& meter, const ContactState& state,
           const std::vector<std::string>& fault_names, std::span<const SlipEvent> events);
  StageMetrics finish();

 private:
  StageMetrics metrics_;
  std::optional<Eigen::VectorXd> reference_;
  bool whole_;
  bool plane_strain_;
};

/// Pa of further depletion to χ̄ = 1 for a case that never activated: χ̄ extrapolated linearly in Δp
/// of the most depleted region from step 0 through the step of largest χ̄. NaN when χ̄ does not grow.
double pressure_margin(std::span<const StepResult> steps);

}  // namespace faultsim
