#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/elasticity/elasticity.h"
#include "simulator/elasticity/element.h"
#include "simulator/laws/maxwell.h"

namespace faultsim {

/// The deviatoric stress change s of the creeping cells, and the nodal forces it makes.
struct CreepStress {
  /// Pa, tensor components xx yy zz xy yz xz at each Gauss point of a cell (8 of a hexahedron, 4 of
  /// a tetrahedron): 48 or 24 x n_cells.
  Eigen::MatrixXd deviator;
  /// Pᵀ ∫ ε(v):s over the cells of one viscous material, N: n_unknowns x n_materials. A step takes
  /// (1 − decay) of it as load, with the decay of each material.
  Eigen::MatrixXd force;
};

/// The cells of a mesh whose material creeps. Only these have a history.
class CreepCells {
 public:
  /// @param viscosity  per material, Pa s; infinite = does not creep.
  CreepCells(const Mesh& mesh, const std::vector<ElasticMaterial>& materials,
             const std::vector<double>& viscosity, const DofMap& dofs);

  int n_cells() const { return static_cast<int>(cells_.size()); }
  /// Index into Mesh materials of each viscous material that has cells, in the order of
  /// CreepStress::force.
  const std::vector<int>& materials() const { return materials_; }
  CreepStress at_rest() const;

  /// s := decay s + 2 G shear_factor Δe at every Gauss point (docs/model.md, 13), and the forces of
  /// the new s. Δe is the deviator of the strain at the point, as in the stiffness with B-bar.
  /// @param displacement  increment over the step, 3 x n_nodes, m.
  /// @param step          per viscous material (materials()).
  void advance(const Eigen::Matrix3Xd& displacement, const std::vector<MaxwellStep>& step,
               CreepStress& stress) const;

 private:
  const Mesh& mesh_;
  const DofMap& dofs_;
  std::vector<int> materials_;
  std::vector<double> shear_modulus_;  // per viscous material, Pa
  std::vector<int> cells_;
  std::vector<int> material_of_;  // per creeping cell, into materials_
};

}  // namespace faultsim
