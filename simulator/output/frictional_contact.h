#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>

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

/// What a file says about its problem.
struct FrictionalContactInfo {
  std::string title;
  std::string description;
  std::string math_info;  ///< what is known of existence, uniqueness, W.
};

/// Writes an HDF5 file in the layout of FCLib ("fclib_local": W by compressed columns, all entries;
/// q, mu, spacedim, info) and, if given, the solution; FCLib's readers open it. The units stand as
/// attributes of the vectors and in /faultsim. Replaces an older file; leaves nothing behind when
/// it throws StorageError. @pre sizes agree, everything is finite, (d n)² < 2³¹ (InternalError).
void write_fclib(const std::filesystem::path& path, const FrictionalContactProblem& problem,
                 const FrictionalContactInfo& info, const FrictionalContactSolution* solution);

}  // namespace faultsim
