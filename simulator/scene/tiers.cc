#include "simulator/scene/tiers.h"

#include <algorithm>

#include "simulator/common/errors.h"

namespace faultsim {

const std::vector<Tier>& tiers() {
  static const std::vector<Tier> all = {
      {"screening",
       {.strike = 100, .dip = 10, .normal = 2.5, .growth = 1.7, .corner = 2.5, .corner_growth = 2},
       true,
       false,
       "χ̄ within 0.011 (rms 0.003), largest slip within 6 % above 11 mm",
       0.003,
       0.011},
      {"demonstration",
       {.strike = 200, .dip = 30, .normal = 10, .growth = 2, .corner = 10, .corner_growth = 1.5},
       false,
       false,
       "χ̄ within 0.025 (rms 0.008), largest slip within 11 % above 11 mm",
       0.008,
       0.025},
      {"standard",
       {.strike = 100, .dip = 15, .normal = 0.5, .growth = 2, .corner = 0.5, .corner_growth = 1.5},
       false,
       false,
       "χ̄ within 0.018 (rms 0.005), largest slip within 6 % above 10 mm",
       0.005,
       0.018},
      {"reference",
       {.strike = 75, .dip = 10, .normal = 0.5, .growth = 2, .corner = 0.5, .corner_growth = 1.7},
       false,
       true,
       "χ̄ within 0.010 (rms 0.003), largest slip within 6 % above 10 mm",
       0.003,
       0.010},
  };
  return all;
}

const Tier* find_tier(const std::string& name) {
  const auto found = std::ranges::find(tiers(), name, &Tier::name);
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

std::string mesh_text(const Scene& scene) {
  const std::string cells = cells_text(scene.mesh, scene.numerics.plane_strain == Switch::on);
  const Tier* tier = find_tier(scene.tier);
  if (tier == nullptr) return "cells: " + cells;
  if (tier->sizes != scene.mesh)
    return concat("cells: ", cells, "; tier ", tier->name, " with sizes of its own");
  return concat("cells: tier ", tier->name, ", ", cells,
                "\n  measured in plane strain: ", tier->errors);
}

}  // namespace faultsim
