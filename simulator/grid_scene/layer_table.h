#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace faultsim::grid_scene {

/// Rock above, in and below the reservoir, from the surface down.
struct RockLayer {
  std::string name;
  double top = 0;             ///< m, depth; of the reservoir and the layer below it not used.
  double density = 0;         ///< kg/m3
  double youngs_modulus = 0;  ///< Pa
  double poisson_ratio = 0;
};

struct RockLayers {
  std::vector<RockLayer> all;
  std::size_t reservoir = 0;  ///< into all; one layer at least lies above it and one below.
};

/// An overburden, the reservoir and an underburden, as `faultsim init field` has them.
RockLayers assumed_layers();

/// A table of layers: name, top [m], density [kg/m3], youngs_modulus [GPa], poisson_ratio, from the
/// surface down. The layer "reservoir" is the grid: its top and that of the layer below it are the
/// grid's, whatever the table says.
/// @param shallowest, deepest  depth of the reservoir, m.
/// @param base                 depth of the model, m.
/// @throws InputError with all that is wrong: columns, numbers, layers out of order, none above or
/// below, tops that would cut the reservoir.
RockLayers read_layers(std::string_view text, const std::string& source, double shallowest,
                       double deepest, double base);

}  // namespace faultsim::grid_scene
