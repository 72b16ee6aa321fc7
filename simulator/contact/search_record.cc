#include "simulator/contact/search_record.h"

#include <cmath>

#include "simulator/common/text.h"

namespace faultsim {
namespace {

std::string residual_text(double residual) {
  return std::isnan(residual) ? "-" : formatted("%.3g", residual);
}

}  // namespace

void SearchHistory::add(const SearchIteration& iteration) {
  ++iterations;
  if (last.size() == 2 * kMost) last.erase(last.begin(), last.begin() + kMost);
  last.push_back(iteration);
  const bool better = best_at == 0 || iteration.residual < best;
  if (!better || !std::isfinite(iteration.residual)) return;
  best = iteration.residual;
  best_at = iterations;
}

std::string trace_summary(const SubStepTrace& trace) {
  if (trace.searches.empty() || trace.searches.back().history.last.empty()) return "";
  const SearchHistory& history = trace.searches.back().history;
  return formatted(
      "%d iterations over %d active sets, residual %s tolerances at the end and %s at "
      "best (iteration %d), %s",
      history.iterations, history.passes, residual_text(history.last.back().residual).c_str(),
      residual_text(history.best).c_str(), history.best_at, to_string(history.end));
}

}  // namespace faultsim
