#include "simulator/app/trace_text.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "simulator/common/text.h"

namespace faultsim {
namespace {

std::string search_text(const SubStepTrace::Search& search) {
  const SearchHistory& history = search.history;
  std::string text = formatted("    %s: %s, %d iterations over %d active sets\n", search.way,
                               to_string(history.end), history.iterations, history.passes);
  if (history.last.empty()) return text;
  const bool iterative =
      std::ranges::any_of(history.last, [](const SearchIteration& at) { return at.krylov >= 0; });
  text += formatted("    %6s %10s %7s %7s %7s %8s%s\n", "iter", "residual", "length", "slip",
                    "open", "changed", iterative ? "  krylov" : "");
  int number = history.iterations - static_cast<int>(history.last.size());
  if (number > 0) text += formatted("    %6s (%d before these)\n", "...", number);
  for (const SearchIteration& at : history.last) {
    const std::string residual = std::isnan(at.residual) ? "-" : formatted("%.3g", at.residual);
    text += formatted("    %6d %10s %7.4g %7d %7d %8d", ++number, residual.c_str(), at.length,
                      at.n_slip, at.n_open, at.n_changed);
    if (iterative) text += at.krylov < 0 ? "       -" : formatted(" %7d", at.krylov);
    text += "\n";
  }
  return text;
}

}  // namespace

std::string trace_text(int step, const SubStepTrace& trace) {
  std::string text = formatted("  step %d, load %.6g to %.6g", step, trace.from, trace.to);
  if (trace.duration > 0) text += formatted(", damped over %.3g s", trace.duration);
  text += formatted(": %s%s\n", trace.verdict, trace.searches.empty() ? ", nothing moves" : "");
  for (const SubStepTrace::Search& search : trace.searches) text += search_text(search);
  return text;
}

nlohmann::json trace_to_json(int step, const SubStepTrace& trace) {
  nlohmann::json searches = nlohmann::json::array();
  for (const SubStepTrace::Search& search : trace.searches) {
    nlohmann::json iterations = nlohmann::json::array();
    for (const SearchIteration& at : search.history.last) {
      const auto residual =
          std::isfinite(at.residual) ? nlohmann::json(at.residual) : nlohmann::json(nullptr);
      iterations.push_back({{"residual", residual},
                            {"length", at.length},
                            {"n_slip", at.n_slip},
                            {"n_open", at.n_open},
                            {"n_changed", at.n_changed}});
      if (at.krylov >= 0) iterations.back()["krylov"] = at.krylov;
    }
    searches.push_back({{"way", search.way},
                        {"end", to_string(search.history.end)},
                        {"iterations", search.history.iterations},
                        {"passes", search.history.passes},
                        {"last", std::move(iterations)}});
  }
  return {{"step", step},
          {"from", trace.from},
          {"to", trace.to},
          {"damped_over_s", trace.duration},
          {"n_nodes", trace.n_nodes},
          {"verdict", trace.verdict},
          {"searches", std::move(searches)}};
}

}  // namespace faultsim
