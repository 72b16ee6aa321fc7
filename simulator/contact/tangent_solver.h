#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "simulator/contact/contact_problem.h"
#include "simulator/contact/moving_block.h"
#include "simulator/linalg/growing_lu.h"

namespace faultsim {

/// A component of the motion that is solved for, and its equation: the row of the tangent
///
///   T_uv = Σ_c weight_c H(dof c of the node, dof of v) + own of v's component if v is of the node.
struct TangentUnknown {
  int node, component, dof;
  std::array<double, 3> weight;  ///< −∂R/∂t' A⁻¹ per dof of the node, 1/m2.
  std::array<double, 2> own;     ///< ∂R/∂Δg_T of the node's own slip, Pa/m.
};

struct TangentReport {
  bool solved = false;  ///< no: the tangent is singular.
  int krylov = -1;      ///< iterations of GMRES; −1: by a factorisation of its own.
};

/// Solves T x = b over the moving nodes, again and again while few of them change. A small system
/// is factorised. A large one is solved by GMRES, whose products take H in single precision
/// (MovingBlock), with a factor that outlives the iteration it was made for: it grows by those who
/// begin to move, passes over those who come to rest, and is made anew where it no longer helps.
/// What the factor has seen decides last digits only, and clear() forgets it.
class TangentSolver {
 public:
  explicit TangentSolver(const ContactProblem& problem);
  void clear();
  /// @param right     b, per unknown, Pa.
  /// @param residual  |b − T x| to be reached, Pa; 0: round-off, in double precision throughout.
  /// What is small goes there anyway.
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
  bool grow_factor(const std::vector<TangentUnknown>& unknowns);
  void fill(GrowingLu<float>::Block& block, int column, int first_row) const;
  void multiply(const std::vector<TangentUnknown>& unknowns, const Eigen::VectorXd& x,
                Eigen::VectorXd& y);
  void precondition(const std::vector<TangentUnknown>& unknowns, const Eigen::VectorXd& x,
                    Eigen::VectorXd& y);
  void forget_factor();

  /// What the factor's columns ask of a row: where its node is in the block, and its weights.
  struct Row {
    int first;
    std::array<float, 3> weight;
  };

  const ContactProblem& problem_;
  MovingBlock block_;
  GrowingLu<float> factor_;
  std::vector<TangentUnknown> factored_;  ///< as they were when they joined the factor.
  std::vector<Row> rows_;                 ///< of the same.
  std::vector<int> place_;  ///< in the factor, per dof of the operator; −1: not there.
  bool tired_ = false;      ///< the factor took many iterations last time.
  Eigen::VectorXf moving_, response_, factor_side_;
  Eigen::MatrixXd direct_;
  GrowingLu<double> direct_lu_;
  std::vector<int> direct_dofs_;  ///< of the unknowns of direct_lu_.
};

}  // namespace faultsim
