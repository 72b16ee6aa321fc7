#pragma once

#include <cstdint>
#include <vector>

#include "simulator/contact/bordered_lu.h"
#include "simulator/contact/contact_newton.h"
#include "simulator/contact/contact_problem.h"

namespace faultsim {

/// The fast path for ContactProblem::scalar while nothing opens. With slip signs σ_i the slip
/// equations are linear,
///
///   Σ_j (H_TT + σ_i tan φ_i H_NT)_ij Δg_j = A_i σ_i (σ_i t'_T − c + tan φ_i t'_N)_i,
///
/// so each active set costs one solve; and the matrix is the same at each load step, so its factor
/// is kept between passes and steps and only grown by the nodes that join (bordered_lu.h). It
/// depends on nothing but the operator, the laws, the set and its signs: the factor kept from an
/// earlier step is the factor that would be built anew, up to the order of the nodes.
class ScalarSlip {
 public:
  ScalarSlip(ContactProblem& problem, const ContactOptions& options, StopToken stop = {});
  /// @pre problem.scalar, no gap at the start, sub_step.traction = trial.
  /// @returns not converged when the set cycles or a node would open: take ContactNewton.
  SearchHistory solve(SubStep& sub_step);

 private:
  bool add_violators(const SubStep& sub_step, bool& opens);
  bool add_neighbours(const SubStep& sub_step);
  void synchronise();
  bool append(int k);
  bool solve_set(const SubStep& sub_step);
  bool release_wrong_way();
  void note(SearchHistory& history);

  ContactProblem& problem_;
  const ContactOptions& options_;
  StopToken stop_;
  BorderedLu lu_;
  std::vector<int> order_;           ///< nodes in the factor.
  std::vector<signed char> signs_;   ///< their slip signs there, per node of order_.
  std::vector<signed char> wanted_;  ///< per node: slip sign, 0 = stick.
  std::vector<signed char> placed_;  ///< per node: in the factor.
  std::vector<int> order_dof_;       ///< shear dof per node of order_.
  std::vector<int> near_limit_;      ///< stick nodes near their limit at the last full look.
  std::vector<double> slip_;
  SeenSets seen_;
};

}  // namespace faultsim
