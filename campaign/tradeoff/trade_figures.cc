#include <cmath>

#include "campaign/tradeoff/trade_report.h"
#include "simulator/common/errors.h"

namespace faultsweep {

using faultsim::concat;

namespace {

constexpr double kLeastError = 1e-6;  // what a logarithmic axis shows of an exact result

/// "x y label" of every row for which they are known.
template <class X, class Y>
std::string block(const TradeTable& table, X&& x, Y&& y, bool front_only = false) {
  std::string text = concat("# ", table.axis.name, "\n");
  for (const TradeRow& row : table.rows) {
    if (std::isnan(x(row)) || std::isnan(y(row)) || x(row) <= 0) continue;
    if (front_only && !row.on_front) continue;
    text += concat(x(row), " ", std::max(y(row), kLeastError), " \"", row.choice.name, "\"\n");
  }
  return text + "\n\n";
}

bool is_refined(const TradeTable& table) { return table.axis.converges; }

}  // namespace

std::string trade_figure_data(const TradeReport& report) {
  std::string text;
  const auto seconds = [](const TradeRow& row) { return row.seconds(); };
  const auto total = [](const TradeRow& row) { return row.total_chi; };
  const auto size = [](const TradeRow& row) { return row.choice.size; };
  const auto error = [](const TradeRow& row) { return row.error.chi; };
  for (const TradeTable& table : report.tables) {
    if (table.axis.is_mesh) text += block(table, seconds, total);
  }
  for (const TradeTable& table : report.tables) {
    if (is_refined(table)) text += block(table, size, error);
  }
  return text;
}

std::string trade_figure_script(const TradeReport& report) {
  std::string pareto, convergence;
  int index = 0;
  const auto add = [&index](std::string& plots, const std::string& title) {
    plots += concat(plots.empty() ? "plot " : ", \\\n  ", "'figures.dat' index ", index,
                    " using 1:2 with linespoints pt 7 title \"", title, "\", '' index ", index,
                    " using 1:2:3 with labels offset 0,0.8 font ',9' notitle");
    ++index;
  };
  for (const TradeTable& table : report.tables) {
    if (table.axis.is_mesh) add(pareto, table.axis.name);
  }
  for (const TradeTable& table : report.tables) {
    if (is_refined(table)) {
      const bool salt = table.axis.name == "salt steps";
      add(convergence, salt ? "salt steps (size in s)" : table.axis.name + " (size in m)");
    }
  }
  return concat(
      "# gnuplot figures.gp\n"
      "set terminal svg size 760,480 background 'white'\n"
      "set logscale xy\nset grid\nset key bottom left\nset format y '%g'\nset offsets graph 0.08, "
      "graph 0.15, graph 0.05, 0\n"
      "set ylabel 'largest error of the critical index, all faults and load steps'\n"
      "set output 'pareto.svg'\nset xlabel 'operator and one case, s'\n",
      pareto, "\nset output 'convergence.svg'\nset xlabel 'cell or step'\n", convergence, "\n");
}

}  // namespace faultsweep
