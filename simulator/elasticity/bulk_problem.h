#pragma once

#include <string>
#include <utility>
#include <vector>

#include "simulator/elasticity/elasticity.h"
#include "simulator/model/load_key.h"

namespace faultsim {

/// One unit load of a family: exactly one of the three kinds.
struct LoadCase {
  LoadKey key;                               ///< what the scene calls it.
  int region = -1;                           ///< ≥ 0: b Δp = 1 Pa where Mesh::region is this.
  std::vector<BoundaryGroup> stress_groups;  ///< non-empty: stress change Δσ on these.
  Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();
  bool displacement = false;  ///< the prescribed displacements of this load's index.
};

/// All that defines a family's linear bulk.
struct BulkProblem {
  Mesh mesh;
  std::vector<ElasticMaterial> materials;
  std::vector<double> viscosity;  ///< per material, Pa s, infinite = elastic; empty = all elastic.
  std::vector<DisplacementCondition> conditions;
  std::vector<LoadCase> loads;
  std::vector<std::pair<std::string, Eigen::Vector3d>> observation_points;
  bool mean_dilatation = true;  ///< B-bar of hexahedra.
  bool half_domain = false;
};

/// The scene's region whose pressure load acts on a cell; −1 = none.
int pressure_region(const BulkProblem& problem, int cell);

/// The nodal forces of one unit load, f_k (n_unknowns, N), in the unknowns of `dofs`.
/// @pre `dofs` are of problem.mesh and problem.conditions; the load is of exactly one kind
/// (InternalError).
Eigen::VectorXd unit_load(const BulkProblem& problem, const DofMap& dofs, int index);

}  // namespace faultsim
