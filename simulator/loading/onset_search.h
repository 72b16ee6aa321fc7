#pragma once

#include "simulator/loading/step_solver.h"
#include "simulator/measures/fault_neighbours.h"
#include "simulator/measures/metrics.h"
#include "simulator/measures/stage_summary.h"

namespace faultsim {

/// Finds where within a load step a fault begins to slide that slides at its end and not at its
/// start: by halving the load factors between which it begins, each half solved from the state at
/// its start. Loads are linear within a step, and so are pressures.
class OnsetSearch {
 public:
  /// A load step that was solved; of locked tractions and pressures. The states are those before.
  struct Step {
    const StepLoads& before;
    const StepLoads& after;
    const ContactState& start;
  };
  /// @param tolerance  Pa, wanted width of the bracket: of the pressure beside the fault where it
  ///                   begins, of either side and of the fluid in it.
  OnsetSearch(double tolerance, const FaultMeter& meter, const FaultNeighbours& neighbours,
              StepSolver& solver)
      : tolerance_(tolerance), meter_(meter), neighbours_(neighbours), solver_(solver) {}

  /// The onset with its bracket, depth and pressures at its end. A part without equilibrium, or a
  /// solver that has no parts, leaves the bracket as wide as it is by then: at most the step.
  /// @param began  as the end of the step has it. @param reference  the jump that slip counts from.
  FaultOnset narrowed(const Step& step, const StageSummary::Began& began, const FaultOnset& at_end,
                      const Eigen::VectorXd& reference) const;

  /// Those that begin in the step, of the whole history and of its stage.
  void narrow(const Step& step, StageSummary& whole, StageSummary& stage) const;

 private:
  double width(const Step& step, int place, double from, double to) const;
  SidePressures pressures(const Step& step, int place, double factor) const;

  double tolerance_;
  const FaultMeter& meter_;
  const FaultNeighbours& neighbours_;
  StepSolver& solver_;
};

}  // namespace faultsim
