#include "simulator/contact/step_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

using Wide = long double;
using WideVector = Eigen::Matrix<Wide, Eigen::Dynamic, 1>;

/// Keeps the worst; what is not finite is infinitely wrong.
void raise(double& worst, Wide value) {
  if (!std::isfinite(value)) value = std::numeric_limits<Wide>::infinity();
  worst = std::max(worst, static_cast<double>(value));
}

/// H g and Σ_j |H_ij g_j|, over the columns that move.
struct Product {
  WideVector value, size;
};
Product multiply(const FaultOperator& op, const Eigen::VectorXd& jump) {
  Product product{WideVector::Zero(jump.size()), WideVector::Zero(jump.size())};
  for (Eigen::Index j = 0; j < jump.size(); ++j) {
    if (jump[j] == 0) continue;
    const WideVector column =
        op.compliance->column(static_cast<int>(j)).cast<Wide>() * static_cast<Wide>(jump[j]);
    product.value += column;
    product.size += column.cwiseAbs();
  }
  return product;
}

class Checker {
 public:
  Checker(const FaultOperator& op, const ContactLaws& laws, const AcceptedStep& step)
      : op_(op), laws_(laws), step_(step), nodes_(op.geometry.nodes) {
    const Eigen::Index n = op.geometry.n_dofs;
    FAULTSIM_DEMAND(step.locked.size() == n && step.locked_before.size() == n &&
                        step.before.jump.size() == n && step.after.jump.size() == n &&
                        laws.size() == nodes_.size(),
                    "n_dofs ", n, " locked ", step.locked.size());
    area_ = op.geometry.dof_area.cast<Wide>();
    set_levels();
    traction_ = step.after.traction.cast<Wide>();
    if (!step.elastic) return;
    before_ = multiply(op, step.before.jump);
    after_ = multiply(op, step.after.jump);
    traction_ = step.locked.cast<Wide>() - after_.value.cwiseQuotient(area_);
  }

  StepCheck run() {
    if (!step_.after.jump.allFinite() || !step_.after.traction.allFinite() ||
        !step_.locked.allFinite()) {
      check_.equilibrium = std::numeric_limits<double>::infinity();
      return check_;
    }
    for (std::size_t k = 0; k < nodes_.size(); ++k) check_node(k);
    if (step_.elastic) check_energies();
    return check_;
  }

 private:
  void set_levels();
  void check_node(std::size_t k);
  void check_closed(std::size_t k);
  void check_flow(std::size_t k, Wide shear, Wide limit);
  void check_energies();
  Wide stiffness(int dof) const {
    return static_cast<Wide>(op_.compliance->diagonal(dof)) / area_[dof];
  }
  template <typename Vector>
  Eigen::Matrix<Wide, 2, 1> shear_part(std::size_t k, const Vector& values) const {
    const auto& dof = nodes_[k].dof;
    return {dof[1] >= 0 ? static_cast<Wide>(values[dof[1]]) : 0,
            dof[2] >= 0 ? static_cast<Wide>(values[dof[2]]) : 0};
  }

  const FaultOperator& op_;
  const ContactLaws& laws_;
  const AcceptedStep& step_;
  const std::vector<OperatorNode>& nodes_;
  WideVector area_, traction_;
  std::vector<Wide> level_;  // S per node, Pa
  Product before_, after_;
  StepCheck check_;
};

void Checker::set_levels() {
  level_.assign(nodes_.size(), 0);
  Wide highest = std::numeric_limits<Wide>::min();  // a fault without any load has no level
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    for (const int d : nodes_[k].dof) {
      if (d < 0) continue;
      const double trial =
          step_.before.traction[d] + (step_.elastic ? step_.locked[d] - step_.locked_before[d] : 0);
      for (const double value : {step_.locked_before[d], step_.locked[d], step_.before.traction[d],
                                 step_.after.traction[d], trial}) {
        level_[k] = std::max(level_[k], static_cast<Wide>(std::abs(value)));
      }
    }
    highest = std::max(highest, level_[k]);
  }
  for (Wide& level : level_) level = std::max(level, highest / 1000);
}

