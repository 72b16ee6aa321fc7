#pragma once

#include <optional>
#include <string>
#include <vector>

#include "campaign/answers/sensitivity.h"
#include "campaign/render/answer.h"

namespace faultsweep {

/// A case that differs from the base case in one parameter.
struct Move {
  std::size_t parameter = 0;  ///< of OneAtATime::parameters.
  std::string value;          ///< of it, as given.
  long position = 0;          ///< of the case.
  bool is_unresolved = false;
  std::vector<double> metrics;  ///< SI; NaN = no history to its end, or no value.
};

/// A base case and the cases that differ from it in one parameter each, in the order of the design.
struct Tornado {
  std::string group;  ///< "" where the campaign has one.
  Move base;          ///< without a parameter.
  std::vector<Move> moves;
  long n_without = 0;  ///< moves without a history to its end.
  long n_unplaced =
      0;  ///< rows left out: cases of another group that differ in several parameters.
};

/// What each parameter alone changes.
struct OneAtATime {
  CampaignInfo campaign;
  SensitivityRequest request;
  std::vector<std::string> parameters;
  std::vector<ScopedMetric> outputs;
  std::vector<Tornado> tornados;          ///< of groups whose base case has a history to its end.
  std::vector<std::string> without_base;  ///< the other groups of such a design, by name.
  long n_other_groups = 0;                ///< of other designs: not looked at.
  bool plane_strain = false;
};

/// Nothing where no group of the campaign is a design one-at-a-time. Throws InputError where no
/// base case has a history to its end, or cases are selected.
std::optional<OneAtATime> compare_one_at_a_time(const Store& store, const CampaignInfo& campaign,
                                                const SensitivityRequest& request);

/// Table `moves`, a row for each group, metric and case; on the screen `swings`, a row for each
/// metric and parameter, the widest swing first, and charts of them.
Answer to_answer(const OneAtATime& found);

}  // namespace faultsweep
