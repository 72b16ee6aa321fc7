#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace faultsim {

/// Displacements of the whole mesh at named steps: FOLDER/volume.h5 + volume.xmf.
/// @param nodes  m;  @param cells  VTK hexahedra;  @param displacement  per entry 3 x n, m.
struct VolumeSnapshot {
  std::string name;
  double time;
  Eigen::Matrix3Xd displacement;
};
void write_volume(const std::filesystem::path& folder, const std::vector<Eigen::Vector3d>& nodes,
                  const std::vector<std::array<int, 8>>& cells, const std::vector<int>& material,
                  const std::vector<VolumeSnapshot>& snapshots);

}  // namespace faultsim
