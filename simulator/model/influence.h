#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "simulator/model/stored_matrix.h"

namespace faultsim {

/// A cell of the mesh that an influence block has.
struct InfluenceCell {
  int cell = 0;         ///< number in the mesh.
  int region = -1;      ///< pressure region of the scene; −1 = none.
  double fraction = 0;  ///< share of the cell's volume in the region, [0, 1].
  int material = 0;     ///< of the scene; Biot coefficient and stiffness belong to it.
  double volume = 0;    ///< m3 (plane strain: m2).
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< m.
};

/// What an isotropic eigenstress −s I in single cells does to the faults and to observed points
/// with every jump held at zero (docs/model.md, 9a to 9c):
///
///   Δt_locked = Σ_c P_c s_c,      Δu_observed = Σ_c O_c s_c,      s_c = b Δp + 3 K α_T ΔT  in cell
///   c.
///
/// So a field of pressure or temperature costs one product and never the bulk.
struct InfluenceBlock {
  std::string fingerprint;           ///< of the operator and the cells asked for.
  std::string operator_fingerprint;  ///< whose jumps and observation rows these are.
  std::vector<std::string> region_names = {};
  std::vector<InfluenceCell> cells = {};
  StoredMatrix traction = {};     ///< P: n_dofs x n_cells, Pa per Pa.
  Eigen::MatrixXd observed = {};  ///< O: n_rows x n_cells, m per Pa.
  double build_seconds = 0;       ///< reported; without those of the factor.
};

/// Σ_c P_c s_c of each field, Pa (n_dofs x n_fields). The time is that of reading P once per eight
/// fields. A field's bits depend neither on the others nor on the threads.
/// @param stress  s per cell and field (n_cells x n_fields), Pa.
/// @throws InternalError for another number of cells.
Eigen::MatrixXd locked_change(const InfluenceBlock& block,
                              const Eigen::Ref<const Eigen::MatrixXd>& stress, int n_threads = 1);

}  // namespace faultsim
