#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "simulator/model/compliance.h"
#include "simulator/model/fault_geometry.h"
#include "simulator/model/load_key.h"

namespace faultsim {

/// What the unit loads do with every jump held at zero.
struct LockedLoads {
  std::vector<LoadKey> keys;  ///< of the columns, in the order of the family's loads.
  Eigen::MatrixXd traction;   ///< L: n_dofs x n_loads, Pa per unit of load; no columns
                              ///< where the bulk is not condensed (the coupled path).
};

/// A displacement component observed at a node of the mesh.
struct ObservationRow {
  std::string name;          ///< "above_centre.z"
  Eigen::Vector3d position;  ///< of the node used.
};

struct Observations {
  std::vector<ObservationRow> rows;
  Eigen::MatrixXd per_load;  ///< U: n_rows x n_loads, m per unit of load.
  Eigen::MatrixXd per_jump;  ///< V: n_rows x n_dofs, m per m.
};

/// The linear bulk condensed onto the faults (docs/model.md, 8), all in the local fault frame:
///
///   t'(step) = t'_0 + Σ_k c_k(step) L_k + α_f Δp_f n − A⁻¹ H g,      u_obs = Σ_k c_k U_k + V g.
struct FaultOperator {
  std::string fingerprint;  ///< of what it depends on; also the file's name.
  FaultGeometry geometry;
  std::shared_ptr<const Compliance> compliance =  ///< H, never null.
      std::make_shared<DenseCompliance>(Eigen::MatrixXd());
  LockedLoads loads;
  Observations observed;

  /// H as a matrix, for files, diagnosis and tests; InternalError where it cannot be had.
  Eigen::Map<const Eigen::MatrixXd> h() const;

  // How it was made: reported, never part of the identity.
  int n_unknowns = 0;  ///< bulk and jump unknowns of the factorised matrix.
  double build_seconds = 0;
  double factor_bytes = 0;
  std::string blas;  ///< library, kernel and threads.
};

}  // namespace faultsim
