#include "simulator/surface/case_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace faultsim {
namespace {

constexpr double kLeastSlip = 1e-3;    // m, against which differences of smaller slips count
constexpr double kSlipTolerance = 10;  // times that of χ̄
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double largest_slip(const CaseResult& result) {
  double largest = kLeastSlip;
  for (const StepResult& step : result.steps) {
    for (const FaultMetrics& fault : step.faults) largest = std::max(largest, fault.max_slip);
  }
  return largest;
}

/// χ̄ is infinite on a fault that opens; two of them are alike. What is no number is like nothing.
double difference(double a, double b) {
  const double found = a == b ? 0 : std::abs(a - b);
  return std::isnan(found) ? kInfinity : found;
}

/// Whether one of two histories stops where the other goes on. A step without equilibrium has no
/// metrics.
bool end_apart(const CaseResult& a, const CaseResult& b) {
  const auto n_measured = [](const CaseResult& result) {
    return std::ranges::count_if(result.steps,
                                 [](const StepResult& step) { return !step.faults.empty(); });
  };
  return in_equilibrium(a.outcome) != in_equilibrium(b.outcome) || n_measured(a) != n_measured(b);
}

}  // namespace

void CaseErrors::take_larger(const CaseErrors& other) {
  chi_bar = std::max(chi_bar, other.chi_bar);
  largest_slip = std::max(largest_slip, other.largest_slip);
  flags_that_differ += other.flags_that_differ;
}

bool CaseErrors::within(double tolerance) const {
  return chi_bar <= tolerance && largest_slip <= kSlipTolerance * tolerance;
}

bool CaseErrors::are_known() const { return std::isfinite(chi_bar) && std::isfinite(largest_slip); }

CaseErrors case_errors(const CaseResult& found, const CaseResult& exact) {
  CaseErrors errors;
  if (end_apart(found, exact)) errors.chi_bar = kInfinity;  // of the rest nothing is known
  const double slip = largest_slip(exact);
  for (std::size_t s = 0; s < std::min(found.steps.size(), exact.steps.size()); ++s) {
    const auto &ours = found.steps[s].faults, &theirs = exact.steps[s].faults;
    for (std::size_t f = 0; f < std::min(ours.size(), theirs.size()); ++f) {
      errors.chi_bar = std::max(errors.chi_bar, difference(ours[f].chi_bar, theirs[f].chi_bar));
      errors.largest_slip =
          std::max(errors.largest_slip, difference(ours[f].max_slip, theirs[f].max_slip) / slip);
    }
  }
  errors.flags_that_differ += found.outcome != exact.outcome ? 1 : 0;
  for (std::size_t s = 0; s < std::min(found.stages.size(), exact.stages.size()); ++s) {
    const auto &ours = found.stages[s].faults, &theirs = exact.stages[s].faults;
    for (std::size_t f = 0; f < std::min(ours.size(), theirs.size()); ++f) {
      const bool is_certain = ours[f].activation_resolved && theirs[f].activation_resolved;
      errors.flags_that_differ += is_certain && ours[f].activated != theirs[f].activated ? 1 : 0;
    }
  }
  return errors;
}

}  // namespace faultsim
