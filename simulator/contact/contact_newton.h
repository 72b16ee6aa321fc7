#pragma once

#include <cstdint>
#include <vector>

#include "simulator/contact/contact_options.h"
#include "simulator/contact/contact_problem.h"
#include "simulator/contact/search_record.h"
#include "simulator/contact/slip_residual.h"
#include "simulator/contact/tangent_solver.h"
#include "simulator/contact/watched_rows.h"

namespace faultsim {

/// Semismooth Newton with an active set that is revised at each iteration: unknowns are Δg_T of
/// slipping nodes and all of Δg of open ones; stick nodes are eliminated. The tangent is the
/// consistent one of slip_residual.h. A set seen before switches to a line search on the natural
/// residual, which lets only a share of the nodes change state.
class ContactNewton {
 public:
  ContactNewton(ContactProblem& problem, const ContactOptions& options, StopToken stop = {});
  /// Starts from sub_step.increment and state; leaves its last iterate there in any case.
  /// @param patience  gives up after so many iterations without progress of the natural residual:
  /// where strength falls with slip there may be nothing to find, and a smaller sub-step is better
  /// than a long search. 0 = only the bounds of ContactOptions.
  SearchHistory solve(SubStep& sub_step, int patience = 0);

 private:
  /// The natural residual over the nodes watched, in units of their tolerances.
  struct Residual {
    double square_sum = 0, worst = 0;
    bool within_tolerance() const { return worst <= 1; }
  };
  void begin(const SubStep& sub_step);
  int classify(SubStep& sub_step);
  SlipPoint slip_point(const SubStep& sub_step, const Eigen::VectorXd& traction,
                       const Eigen::VectorXd& increment, int k) const;
  Residual natural_residual(const SubStep& sub_step, const Eigen::VectorXd& traction,
                            const Eigen::VectorXd& increment) const;
  Residual natural_residual(const SubStep& sub_step) const {
    return natural_residual(sub_step, sub_step.traction, sub_step.increment);
  }
  bool may_watch(bool line_search) const;
  void look_at_all(SubStep& sub_step);
  void prescribe(const SubStep& sub_step);
  void linearise(const SubStep& sub_step);
  void collect_node(const SubStep& sub_step, int k);
  double wanted_residual(const SubStep& sub_step) const;
  bool solve_linear(const SubStep& sub_step);
  double advance(SubStep& sub_step, bool line_search);
  bool finish(SubStep& sub_step);
  bool aligned(const SubStep& sub_step) const;
  bool lose_cohesion(SubStep& sub_step);

  ContactProblem& problem_;
  const ContactOptions& options_;
  StopToken stop_;
  std::vector<TangentUnknown> unknowns_;
  TangentSolver tangent_;
  WatchedRows watched_;
  SeenSets seen_;
  std::vector<char> was_open_;
  Eigen::VectorXd direction_, response_, right_, trial_increment_, trial_traction_;
  bool set_stands_ = false;  ///< the active set did not change in the last iteration.
  bool fresh_ = false;       ///< tractions of all are those of the increment, to round-off.
  int krylov_ = -1;          ///< of the last linear solve: SearchIteration::krylov.
};

}  // namespace faultsim
