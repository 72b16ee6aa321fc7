#include "simulator/plan/creep_plan.h"

#include <algorithm>
#include <cmath>

namespace faultsim {
namespace {

/// Step lengths closer than this, relatively, are one: year/12 and (year/4)/3 differ in rounding.
constexpr double kSameLength = 1e-9;

/// Descending, each once.
std::vector<double> distinct(std::vector<double> lengths) {
  std::sort(lengths.rbegin(), lengths.rend());
  const auto is_same = [](double longer, double length) {
    return longer - length <= kSameLength * longer;
  };
  lengths.erase(std::unique(lengths.begin(), lengths.end(), is_same), lengths.end());
  return lengths;
}

}  // namespace

std::vector<double> creep_rungs(const Scene& scene) {
  const Numerics& numerics = scene.numerics;
  std::vector<double> lengths;
  for (const Stage& stage : scene.stages) {
    const double load_step = stage.duration / stage.n_steps;
    if (numerics.creep_time_step > 0) {
      const double ratio = load_step / numerics.creep_time_step;
      lengths.push_back(load_step / std::max(1.0, std::ceil(ratio - kSameLength)));
      continue;
    }
    for (int k = 0; k <= numerics.creep_refinements; ++k) {
      lengths.push_back(std::ldexp(load_step, -k));
    }
  }
  return distinct(std::move(lengths));
}

}  // namespace faultsim
