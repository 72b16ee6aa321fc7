#include "simulator/scene/pressure_history.h"

#include <algorithm>
#include <cstddef>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

/// Linear between points, constant outside.
double interpolated(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const auto next = std::upper_bound(x.begin(), x.end(), at);
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

std::vector<double> step_times(const Scene& scene) {
  std::vector<double> times;
  double start = 0;
  for (const Stage& stage : scene.stages) {
    for (int k = 1; k <= stage.n_steps; ++k) {
      times.push_back(start + stage.duration * k / stage.n_steps);
    }
    start += stage.duration;
  }
  return times;
}

std::size_t stage_of_step(const Scene& scene, std::size_t step) {
  std::size_t first = 0;
  for (std::size_t i = 0; i < scene.stages.size(); ++i) {
    first += static_cast<std::size_t>(scene.stages[i].n_steps);
    if (step < first) return i;
  }
  throw_internal("step is one of the scene's", std::to_string(step), __FILE__, __LINE__);
}

}  // namespace faultsim
