#include "simulator/condensation/creep_ladder.h"

#include <utility>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"

namespace faultsim {
namespace {

/// The steps of all materials over Δt.
std::vector<MaxwellStep> maxwell_steps(const BulkProblem& problem, double duration,
                                       MaxwellScheme scheme) {
  std::vector<MaxwellStep> steps;
  for (std::size_t m = 0; m < problem.materials.size(); ++m) {
    steps.push_back(
        maxwell_step(shear_modulus(problem.materials[m]), problem.viscosity[m], duration, scheme));
  }
  return steps;
}

/// Shows the building of one of several operators as a share of the whole.
class ShareMonitor final : public Monitor {
 public:
  ShareMonitor(const RunContext& whole, int part, int n_parts)
      : whole_(whole), part_(part), n_parts_(n_parts) {}
  void progress(double share, const std::string& what) override {
    if (n_parts_ == 1) return whole_.progress(share, what);
    whole_.progress((part_ + share) / n_parts_,
                    concat("operator ", part_ + 1, " of ", n_parts_, ": ", what));
  }
  void note(const std::string& text) override {
    if (part_ == 0) whole_.note(text);
  }

 private:
  const RunContext& whole_;
  int part_, n_parts_;
};

}  // namespace

CreepLadder::CreepLadder(const std::shared_ptr<const BulkProblem>& shared,
                         const std::vector<double>& durations, MaxwellScheme scheme,
                         const RunContext& context) {
  const BulkProblem& problem = *shared;
  FAULTSIM_DEMAND(problem.viscosity.size() == problem.materials.size(), problem.viscosity.size());
  for (const auto& [name, point] : problem.observation_points)
    observed_nodes_.push_back(observed_node(problem.mesh, point));
  std::vector<double> all = {0};
  all.insert(all.end(), durations.begin(), durations.end());
  FactorAnalysis own;  // one for all rungs; a single one leaves nothing behind
  FactorAnalysis* const analysis = context.analysis != nullptr ? context.analysis
                                   : all.size() > 1            ? &own
                                                               : nullptr;
  for (std::size_t i = 0; i < all.size(); ++i) {
    ShareMonitor share(context, static_cast<int>(i), static_cast<int>(all.size()));
    RunContext part(share, context.stop, context.n_threads);
    part.analysis = analysis;
    const std::vector<MaxwellStep> steps = maxwell_steps(problem, all[i], scheme);
    std::shared_ptr<const BulkProblem> relaxed = shared;
    if (i > 0) {
      BulkProblem copy = problem;
      for (std::size_t m = 0; m < steps.size(); ++m)
        copy.materials[m].shear_factor = steps[m].shear_factor;
      relaxed = std::make_shared<const BulkProblem>(std::move(copy));
    }
    auto bulk = std::make_unique<CondensedBulk>(std::move(relaxed), part);
    if (i == 0) {
      cells_ = std::make_unique<CreepCells>(problem.mesh, problem.materials, problem.viscosity,
                                            bulk->dofs());
    }
    std::vector creeping = mapped(cells_->materials(), [&](const int& m) { return steps[m]; });
    FaultOperator op = bulk->condense(part);
    rungs_.push_back({all[i], std::move(creeping), std::move(bulk), std::move(op)});
  }
}

BulkState CreepLadder::at_rest() const {
  const auto n_nodes = rungs_.at(0).bulk->problem().mesh.nodes.size();
  return {cells_->at_rest(), Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(n_nodes))};
}

CreepLadder::History CreepLadder::history(int rung, const BulkState& state,
                                          const Eigen::VectorXd& added) {
  Rung& r = rungs_.at(rung);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(r.op.n_unknowns);
  if (added.size() > 0) force = added;
  for (std::size_t m = 0; m < r.step.size(); ++m) {
    force += r.step[m].relaxed * state.stress.force.col(static_cast<Eigen::Index>(m));
  }
  History history;
  if (force.isZero(0)) {  // at rest, or an elastic step, under the loads of the family
    history.forward = force;
    history.traction = Eigen::VectorXd::Zero(r.op.geometry.n_dofs);
    return history;
  }
  history.forward = r.bulk->forward(force);
  history.traction = r.bulk->locked_traction(history.forward);
  return history;
}

void CreepLadder::advance(int rung, History history, const std::vector<double>& load_increments,
                          const Eigen::VectorXd& jump_increment, BulkState& state) {
  Rung& r = rungs_.at(rung);
  const Eigen::Matrix3Xd u =
      r.bulk->displacement(std::move(history.forward), load_increments, jump_increment);
  cells_->advance(u, r.step, state.stress);
  state.displacement += u;
}

Eigen::VectorXd CreepLadder::observed(const BulkState& state) const {
  Eigen::VectorXd u(3 * static_cast<Eigen::Index>(observed_nodes_.size()));
  for (std::size_t i = 0; i < observed_nodes_.size(); ++i) {
    u.segment<3>(3 * static_cast<Eigen::Index>(i)) = state.displacement.col(observed_nodes_[i]);
  }
  return u;
}

}  // namespace faultsim
