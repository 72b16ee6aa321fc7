#pragma once

#include <span>
#include <string>
#include <vector>

#include "simulator/measures/fault_neighbours.h"
#include "simulator/measures/metrics.h"
#include "simulator/result/result.h"

namespace faultsim {

/// Gathers StageMetrics while the steps of a stage (or of the whole case) go by.
class StageSummary {
 public:
  /// @param reference  jump at the start of the stage; empty = zero, as at the start of the case.
  StageSummary(std::string name, int first_step, Eigen::VectorXd reference, bool whole,
               bool plane_strain);
  /// @param nodal  of this state.
  /// @param now  at the end of the step.
  /// @param fault_names  in the order of the scene.
  /// @param events  of this step.
  void add(const StepResult& step, const FaultMeter& meter, const FaultNeighbours& neighbours,
           const NodalState& nodal, const ContactState& state, const PressureChanges& now,
           const std::vector<std::string>& fault_names, std::span<const SlipEvent> events);
  /// A fault that began to slide in the step added last, and its node of largest slip then.
  struct Began {
    int fault = 0, place = -1;
  };
  const std::vector<Began>& began() const { return began_; }
  /// The onset of such a fault.
  FaultOnset& onset(const Began& one) {
    return *metrics_.faults[static_cast<std::size_t>(one.fault)].activation;
  }
  /// The jump that slip of the stage counts from; empty = zero.
  const Eigen::VectorXd& reference() const { return reference_; }
  StageMetrics finish();

 private:
  void add_fault(const FaultMetrics& fault, const Activation& slip, FaultStageMetrics& sum) const;
  void count(const SlipEvent& event);

  StageMetrics metrics_;
  Eigen::VectorXd reference_;
  bool whole_;
  bool plane_strain_;
  std::vector<Began> began_;
  std::vector<char> surely_, doubtful_;  ///< per fault: activated for certain, in doubt, in a step.
};

/// Pa of further depletion to χ̄ = 1 for a case in which no fault slides or opens: χ̄ extrapolated
/// linearly in Δp of the most depleted region from step 0 through the step of largest χ̄. NaN when χ̄
/// does not grow.
double pressure_margin(std::span<const StepResult> steps);

}  // namespace faultsim
