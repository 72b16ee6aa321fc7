#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "simulator/mesh/uncut_mesh.h"

namespace faultsim::test {

/// A body of tetrahedra as a file of Gmsh: a physical volume per region, "rock" where there is none
/// and else "part 0", "part 1" and so on; a physical surface per fault and group of the boundary.
inline void write_msh(const UncutMesh& body, const std::filesystem::path& path) {
  std::vector<std::vector<std::size_t>> volumes(1);
  for (std::size_t cell = 0; cell < body.n_cells(); ++cell) {
    const auto region = static_cast<std::size_t>(body.region[cell] + 1);
    if (volumes.size() <= region) volumes.resize(region + 1);
    volumes[region].push_back(cell);
  }
  std::vector<FacetGroup> surfaces = body.faults;
  surfaces.insert(surfaces.end(), body.boundary.begin(), body.boundary.end());
  std::ofstream file(path);
  file.precision(17);
  file << "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n"
       << volumes.size() + surfaces.size() << '\n';
  for (std::size_t k = 0; k < surfaces.size(); ++k)
    file << "2 " << k + 1 << " \"" << surfaces[k].name << "\"\n";
  for (std::size_t k = 0; k < volumes.size(); ++k)
    file << "3 " << k + 1 << " \"" << (k == 0 ? "rock" : "part " + std::to_string(k - 1)) << "\"\n";
  file << "$EndPhysicalNames\n$Entities\n0 0 " << surfaces.size() << ' ' << volumes.size() << '\n';
  for (std::size_t k = 0; k < surfaces.size(); ++k)
    file << k + 1 << " 0 0 0 0 0 0 1 " << k + 1 << " 0\n";
  for (std::size_t k = 0; k < volumes.size(); ++k)
    file << k + 1 << " 0 0 0 0 0 0 1 " << k + 1 << " 0\n";
  const std::size_t n = body.nodes.size();
  file << "$EndEntities\n$Nodes\n1 " << n << " 1 " << n << "\n3 1 0 " << n << '\n';
  for (std::size_t k = 0; k < n; ++k) file << k + 1 << '\n';
  for (const Eigen::Vector3d& x : body.nodes) file << x.x() << ' ' << x.y() << ' ' << x.z() << '\n';
  std::size_t n_elements = body.n_cells(), n_blocks = 0, tag = 0;
  for (const FacetGroup& surface : surfaces) n_elements += surface.facets.size();
  for (const auto& cells : volumes) n_blocks += cells.empty() ? 0 : 1;
  for (const FacetGroup& surface : surfaces) n_blocks += surface.facets.empty() ? 0 : 1;
  file << "$EndNodes\n$Elements\n" << n_blocks << ' ' << n_elements << " 1 " << n_elements << '\n';
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    if (surfaces[k].facets.empty()) continue;
    file << "2 " << k + 1 << " 2 " << surfaces[k].facets.size() << '\n';
    for (const auto& facet : surfaces[k].facets)
      file << ++tag << ' ' << facet[0] + 1 << ' ' << facet[1] + 1 << ' ' << facet[2] + 1 << '\n';
  }
  for (std::size_t k = 0; k < volumes.size(); ++k) {
    if (volumes[k].empty()) continue;
    file << "3 " << k + 1 << " 4 " << volumes[k].size() << '\n';
    for (const std::size_t cell : volumes[k]) {
      file << ++tag;
      for (std::size_t v = 0; v < 4; ++v) file << ' ' << body.corners[4 * cell + v] + 1;
      file << '\n';
    }
  }
  file << "$EndElements\n";
}

}  // namespace faultsim::test
