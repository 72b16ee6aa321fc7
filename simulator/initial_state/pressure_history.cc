#include "simulator/initial_state/pressure_history.h"

#include <algorithm>

namespace faultsim {

Between between(const std::vector<double>& x, double at) {
  if (x.empty() || at <= x.front()) return {};
  if (!(at < x.back())) return {x.size() - 1, x.size() - 1, 0};
  const auto next = static_cast<std::size_t>(std::ranges::upper_bound(x, at) - x.begin());
  return {next - 1, next, (at - x[next - 1]) / (x[next] - x[next - 1])};
}

double value_at(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const auto [first, second, share] = between(x, at);
  return first == second ? y[first] : y[first] + share * (y[second] - y[first]);
}

double pressure_change_at(const PressureHistory& history, double time) {
  const double local = time - history.lag;
  if (history.time.empty() || local <= 0) return history.scale * 0;
  const double first = history.time.front();
  return history.scale * (local < first ? history.pressure_change.front() * local / first
                                        : value_at(history.time, history.pressure_change, local));
}

double factor_at(const TimeTable& table, double time) {
  return table.time.empty() ? 1 : value_at(table.time, table.factor, time);
}

}  // namespace faultsim