void Checker::check_node(std::size_t k) {
  const OperatorNode& node = nodes_[k];
  const Wide level = level_[k];
  for (const int d : node.dof) {
    if (d < 0) continue;
    raise(check_.equilibrium,
          std::abs(static_cast<Wide>(step_.after.traction[d]) - traction_[d]) / level);
  }
  const Wide gap = step_.after.jump[node.dof[0]];
  if (gap < 0) raise(check_.penetration, -gap * stiffness(node.dof[0]) / level);
  if (gap > 0 || step_.after.state[k] == FaultState::open) {
    const Wide normal = std::abs(traction_[node.dof[0]]);
    raise(check_.open_traction, std::max(normal, shear_part(k, traction_).norm()) / level);
    return;
  }
  check_closed(k);
}

void Checker::check_closed(std::size_t k) {
  const Wide normal = traction_[nodes_[k].dof[0]];
  raise(check_.tension, std::max<Wide>(normal, 0) / level_[k]);
  const FrictionState state = friction_state(nodes_[k], step_.after, static_cast<int>(k));
  const Wide limit = NodeLaw(laws_[k]).limit(static_cast<double>(normal), state);
  const Wide shear = shear_part(k, traction_).norm();
  raise(check_.over_limit, std::max<Wide>(shear - limit, 0) / level_[k]);
  if (step_.at_once) check_flow(k, shear, limit);
}

/// Slip of the step along the traction, at the limit.
void Checker::check_flow(std::size_t k, Wide shear, Wide limit) {
  const auto slip = (shear_part(k, step_.after.jump) - shear_part(k, step_.before.jump)).eval();
  const Wide length = slip.norm();
  if (length == 0) return;
  const auto traction = shear_part(k, traction_).eval();
  raise(check_.below_limit, std::max<Wide>(limit - shear, 0) / level_[k]);
  Wide softest = 0;
  for (const int d : {nodes_[k].dof[1], nodes_[k].dof[2]}) {
    if (d >= 0) softest = std::max(softest, stiffness(d));
  }
  constexpr Wide kRoundOff = 1e-6L;
  const Wide counts = std::min<Wide>(1, softest * length / (kRoundOff * level_[k]));
  raise(check_.misaligned, counts * (traction - shear * slip / length).norm() / level_[k]);
  raise(check_.negative_dissipation,
        counts * std::max<Wide>(-traction.dot(slip), 0) / (level_[k] * length));
}

/// Work of the reported tractions against what bulk and loads give; the strain energy of the jumps.
void Checker::check_energies() {
  const WideVector from = step_.before.jump.cast<Wide>(), to = step_.after.jump.cast<Wide>();
  const WideVector slip = to - from;
  const WideVector traction = (step_.before.traction + step_.after.traction).cast<Wide>();
  const WideVector locked = (step_.locked_before + step_.locked).cast<Wide>();
  const Wide work = 0.5L * area_.cwiseProduct(traction).dot(slip);
  const Wide given = 0.5L * area_.cwiseProduct(locked).dot(slip) -
                     0.5L * (to.dot(after_.value) - from.dot(before_.value));
  // A step that moves next to nothing changes energies by their rounding only.
  constexpr Wide kSmallShare = 1e-6L;
  const Wide size = to.cwiseAbs().dot(after_.size);
  Wide scale = kSmallShare / 2 * std::max(size, from.cwiseAbs().dot(before_.size));
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    for (const int d : nodes_[k].dof) {
      if (d >= 0) scale += area_[d] * level_[k] * std::abs(slip[d]);
    }
  }
  if (scale > 0) raise(check_.energy, std::abs(work - given) / scale);
  if (size > 0) raise(check_.negative_energy, std::max<Wide>(-to.dot(after_.value), 0) / size);
}

}  // namespace

double StepCheck::largest_residual() const {
  return std::max(
      {equilibrium, tension, penetration, over_limit, below_limit, misaligned, open_traction});
}

double StepCheck::largest_energy() const {
  return std::max({energy, negative_dissipation, negative_energy});
}

void StepCheck::take_worst(const StepCheck& other) {
  for (double StepCheck::*number :
       {&StepCheck::equilibrium, &StepCheck::tension, &StepCheck::penetration,
        &StepCheck::over_limit, &StepCheck::below_limit, &StepCheck::misaligned,
        &StepCheck::open_traction, &StepCheck::energy, &StepCheck::negative_dissipation,
        &StepCheck::negative_energy}) {
    this->*number = std::max(this->*number, other.*number);
  }
}

StepCheck check_step(const FaultOperator& op, const ContactLaws& laws, const AcceptedStep& step) {
  return Checker(op, laws, step).run();
}

}  // namespace faultsim
