#include "simulator/initial_state/pressure_history.h"

#include <algorithm>
#include <vector>

namespace faultsim {
namespace {

/// Linear between points, constant outside.
double interpolated(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const auto next = std::ranges::upper_bound(x, at);
  if (next == x.begin()) return y.front();
  const auto i = static_cast<std::size_t>(next - x.begin()) - 1;
  if (next == x.end() || x[i] == at) return y[i];
  const double share = (at - x[i]) / (x[i + 1] - x[i]);
  return y[i] + share * (y[i + 1] - y[i]);
}

}  // namespace

double pressure_change_at(const PressureHistory& history, double time) {
  const double local = time - history.lag;
  if (history.time.empty() || local <= 0) return 0;
  if (local < history.time.front()) {
    return history.scale * history.pressure_change.front() * (local / history.time.front());
  }
  return history.scale * interpolated(history.time, history.pressure_change, local);
}

double factor_at(const TimeTable& table, double time) {
  return table.time.empty() ? 1 : interpolated(table.time, table.factor, time);
}

}  // namespace faultsim
