#include "simulator/coupled_case/path_choice.h"

#include "simulator/common/text.h"

namespace faultsim {
namespace {

std::string gigabytes(double bytes) { return formatted("%.2g GB", bytes / 1e9); }

}  // namespace

double coupled_bytes(const Plan& plan) {
  constexpr double kPerUnknown = 18e3;  // 19 GB for 1.06 million
  return kPerUnknown * static_cast<double>(plan.n_unknowns);
}

PathChoice choose_path(const Plan& plan, std::optional<double> available, int n_cases,
                       const std::vector<Problem>& hindrances) {
  const std::string needs =
      concat("the condensed operator needs about ", gigabytes(plan.memory_bytes));
  if (!available) {
    return {SolutionPath::condensed, needs + ", and how much there is is not known"};
  }
  const std::string there = concat(" of ", gigabytes(*available));
  if (plan.memory_bytes <= *available) {
    const std::string shared = n_cases == 1
                                   ? "and all load steps share it"
                                   : concat("and all load steps of ", n_cases, " cases share it");
    return {SolutionPath::condensed, needs + there + ", " + shared};
  }
  if (!hindrances.empty()) {
    return {SolutionPath::condensed,
            needs + there + "; the coupled path cannot take the scene: " + hindrances.front().what};
  }
  if (coupled_bytes(plan) > *available) {
    return {SolutionPath::condensed,
            concat(needs, there, ", the coupled path ", gigabytes(coupled_bytes(plan)))};
  }
  const std::string price =
      n_cases == 1 ? "" : concat("; each of the ", n_cases, " cases pays for its own solves");
  return {SolutionPath::coupled, concat(needs, there, "; the coupled path needs about ",
                                        gigabytes(coupled_bytes(plan)), price)};
}

}  // namespace faultsim
