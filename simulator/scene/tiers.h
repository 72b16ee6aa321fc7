#pragma once

#include <string>
#include <vector>

#include "simulator/scene/scene.h"

namespace faultsim {

/// A named choice of cells of a field. The only place where sizes of tiers stand; errors are those
/// of its cells in plane strain against the limit of small ones (results/measures).
struct Tier {
  const char* name;
  MeshSizes sizes;
  bool plane_strain;   ///< else 3D.
  bool half_domain;    ///< made for half of the domain, refused for all of it.
  const char* errors;  ///< measured, in words.
  double chi_rms;      ///< of these the rms error of χ̄.
  double chi_largest;  ///< of these its largest error.
};

const std::vector<Tier>& tiers();
/// nullptr where there is none: "custom".
const Tier* find_tier(const std::string& name);

/// "100 m along strike; 5 m at compartment corners, growing by 1.3 to 20 m down dip; ...".
std::string cells_text(const MeshSizes& sizes, bool plane_strain);

/// The cells of a field and the errors of its tier, for the screen.
std::string mesh_text(const Scene& scene);

}  // namespace faultsim
