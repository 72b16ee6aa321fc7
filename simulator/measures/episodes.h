#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "simulator/measures/fault_neighbours.h"
#include "simulator/measures/metrics.h"
#include "simulator/result/result.h"

namespace faultsim {

/// Gathers the episodes of each fault while the steps go by (docs/words.md). An episode is a run of
/// consecutive load steps in which the fault slips or is open; it ends with its stage and where the
/// pressure of the fault begins to recover, and it counts when the slip within it meets the
/// activation criterion.
///
/// The pressure of a fault is that of the most depleted of the regions that touch it (of all
/// regions where none does; of a field the region's mean); it has recovered while it is above the
/// lowest that it had before, and that was below the initial one.
class EpisodeTracker {
 public:
  /// @pre meter and neighbours outlive this.
  EpisodeTracker(const FaultMeter& meter, const FaultNeighbours& neighbours,
                 std::vector<std::string> fault_names, bool plane_strain);
  /// @param nodal  of this state.
  /// @param before  jump at the start of the step.
  /// @param now  at the end of the step.
  void add(const StepResult& step, const NodalState& nodal, const ContactState& state,
           const Eigen::VectorXd& before, const PressureChanges& now);
  /// Ends the episodes under way. @returns all, in order of their first step, then of faults.
  std::vector<Episode> finish();

 private:
  struct Running {
    Episode episode;
    Eigen::VectorXd reference;  ///< jump at its start; empty = zero.
    PressureChanges pressure;   ///< at the end of its first step.
    int place = -1;             ///< node of its largest slip; -1 = not activated.
  };
  void close(std::size_t fault);

  const FaultMeter& meter_;
  const FaultNeighbours& neighbours_;
  std::vector<std::string> names_;
  bool plane_strain_;
  std::string stage_;
  std::vector<double> lowest_;                         ///< Pa, pressure of each fault so far.
  std::vector<std::optional<Running>> running_;        ///< per fault.
  std::vector<std::pair<std::size_t, Episode>> done_;  ///< with the fault's index.
};

/// The first episode after recovery of a fault that has an earlier one from before its recovery:
/// what a user of gas storage does not expect. Other faults do not count: it is the slip before
/// that turned the stress which the recovery now loads the other way.
std::optional<Reactivation> unexpected_reactivation(std::span<const Episode> episodes);

}  // namespace faultsim
