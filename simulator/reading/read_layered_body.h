#pragma once

#include <string>
#include <vector>

#include "simulator/horizons/layered_body.h"
#include "simulator/reading/scene_reader.h"

/// Inside of read_horizons: the keys of a body of horizons, as numbers for its builder.
namespace faultsim {

/// What is read of a layer besides its surfaces.
struct LayerRock {
  std::string name;
  std::string material;
  std::string outside;  ///< material beyond the compartments that reach the layer.
};

/// A body and its names. Regions of compartments are the numbers of the compartments.
struct BodyOfKeys {
  horizons::LayeredBody body;
  std::vector<LayerRock> rocks;  ///< per layer.
  std::string tables;            ///< the text of all files of horizons.
};

/// Reads /geometry, the places of /faults and /mesh. What is missing or wrong has been said; then
/// the body is not to be built.
BodyOfKeys read_layered_body(SceneReader& reader, const Scene& scene);

/// Where the scene says what a pointer of the builder's is about: "/horizons/0/depth" is the top of
/// the second layer.
std::string scene_pointer(const SceneReader& reader, const std::string& of_body);

}  // namespace faultsim
