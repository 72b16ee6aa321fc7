#pragma once

#include <Eigen/Core>

namespace faultsim {

/// A frictional contact problem with constant friction between a finite number of contacts, in the
/// form that the solvers of contact mechanics share (FCLib; Acary and Cadoux, 2013): find u, r with
///
///   u = W r + q,    K_μ ∋ r ⊥ u + μ|u_T| e_n ∈ K_μ*,    K_μ = {r : |r_T| ≤ μ r_N}
///
/// at each contact; so r_N ≥ 0, u_N ≥ 0, and slip opposes the friction force. Contact k has the
/// components k d .. k d + d − 1, normal first (d = 3: normal, strike, dip; d = 2: normal, shear).
struct FrictionalContactProblem {
  int dimension = 3;         ///< d: 3 or 2.
  Eigen::MatrixXd w;         ///< W (d n x d n), symmetric positive definite.
  Eigen::VectorXd q;         ///< d n.
  Eigen::VectorXd friction;  ///< μ per contact (n).
  /// u and q are in this many metres, r in this many newtons, W in their ratio: powers of ten that
  /// bring W and q near 1, as solvers compare u with r.
  double displacement_unit = 1;
  double force_unit = 1;

  int n_contacts() const { return static_cast<int>(friction.size()); }
};

struct FrictionalContactSolution {
  Eigen::VectorXd u, r;  ///< d n each, in the units of the problem.
};

}  // namespace faultsim
