#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace faultsim {

/// Nodes of the cells of a mesh, one cell after the other, in VTK's order.
struct VolumeCells {
  std::span<const int> nodes;
  std::size_t nodes_of_cell;  ///< 8 = hexahedra, 10 = quadratic tetrahedra.
};

struct VolumeSnapshot {
  std::string name;
  double time;                              ///< s.
  Eigen::Matrix3Xd displacement;            ///< m, per node.
  Eigen::VectorXd pressure_change = {};     ///< Pa, per cell; of all snapshots or of none.
  Eigen::VectorXd temperature_change = {};  ///< K, per cell, likewise.
};

/// Displacements of the whole mesh, and what changes in its cells, at named steps:
/// FOLDER/volume.h5 + volume.xmf.
/// @param nodes     m.
/// @param material  per cell.
void write_volume(const std::filesystem::path& folder, const std::vector<Eigen::Vector3d>& nodes,
                  const VolumeCells& cells, const std::vector<int>& material,
                  const std::vector<VolumeSnapshot>& snapshots);

}  // namespace faultsim
