#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "simulator/contact/contact_problem.h"
#include "simulator/contact/moving_block.h"
#include "simulator/contact/slip_preconditioner.h"
#include "simulator/contact/tangent_unknown.h"
#include "simulator/linalg/growing_lu.h"

namespace faultsim {

struct TangentReport {
  bool solved = false;  ///< no: the tangent is singular.
  int krylov = -1;      ///< iterations of GMRES; −1: by a factorisation of its own.
};

/// Solves T x = b over the moving nodes, again and again while few of them change. A small system
/// is factorised. A large one is solved by GMRES, whose products take H as integers of 16
/// bits (MovingBlock), with a factor that outlives the iteration it was made for
/// (SlipPreconditioner) and is made anew where it no longer helps. What the factor has seen decides
/// last digits only, and clear() forgets it.
class TangentSolver {
 public:
  explicit TangentSolver(const ContactProblem& problem);
  void clear();
  /// @param right     b, per unknown, Pa.
  /// @param residual  |b − T x| to be reached, Pa, but for the 1e-4 |b| by which products of
  /// MovingBlock may be wrong; 0: round-off, in double precision throughout. What is small goes
  /// there anyway.
  /// @param solution  x, per unknown, m.
  TangentReport solve(const std::vector<TangentUnknown>& unknowns, const Eigen::VectorXd& right,
                      double residual, Eigen::VectorXd& solution);

 private:
  void assemble(const std::vector<TangentUnknown>& unknowns);
  TangentReport solve_exactly(const std::vector<TangentUnknown>& unknowns,
                              const Eigen::VectorXd& right, Eigen::VectorXd& solution);
  bool iterate(const std::vector<TangentUnknown>& unknowns, const Eigen::VectorXd& right,
               double residual, Eigen::VectorXd& solution, int& iterations);
  void cover(const std::vector<TangentUnknown>& unknowns);
  void multiply(const std::vector<TangentUnknown>& unknowns, const Eigen::VectorXd& x,
                Eigen::VectorXd& y);

  const ContactProblem& problem_;
  MovingBlock block_;
  SlipPreconditioner preconditioner_;
  bool tired_ = false;       ///< the preconditioner took many iterations last time.
  std::vector<int> places_;  ///< in the block, of the nodes of the unknowns.
  Eigen::VectorXf moving_, response_;
  Eigen::MatrixXd direct_;
  GrowingLu<double> direct_lu_;
  std::vector<int> direct_dofs_;  ///< of the unknowns of direct_lu_.
};

}  // namespace faultsim
