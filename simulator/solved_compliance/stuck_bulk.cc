#include "simulator/solved_compliance/stuck_bulk.h"

#include <Eigen/QR>
#include <ctime>
#include <utility>

#include "simulator/elasticity/held.h"
#include "simulator/elasticity/rigid_modes.h"

namespace faultsim {
namespace {

double seconds_of_processor() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Where unknowns of the bulk stand in a vector of three slots per place: multigrid wants three
/// unknowns per node, and places where a component is prescribed have fewer.
struct Slots {
  std::vector<int> of;                     ///< per unknown r, ascending.
  std::vector<Eigen::Vector3d> positions;  ///< of the places, m.
  int n() const { return 3 * static_cast<int>(positions.size()); }
};

Slots slots_of(const Mesh& mesh, const DofMap& dofs) {
  const UnknownGroups& groups = dofs.bulk_groups();
  Slots slots{std::vector<int>(groups.of.size()), std::vector<Eigen::Vector3d>(groups.n)};
  for (int node = 0; node < static_cast<int>(mesh.nodes.size()); ++node) {
    for (int c = 0; c < 3; ++c) {
      for (const DofMap::Term& term : dofs.terms(node, c)) {
        if (term.unknown >= dofs.n_bulk()) continue;
        const int place = groups.of[term.unknown];
        slots.of[term.unknown] = 3 * place + c;
        slots.positions[place] = mesh.nodes[node];
      }
    }
  }
  return slots;
}

Eigen::MatrixXd rigid_motions(const Mesh& mesh, const Slots& slots) {
  const RigidModes modes = rigid_modes(
      mesh, [](int) { return true; }, [](int, int) { return false; });
  Eigen::MatrixXd motions(slots.n(), 6);
  for (std::size_t i = 0; i < slots.positions.size(); ++i)
    motions.middleRows(3 * static_cast<Eigen::Index>(i), 3) = modes.at(slots.positions[i]);
  return Eigen::HouseholderQR<Eigen::MatrixXd>(motions).householderQ() *
         Eigen::MatrixXd::Identity(slots.n(), 6);
}

/// K_rr over the slots, both triangles, and the mean diagonal where a slot has no unknown.
SparseMatrix bulk_block(const SparseMatrix& lower, int n_bulk, const Slots& slots) {
  SparseMatrix block(slots.n(), slots.n());
  block.reserve(lower.nonZeros());
  const double mean = lower.diagonal().head(n_bulk).mean();
  int unknown = 0;
  for (int slot = 0; slot < slots.n(); ++slot) {
    block.startVec(slot);
    if (unknown == n_bulk || slots.of[unknown] != slot) {
      block.insertBack(slot, slot) = mean;
      continue;
    }
    for (SparseMatrix::InnerIterator it(lower, unknown); it && it.row() < n_bulk; ++it)
      block.insertBack(slots.of[it.row()], slot) = it.value();
    ++unknown;
  }
  block.finalize();
  const SparseMatrix both = block.selfadjointView<Eigen::Lower>();
  return both;
}

/// K_gr, n_jump x n_bulk.
SparseMatrix coupling_block(const SparseMatrix& lower, int n_bulk) {
  return lower.bottomLeftCorner(lower.rows() - n_bulk, n_bulk);
}

SparseMatrix jump_block(const SparseMatrix& lower, int n_bulk) {
  const SparseMatrix corner = lower.bottomRightCorner(lower.rows() - n_bulk, lower.rows() - n_bulk);
  return corner.selfadjointView<Eigen::Lower>();
}

}  // namespace

struct StuckBulk::Impl {
  Impl(std::shared_ptr<const BulkProblem> given, const SolverChoice& choice, double how_exact)
      : shared(std::move(given)),
        solver(choice),
        tolerance(how_exact),
        dofs(shared->mesh, shared->conditions, static_cast<int>(shared->loads.size())) {}

  void set_up();
  Eigen::VectorXd in_slots(const Eigen::VectorXd& bulk) const;

