#include <algorithm>
#include <cmath>

#include "campaign/tradeoff/trade_report.h"
#include "simulator/common/errors.h"

namespace faultsweep {

using faultsim::concat;

namespace {

constexpr double kLeastError = 1e-6;  // what a logarithmic axis shows of an exact result

struct Series {
  std::string title;
  std::string points;  ///< lines: x y "label".
};

template <class X, class Y>
void add_series(const TradeTable& table, X&& x, Y&& y, std::vector<Series>& all) {
  Series series{table.axis.name, ""};
  for (const TradeRow& row : table.rows) {
    if (!(x(row) > 0) || std::isnan(y(row))) continue;
    series.points +=
        concat(x(row), " ", std::max(y(row), kLeastError), " \"", row.choice.name, "\"\n");
  }
  if (!series.points.empty()) all.push_back(series);
}

double finest(const TradeTable& table) {
  double least = 0;
  for (const TradeRow& row : table.rows) {
    if (!row.run.result || row.choice.size <= 0) continue;
    least = least > 0 ? std::min(least, row.choice.size) : row.choice.size;
  }
  return least;
}

std::string plot(const std::string& file, const std::string& label,
                 const std::vector<Series>& all) {
  if (all.empty()) return "";
  std::string data, plots;
  for (std::size_t k = 0; k < all.size(); ++k) {
    data += concat("$series", k, " << END\n", all[k].points, "END\n");
    plots += concat(plots.empty() ? "plot " : ", \\\n  ", "$series", k,
                    " using 1:2 with linespoints pt 7 lc ", k + 1, " title \"", all[k].title,
                    "\", $series", k, " using 1:2:3 with labels offset 0,0.8 font ',9' tc lt ",
                    k + 1, " notitle");
  }
  return concat(data, "set output '", file, "'\nset xlabel '", label, "'\n", plots, "\n");
}

}  // namespace

std::string trade_figures(const TradeReport& report) {
  std::vector<Series> pareto, convergence;
  for (const TradeTable& table : report.trade.tables) {
    if (table.axis.is_mesh) {
      add_series(
          table, [](const TradeRow& row) { return row.seconds(); },
          [](const TradeRow& row) { return row.total_chi; }, pareto);
    }
    if (table.axis.converges) {
      const double least = finest(table);
      add_series(
          table, [least](const TradeRow& row) { return row.choice.size / least; },
          [](const TradeRow& row) { return row.error.chi; }, convergence);
    }
  }
  return concat(
      "# gnuplot figures.gp\n"
      "set terminal svg size 760,480 background 'white'\n"
      "set logscale xy\nset grid\nset key outside top center horizontal\nset format y '%g'\n"
      "set offsets graph 0.1, graph 0.2, graph 0.05, 0\n"
      "set ylabel 'largest error of the critical index over faults and load steps'\n",
      plot("pareto.svg", "operator and one case, s", pareto),
      plot("convergence.svg", "cell or step, in units of the finest", convergence));
}

}  // namespace faultsweep
