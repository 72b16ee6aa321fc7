#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "campaign/common/json.h"
#include "campaign/tradeoff/trade_report.h"

namespace faultsweep {

using faultsim::figure::LogChart;

namespace {

constexpr double kLeastError = 1e-6;  // what a logarithmic axis shows of an exact result

/// Unknown where the trade says nothing.
double number_of(const json& choice, const char* key) {
  const auto found = choice.find(key);
  return found != choice.end() && found->is_number() ? found->get<double>() : kUnknown;
}

template <class X, class Y>
void add_series(const json& axis, X&& x, Y&& y, LogChart& chart) {
  faultsim::figure::LogSeries series{axis.at("axis").get<std::string>(), {}};
  for (const json& choice : axis.at("choices")) {
    if (x(choice) > 0 && !std::isnan(y(choice))) {
      series.points.push_back(
          {x(choice), std::max(y(choice), kLeastError), choice.at("choice").get<std::string>()});
    }
  }
  if (!series.points.empty()) chart.series.push_back(std::move(series));
}

/// The least size that was run to the end.
double finest(const json& axis) {
  double least = 0;
  for (const json& choice : axis.at("choices")) {
    const double size = number_of(choice, "size");
    if (!(size > 0) || choice.value("outcome", json()).is_null()) continue;
    least = least > 0 ? std::min(least, size) : size;
  }
  return least;
}

}  // namespace

TradeFigures trade_figures(const json& trade) {
  const std::string error = "largest error of χ̄ over faults and load steps";
  TradeFigures made{{"Error against cost", "operator and one case, s", error, {}},
                    {"Error against size", "cell or step, in units of the finest", error, {}}};
  for (const json& axis : trade.at("axes")) {
    add_series(
        axis,  // of meshes only is there an error in all
        [](const json& one) { return number_of(one, "operator_s") + number_of(one, "case_s"); },
        [](const json& one) { return number_of(one, "error_chi_in_all"); }, made.pareto);
    if (axis.value("converges", false)) {
      const double least = finest(axis);
      add_series(
          axis, [least](const json& one) { return number_of(one, "size") / least; },
          [](const json& one) { return number_of(one, "error_chi"); }, made.convergence);
    }
  }
  return made;
}

}  // namespace faultsweep