  std::shared_ptr<const BulkProblem> shared;
  SolverChoice solver;
  double tolerance;
  DofMap dofs;
  Slots slots;
  SparseMatrix k_rr, k_gr, k_gg;  ///< k_rr over slots.
  Eigen::VectorXd jump_diagonal;
  LinearMap precondition;
  StopToken stop;
  Work work;
};

void StuckBulk::Impl::set_up() {
  const BulkProblem& problem = *shared;
  slots = slots_of(problem.mesh, dofs);
  const int n_bulk = dofs.n_bulk();
  {
    const SparseMatrix lower =
        assemble_stiffness(problem.mesh, problem.materials, dofs, problem.mean_dilatation);
    k_gr = coupling_block(lower, n_bulk);
    k_gg = jump_block(lower, n_bulk);
    k_rr = bulk_block(lower, n_bulk, slots);
  }
  jump_diagonal = k_gg.diagonal();
  SaddlePoint bulk;
  bulk.lend_leading(k_rr, rigid_motions(problem.mesh, slots));
  precondition = leading_block(solver.leading, std::move(bulk), solver.fsai, solver.ilu);
}

Eigen::VectorXd StuckBulk::Impl::in_slots(const Eigen::VectorXd& bulk) const {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(slots.n());
  for (std::size_t i = 0; i < slots.of.size(); ++i) values[slots.of[i]] = bulk[i];
  return values;
}

StuckBulk::StuckBulk(std::shared_ptr<const BulkProblem> problem, const SolverChoice& solver,
                     double tolerance) {
  if (solver.leading == LeadingKind::ilu) {
    throw InputError("coupled path",
                     "columns of H are solved for by conjugate gradients, which ilu cannot "
                     "precondition: it is not symmetric",
                     "use amg, amg-u, ic, fsai or exact (--leading)");
  }
  const double start = seconds_of_processor();
  impl_ = std::make_unique<Impl>(std::move(problem), solver, tolerance);
  require_held(impl_->shared->mesh, impl_->dofs);
  impl_->set_up();
  impl_->work.setup_seconds = seconds_of_processor() - start;
}

StuckBulk::~StuckBulk() = default;

const BulkProblem& StuckBulk::problem() const { return *impl_->shared; }
const DofMap& StuckBulk::dofs() const { return impl_->dofs; }
const Eigen::VectorXd& StuckBulk::jump_diagonal() const { return impl_->jump_diagonal; }
void StuckBulk::heed(StopToken stop) const { impl_->stop = stop; }
const StuckBulk::Work& StuckBulk::work() const { return impl_->work; }

Eigen::VectorXd StuckBulk::jump_forces(const Eigen::VectorXd& g) const {
  Eigen::VectorXd force(impl_->dofs.n_unknowns());
  force << impl_->k_gr.transpose() * g, impl_->k_gg * g;
  return force;
}

StuckBulk::Response StuckBulk::respond(const Eigen::VectorXd& force) const {
  Impl& self = *impl_;
  const int n_bulk = self.dofs.n_bulk(), n_jump = self.dofs.n_jump();
  FAULTSIM_DEMAND(force.size() == n_bulk + n_jump, force.size(), " of ", n_bulk, " and ", n_jump);
  const double start = seconds_of_processor();
  Response response;
  Eigen::VectorXd x;
  // By columns of the symmetric matrix each entry of a product is one sum.
  response.report = conjugate_gradients(
      [&](const Eigen::VectorXd& v, Eigen::VectorXd& w) {
        self.stop.throw_if_requested("solving for what a jump does");
        w = self.k_rr.transpose() * v;
      },
      self.precondition, self.in_slots(force.head(n_bulk)), self.tolerance,
      self.solver.max_iterations, x);
  ++self.work.n_solves;
  self.work.iterations.push_back(response.report.iterations);
  self.work.solve_seconds += seconds_of_processor() - start;
  if (!response.report.converged) {
    throw Unsolved(concat("conjugate gradients (", to_string(self.solver.leading),
                          ") do not reach ", self.tolerance, " within ", self.solver.max_iterations,
                          " iterations: use another --leading (exact, amg or amg-u), or the "
                          "condensed path"));
  }
  response.r.resize(n_bulk);
  for (int i = 0; i < n_bulk; ++i) response.r[i] = x[self.slots.of[static_cast<std::size_t>(i)]];
  response.jumps = force.tail(n_jump) - self.k_gr * response.r;
  return response;
}

}  // namespace faultsim
