#pragma once

#include <filesystem>
#include <string>

#include "tests/unit/mesh/cut_body.h"
#include "tests/unit/mesh/write_msh.h"

namespace faultsim::test {

/// A cube of tetrahedra, 400 m wide, from 2200 to 1800 m depth, of which the middle half of the
/// height is a reservoir, "part 0". Fault A goes through it at x = 200 m, B ends at A.
inline UncutMesh meshed_cube(int n = 4) {
  const double middle = n / 2.0;
  UncutMesh body =
      body_of(made_of(n, 3), n,
              {{"A", {1, 0, 0}, middle},
               {"B", {0, 1, 0}, middle, [=](const Eigen::Vector3d& x) { return x.x() > middle; }}});
  for (std::size_t cell = 0; cell < body.n_cells(); ++cell) {
    double z = 0;
    for (std::size_t v = 0; v < 4; ++v) z += body.nodes[body.corners[4 * cell + v]].z() / 4;
    const bool inside = std::abs(z - middle) < n / 4.0;
    body.region[cell] = inside ? 0 : -1;
    body.region_fraction[cell] = inside ? 1 : 0;
  }
  for (Eigen::Vector3d& x : body.nodes) x = 400.0 / n * x - Eigen::Vector3d(0, 0, 2200);
  return body;
}

/// A scene of it, with the mesh in `folder`: its file.
inline std::filesystem::path write_mesh_scene(const std::filesystem::path& folder,
                                              const UncutMesh& body = meshed_cube()) {
  write_msh(body, folder / "cube.msh");
  std::ofstream(folder / "scene.json") << R"({
  "format": 1,
  "materials": {
    "salt": { "density": "2200 kg/m3", "youngs_modulus": "40 GPa", "poisson_ratio": 0.25 },
    "reservoir": { "density": "2300 kg/m3", "youngs_modulus": "11 GPa", "poisson_ratio": 0.15 }
  },
  "geometry": {
    "kind": "mesh", "file": "cube.msh",
    "volumes": {
      "rock": { "material": "salt" },
      "part 0": { "material": "reservoir", "compartment": "gas" }
    },
    "boundary": [ { "surfaces": ["x-", "x+", "y-", "y+", "z-"], "kind": "roller" } ]
  },
  "initial_state": {
    "kind": "profile",
    "vertical_stress": "0 MPa", "vertical_stress_gradient": "-23 kPa/m",
    "pressure": "0 MPa", "pressure_gradient": "10 kPa/m",
    "ratio_across": 0.8, "ratio_along": 0.8
  },
  "friction": { "law": "coefficient", "friction_coefficient": 0.6 },
  "fault_pressure": { "rule": "none" },
  "faults": [ { "name": "A" }, { "name": "B" } ],
  "stages": [ { "name": "production", "duration": "10 years", "steps": 2, "pressure_change": "-15 MPa" } ],
  "compartments": { "gas": { "scale": 1.0 } }
})";
  return folder / "scene.json";
}

}  // namespace faultsim::test
