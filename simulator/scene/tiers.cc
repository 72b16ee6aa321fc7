#include "simulator/scene/tiers.h"

#include <algorithm>

#include "simulator/common/errors.h"

namespace faultsim {

const std::vector<Tier>& tiers() {
  static const std::vector<Tier> all = {
      {"screening", {.strike = 100, .dip = 10, .normal = 10}, true, false, ""},
      {"demonstration", {.strike = 200, .dip = 50, .normal = 100}, false, false, ""},
      {"standard", {.strike = 100, .dip = 20, .normal = 20}, false, false, ""},
      {"reference", {.strike = 50, .dip = 10, .normal = 10}, false, true, ""},
  };
  return all;
}

const Tier* find_tier(const std::string& name) {
  const auto found = std::find_if(tiers().begin(), tiers().end(),
                                  [&](const Tier& tier) { return name == tier.name; });
  return found == tiers().end() ? nullptr : &*found;
}

std::string cells_text(const MeshSizes& sizes, bool plane_strain) {
  std::string text = plane_strain ? "" : concat(sizes.strike, " m along strike; ");
  if (sizes.grades_corners()) {
    text += concat(sizes.corner, " m at compartment corners, growing by ", sizes.corner_growth,
                   " to ", sizes.dip, " m down dip; ");
  } else {
    text += concat(sizes.dip, " m down dip; ");
  }
  return text + concat(sizes.normal, " m beside faults, growing by ", sizes.growth);
}

}  // namespace faultsim
