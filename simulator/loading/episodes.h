#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "simulator/loading/metrics.h"
#include "simulator/output/result.h"

namespace faultsim {

/// Gathers the activation episodes of each fault while the steps go by. An episode is a run of
/// consecutive load steps of one stage in which the fault slips or is open; it counts when the slip
/// within it meets the activation criterion.
class EpisodeTracker {
 public:
  EpisodeTracker(const FaultMeter& meter, std::vector<std::string> fault_names, bool plane_strain);
  /// @param before  jump at the start of the step.
  void add(const StepResult& step, const ContactState& state, const Eigen::VectorXd& before);
  /// Ends the episodes under way. @returns all, in order of their first step, then of faults.
  std::vector<Episode> finish();

 private:
  struct Running {
    Episode episode;
    Eigen::VectorXd reference;  ///< jump at its start.
    bool activated = false;
  };
  void close(std::optional<Running>& running);

  const FaultMeter& meter_;
  std::vector<std::string> names_;
  bool plane_strain_;
  std::string stage_;
  double lowest_pressure_ = 0;                   ///< Pa, Δp of the most depleted region so far.
  std::vector<std::optional<Running>> running_;  ///< per fault.
  std::vector<Episode> done_;
};

/// An activation after pressure had recovered that follows one on the way down: what a user of
/// gas storage does not expect.
bool unexpected_reactivation(std::span<const Episode> episodes);

}  // namespace faultsim
