#include "simulator/coupled_case/path_choice.h"

#include "simulator/common/text.h"

namespace faultsim {
namespace {

std::string gigabytes(double bytes) { return formatted("%.2g GB", bytes / 1e9); }

}  // namespace

double coupled_bytes(const Plan& plan) {
  constexpr double kPerUnknown = 9e3;  // where faults slip; 6 where all stick
  return kPerUnknown * static_cast<double>(plan.n_unknowns);
}

PathChoice choose_path(const Plan& plan, std::optional<double> available,
                       const std::vector<Problem>& hindrances) {
  const std::string needs =
      concat("the condensed operator needs about ", gigabytes(plan.memory_bytes));
  if (!available) {
    return {SolutionPath::condensed, needs + ", and how much there is is not known"};
  }
  const std::string there = concat(" of ", gigabytes(*available));
  if (plan.memory_bytes <= *available) {
    return {SolutionPath::condensed, needs + there + ", and all load steps share it"};
  }
  if (!hindrances.empty()) {
    return {SolutionPath::condensed,
            needs + there + "; the coupled path cannot take the scene: " + hindrances.front().what};
  }
  if (coupled_bytes(plan) > *available) {
    return {SolutionPath::condensed,
            concat(needs, there, ", the coupled path ", gigabytes(coupled_bytes(plan)))};
  }
  return {SolutionPath::coupled,
          concat(needs, there, "; the coupled path needs about ", gigabytes(coupled_bytes(plan)))};
}

}  // namespace faultsim
