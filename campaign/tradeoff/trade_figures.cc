#include <algorithm>
#include <cmath>

#include "campaign/tradeoff/trade_report.h"

namespace faultsweep {

using faultsim::figure::LogChart;

namespace {

constexpr double kLeastError = 1e-6;  // what a logarithmic axis shows of an exact result

template <class X, class Y>
void add_series(const TradeTable& table, X&& x, Y&& y, LogChart& chart) {
  faultsim::figure::LogSeries series{table.axis.name, {}};
  for (const TradeRow& row : table.rows) {
    if (x(row) > 0 && !std::isnan(y(row)))
      series.points.push_back({x(row), std::max(y(row), kLeastError), row.choice.name});
  }
  if (!series.points.empty()) chart.series.push_back(std::move(series));
}

double finest(const TradeTable& table) {
  double least = 0;
  for (const TradeRow& row : table.rows) {
    if (!row.run.result || row.choice.size <= 0) continue;
    least = least > 0 ? std::min(least, row.choice.size) : row.choice.size;
  }
  return least;
}

}  // namespace

TradeFigures trade_figures(const TradeReport& report) {
  const std::string error = "largest error of χ̄ over faults and load steps";
  TradeFigures made{{"Error against cost", "operator and one case, s", error, {}},
                    {"Error against size", "cell or step, in units of the finest", error, {}}};
  for (const TradeTable& table : report.trade.tables) {
    if (table.axis.is_mesh) {
      add_series(
          table, [](const TradeRow& row) { return row.seconds(); },
          [](const TradeRow& row) { return row.total_chi; }, made.pareto);
    }
    if (table.axis.converges) {
      const double least = finest(table);
      add_series(
          table, [least](const TradeRow& row) { return row.choice.size / least; },
          [](const TradeRow& row) { return row.error.chi; }, made.convergence);
    }
  }
  return made;
}

}  // namespace faultsweep
