#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "simulator/contact/contact.h"
#include "simulator/coupled/held_responses.h"
#include "simulator/coupled/linear_steps.h"

namespace faultsim {

struct CoupledContactOptions {
  SolverChoice solver = {};
  /// Of tractions, relative to the largest of the load and of the step: a Newton step that changes
  /// less is the last one.
  double traction_tolerance = 1e-9;
  /// Of a linear step, relative to its right-hand side: the loosest (ForcingTerm).
  double krylov_tolerance = 1e-3;
  int max_newton_iterations = 60;
  StopToken stop = {};  ///< asked before each iteration of GMRES: Interrupted.
};

/// What drives a load step; both count from the start of the history.
struct CoupledLoad {
  std::vector<double> factors;  ///< c_k, one per unit load of the bulk.
  Eigen::VectorXd
      background;  ///< t'_0 + α_f Δp_f n over fault dofs, Pa: t' if the bulk were rigid.
};

struct CoupledStepReport {
  bool converged = false;
  std::string reason;    ///< why not.
  StepCoupled linear;    ///< an entry of krylov_iterations per Newton iteration.
  SearchHistory newton;  ///< as the condensed path tells it; residual: change per tolerance.
  int newton_iterations() const { return newton.iterations; }
};

/// Frictional contact without condensation (model section 11), load step by load step: Newton with
/// an active set over displacements of both sides and tractions,
///
///   K u + C (t' − t'_b) = Σ_k c_k f_k,      g = A⁻¹ Cᵀ u,
///
/// with (3)–(5) at the nodes, each linear step solved only as far as Newton gains by it. Fault dofs
/// are those of the operator that condensation makes of the same bulk; within, those of a node
/// follow those of the node before. A node that is to slip is linearised at the slip that its
/// augmented traction y = t'_T + r Δg_T promises, (|y| − τ_L)/r along y, which stays finite when
/// slip begins.
///
/// Newton starts from the response of a body whose faults rest, as far as steps before tell it. A
/// load step is taken at once; instabilities are not followed: a step without solution next to
/// the last one does not converge.
class CoupledContact {
 public:
  /// @param laws  over the nodes that may jump; loss of cohesion by slip is not taken
  /// (InternalError).
  CoupledContact(const TwoSidedBulk& bulk, const ContactLaws& laws,
                 const CoupledContactOptions& options);

  int n_dofs() const { return static_cast<int>(dof_.size()); }
  /// Takes `state` and the displacements `u` (own rows, zero at first) to the end of a load step.
  /// Not converged, or stopped (Interrupted): both are left as they were. Collective; loads and
  /// state are those of all fault dofs on every rank, and so is the report.
  CoupledStepReport advance(const CoupledLoad& load, ContactState& state, Eigen::VectorXd& u) const;

 private:
  struct Node {
    int fault_node, first, n_dofs;  ///< of bulk.fault_nodes(); fault dofs, n first.
    std::array<int, 2> shear;       ///< dofs of strike and dip; −1 = none.
    double area, stiffness;         ///< m2; r, Pa/m.
    NodeLaw law;
  };
  struct Iterate;
  void classify(const ContactState& before, Iterate& at, double tolerance) const;
  bool turned_back(const Iterate& at, int k) const;
  void linearise(const ContactState& before, Iterate& at) const;
  double improve(const Eigen::VectorXd& force, const ContactState& before, ForcingTerm& forcing,
                 Iterate& at, CoupledStepReport& report) const;
  void iterate(const Eigen::VectorXd& force, double level, double residual,
               const ContactState& before, Iterate& at, CoupledStepReport& report) const;
  void settle(double tolerance, const ContactState& before, Iterate& at, ContactState& state) const;
  static FrictionState state_of(const Node& node, const ContactState& state, int k);
  SlippingPoint point_of(const ContactState& before, const Iterate& at, int k) const;
  Eigen::VectorXd of_all(const Eigen::VectorXd& own) const;
  bool owns(const Node& node) const { return bulk_.owns(bulk_.fault_nodes()[node.fault_node]); }

  const TwoSidedBulk& bulk_;
  CoupledContactOptions options_;
  SaddlePoint all_held_;       ///< its C is that of all own fault dofs,
  std::vector<int> own_;       ///< which are these;
  std::vector<int> gathered_;  ///< and those of all ranks, one after another.
  std::vector<Node> nodes_;
  Eigen::VectorXd inverse_area_;  ///< per fault dof.
  std::vector<int> dof_;          ///< of the operator, per fault dof.
  std::vector<Eigen::VectorXd> loads_;
  mutable LinearSteps linear_;  ///< its preconditioner is kept from step to step,
  mutable HeldResponses held_;  ///< and so is what steps without slip say of the next.
};

}  // namespace faultsim
