#include "campaign/tradeoff/sample.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "campaign/common/json.h"
#include "campaign/common/names.h"

namespace faultsweep {

namespace {

/// The case at a tier, as changes of the base scene: what it has differently, without its own mesh.
json at_tier(const json& base, json scene, const std::string& tier) {
  scene["tier"] = tier;
  scene["mesh"] = json::object();
  if (scene.contains("numerics")) scene["numerics"].erase("plane_strain");
  json changes = json::object();
  for (const auto& [key, value] : scene.items()) {
    if (!base.contains(key) || base[key] != value) changes["/" + key] = value;
  }
  return changes;
}

/// A step through n cases that visits all and keeps away from the strides of a grid: near the
/// golden section of n and coprime to it.
long scattering_stride(long n) {
  long stride = std::max(1L, std::lround(0.6180339887 * static_cast<double>(n)));
  while (std::gcd(stride, n) != 1) ++stride;
  return stride;
}

}  // namespace

std::string sample_group(const std::string& tier) { return "ranking, " + tier; }

void add_sample(const Expansion& campaign, const json& base, long n_cases,
                const std::vector<std::string>& tiers, json& spec) {
  const auto n = static_cast<long>(campaign.cases.size());
  const long stride = scattering_stride(n);
  for (const std::string& tier : tiers) {
    json variants = json::object();
    for (long k = 0; k < std::min(n, n_cases); ++k) {
      const auto index = static_cast<std::size_t>(k * stride % n);
      variants[concat("case ", index + 1)] =
          at_tier(base, scene_of(campaign, campaign.cases[index]), tier);
    }
    json parameters;
    parameters["choice"]["variants"] = variants;
    spec["design"]["groups"].push_back(
        {{"name", sample_group(tier)}, {"design", {{"kind", "grid"}, {"parameters", parameters}}}});
  }
}

}  // namespace faultsweep
