#include "simulator/contact/judge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

using Wide = long double;
using WideVector = Eigen::Matrix<Wide, Eigen::Dynamic, 1>;
using Shear = Eigen::Matrix<Wide, 2, 1>;

constexpr std::array kMisses = {&Misses::equilibrium,   &Misses::tension,     &Misses::penetration,
                                &Misses::over_limit,    &Misses::below_limit, &Misses::misaligned,
                                &Misses::open_traction, &Misses::memory};

/// What is not finite is infinitely wrong.
double as_miss(Wide value) {
  return std::isfinite(value) ? static_cast<double>(std::max<Wide>(value, 0))
                              : std::numeric_limits<double>::infinity();
}

/// tan φ after the slip s, m.
Wide friction_coefficient(const CoulombLaw& law, Wide s) {
  const Wide share = std::min<Wide>(s / law.slip_weakening_distance, 1);
  const Wide angle_s = law.static_friction_angle, angle_d = law.dynamic_friction_angle;
  if (law.weakening == WeakeningLaw::angle) return std::tan(angle_s + (angle_d - angle_s) * share);
  return std::tan(angle_s) + (std::tan(angle_d) - std::tan(angle_s)) * share;
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

class Judge {
 public:
  Judge(const FaultOperator& op, const ContactLaws& laws, const AcceptedStep& step)
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

  Verdict run() {
    if (!step_.after.jump.allFinite() || !step_.after.traction.allFinite() ||
        !step_.locked.allFinite()) {
      verdict_.pascal.equilibrium = verdict_.relative.equilibrium =
          std::numeric_limits<double>::infinity();
      return verdict_;
    }
    for (std::size_t k = 0; k < nodes_.size(); ++k) judge_node(k);
    if (step_.elastic) judge_energies();
    return verdict_;
  }

 private:
  void set_levels();
  void judge_node(std::size_t k);
  void judge_closed(std::size_t k);
  void judge_flow(std::size_t k, const Shear& traction, const Shear& slip);
  void judge_memory(std::size_t k, Wide slip);
  void judge_energies();
  void miss(double Misses::*condition, std::size_t k, Wide pascal);

  bool is_open(std::size_t k) const {
    return step_.after.state[k] == FaultState::open || step_.after.jump[nodes_[k].dof[0]] > 0;
  }
  Wide stiffness(int dof) const {
    constexpr Wide kWithoutOperator = 1e9L;  // Pa/m, of the order of rock
    if (op_.compliance->size() == 0) return kWithoutOperator;
    return static_cast<Wide>(op_.compliance->diagonal(dof)) / area_[dof];
  }
  Wide shear_stiffness(std::size_t k) const {
    Wide largest = 0;
    for (const int d : {nodes_[k].dof[1], nodes_[k].dof[2]}) {
      if (d >= 0) largest = std::max(largest, stiffness(d));
    }
    return largest;
  }
  template <typename Vector>
  Shear shear_part(std::size_t k, const Vector& values) const {
    const auto& dof = nodes_[k].dof;
    return {dof[1] >= 0 ? static_cast<Wide>(values[dof[1]]) : 0,
            dof[2] >= 0 ? static_cast<Wide>(values[dof[2]]) : 0};
  }
  Wide limit(std::size_t k) const;

  const FaultOperator& op_;
  const ContactLaws& laws_;
  const AcceptedStep& step_;
  const std::vector<OperatorNode>& nodes_;
  WideVector area_, traction_;
  std::vector<Wide> level_;  // S per node, Pa
  Product before_, after_;
  Verdict verdict_;
};

void Judge::set_levels() {
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

void Judge::miss(double Misses::*condition, std::size_t k, Wide pascal) {
  const double relative = as_miss(pascal / level_[k]);
  if (relative > verdict_.relative.largest()) verdict_.node = static_cast<int>(k);
  verdict_.relative.*condition = std::max(verdict_.relative.*condition, relative);
  verdict_.pascal.*condition = std::max(verdict_.pascal.*condition, as_miss(pascal));
}

void Judge::judge_node(std::size_t k) {
  const OperatorNode& node = nodes_[k];
  for (const int d : node.dof) {
    if (d < 0) continue;
    miss(&Misses::equilibrium, k,
         std::abs(static_cast<Wide>(step_.after.traction[d]) - traction_[d]));
  }
  const Wide gap = step_.after.jump[node.dof[0]];
  if (gap < 0) miss(&Misses::penetration, k, -gap * stiffness(node.dof[0]));
  const Shear slip = shear_part(k, step_.after.jump) - shear_part(k, step_.before.jump);
  judge_memory(k, slip.norm());
  if (is_open(k)) {
    const Wide normal = std::abs(traction_[node.dof[0]]);
    miss(&Misses::open_traction, k, std::max(normal, shear_part(k, traction_).norm()));
    return;
  }
  judge_closed(k);
}

/// τ_L of a closed node at the end of the step, Pa.
Wide Judge::limit(std::size_t k) const {
  const CoulombLaw& law = laws_[k];
  const Wide slip = law.slip_measure == SlipMeasure::cumulated
                        ? static_cast<Wide>(step_.after.slip_path[k])
                        : shear_part(k, step_.after.jump).norm();
  const Wide cohesion = step_.after.cohesion_lost[k] != 0 ? 0 : law.cohesion;
  const Wide pressing = std::max<Wide>(-traction_[nodes_[k].dof[0]], 0);
  return cohesion + pressing * friction_coefficient(law, slip);
}

void Judge::judge_closed(std::size_t k) {
  miss(&Misses::tension, k, traction_[nodes_[k].dof[0]]);
  const Shear traction = shear_part(k, traction_);
  const Shear slip = shear_part(k, step_.after.jump) - shear_part(k, step_.before.jump);
  const Wide spare = limit(k) - traction.norm();
  const bool slipped = step_.at_once && slip.norm() > 0;
  miss(&Misses::over_limit, k, -spare);
  if (slipped || step_.after.state[k] == FaultState::slip) miss(&Misses::below_limit, k, spare);
  if (slipped) judge_flow(k, traction, slip);
}

/// Slip of the step along the traction.
void Judge::judge_flow(std::size_t k, const Shear& traction, const Shear& slip) {
  const Wide length = slip.norm();
  constexpr Wide kRoundOff = 1e-6L;
  const Wide counts = std::min<Wide>(1, shear_stiffness(k) * length / (kRoundOff * level_[k]));
  miss(&Misses::misaligned, k, counts * (traction - traction.norm() * slip / length).norm());
  verdict_.negative_dissipation = std::max(
      verdict_.negative_dissipation, as_miss(-counts * traction.dot(slip) / (level_[k] * length)));
}

/// The path goes on by the slip, and cohesion ends where the law ends it, for good and not before.
void Judge::judge_memory(std::size_t k, Wide slip) {
  const CoulombLaw& law = laws_[k];
  const Wide path = static_cast<Wide>(step_.after.slip_path[k]) - step_.before.slip_path[k];
  const Wide astray = step_.at_once ? std::abs(path - slip) : std::max<Wide>(slip - path, -path);
  if (!(astray <= 0)) miss(&Misses::memory, k, astray * shear_stiffness(k));
  const bool lost = step_.after.cohesion_lost[k] != 0;
  const bool lost_before = step_.before.cohesion_lost[k] != 0;
  const bool must_be_lost = lost_before || (is_open(k) && !law.cohesion_after_opening) ||
                            (path > 0 && !law.cohesion_after_slip);
  // A node may have been open on the way, which its last state does not show.
  const bool may_be_lost = must_be_lost || !law.cohesion_after_opening;
  if (lost ? !may_be_lost : must_be_lost) miss(&Misses::memory, k, law.cohesion);
}

/// Work of the given tractions against what bulk and loads give; the strain energy of the jumps.
void Judge::judge_energies() {
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
  if (scale > 0) verdict_.energy = as_miss(std::abs(work - given) / scale);
  if (size > 0) verdict_.negative_energy = as_miss(-to.dot(after_.value) / size);
}

}  // namespace

double Misses::largest() const {
  double largest = 0;
  for (const auto condition : kMisses) largest = std::max(largest, this->*condition);
  return largest;
}

double Verdict::largest_energy() const {
  return std::max({energy, negative_dissipation, negative_energy});
}

void Verdict::take_worst(const Verdict& other) {
  if (other.relative.largest() > relative.largest()) node = other.node;
  for (const auto condition : kMisses) {
    pascal.*condition = std::max(pascal.*condition, other.pascal.*condition);
    relative.*condition = std::max(relative.*condition, other.relative.*condition);
  }
  for (double Verdict::*number :
       {&Verdict::energy, &Verdict::negative_dissipation, &Verdict::negative_energy}) {
    this->*number = std::max(this->*number, other.*number);
  }
}

Verdict judge_step(const FaultOperator& op, const ContactLaws& laws, const AcceptedStep& step) {
  return Judge(op, laws, step).run();
}

}  // namespace faultsim
