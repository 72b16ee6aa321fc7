#include "simulator/coupled_case/path_choice.h"

#include "simulator/common/text.h"

namespace faultsim {
namespace {

std::string gigabytes(double bytes) { return formatted("%.2g GB", bytes / 1e9); }

}  // namespace

double coupled_bytes(const Plan& plan, bool by_columns) {
  const auto n_unknowns = static_cast<double>(plan.n_unknowns);
  // results/solver-study: 4.1 and 3.8 kB in histories of 77,682 and 1,019,133 unknowns in which
  // faults slip; 5.0 and 5.1 where all stick and systems are solved to 1e-8 (more vectors).
  constexpr double kPerUnknown = 5e3;
  if (!by_columns) return kPerUnknown * n_unknowns;
  // 3.6 kB in 15 minutes of rotliegend-weakening at demonstration (77,682 unknowns).
  constexpr double kStuck = 4e3;   // no multipliers, one matrix for the whole history
  constexpr double kMoving = 0.5;  // of the jumps
  const auto n_jump = static_cast<double>(plan.n_jump);
  return kStuck * n_unknowns + 8 * kMoving * n_jump * n_jump;
}

PathChoice choose_path(const Plan& plan, std::optional<double> available,
                       const std::vector<Problem>& hindrances, bool by_columns) {
  const std::string needs =
      concat("the condensed operator needs about ", gigabytes(plan.memory_bytes));
  if (!available) {
    return {SolutionPath::condensed, needs + ", and the available memory is not known"};
  }
  const std::string there = concat(" of ", gigabytes(*available));
  if (plan.memory_bytes <= *available) {
    return {SolutionPath::condensed, needs + there + ", and all load steps share it"};
  }
  if (!hindrances.empty()) {
    return {SolutionPath::condensed,
            needs + there + "; the coupled path cannot take the scene: " + hindrances.front().what};
  }
  const double coupled = coupled_bytes(plan, by_columns);
  if (coupled > *available)
    return {SolutionPath::condensed,
            concat(needs, there, ", the coupled path ", gigabytes(coupled))};
  const char* how = by_columns ? ", which solves for the columns of what moves," : "";
  return {SolutionPath::coupled,
          concat(needs, there, "; the coupled path", how, " needs about ", gigabytes(coupled))};
}

}  // namespace faultsim
