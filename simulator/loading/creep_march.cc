#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "simulator/common/errors.h"
#include "simulator/common/text.h"
#include "simulator/condensation/creep_ladder.h"
#include "simulator/loading/case_contact.h"
#include "simulator/loading/step_solver.h"
#include "simulator/operators/prepare_operator.h"

namespace faultsim {
namespace {

ContactLaws without_following(ContactLaws laws) {
  for (CoulombLaw& law : laws) law.damping = 0;
  return laws;
}

/// A⁻¹ H g over the columns with g ≠ 0, n_dofs, Pa.
Eigen::VectorXd elastic_traction_drop(const FaultOperator& op, const Eigen::VectorXd& jump) {
  Eigen::VectorXd drop = Eigen::VectorXd::Zero(op.geometry.n_dofs);
  for (Eigen::Index d = 0; d < jump.size(); ++d) {
    if (jump[d] != 0) drop += jump[d] * op.compliance->column(static_cast<int>(d));
  }
  return drop.cwiseQuotient(op.geometry.dof_area);
}

/// Walks a case whose salt creeps, load step by load step, on the rungs of its ladder.
///
/// Step 0 is elastic. Over a time step Δt the faults carry, if they stay as they are,
///
///   t'_n + (history of the salt) + Σ Δc_k L_k(Δt) + α_f δp_f n,
///
/// from which contact is solved with H_Δt. Time steps are fixed (`creep_time_step`) or controlled:
/// a step is taken once whole and once in halves; where the tractions differ by more than
/// `creep_tolerance` the halves are halved, as far as the ladder goes; the finer answer is kept.
///
/// Slip that the relaxing bulk cannot hold (outcome unstable on a rung) makes the step shorter. On
/// the shortest the load is applied at once, elastically, where a jump is followed as in an elastic
/// case, and the salt then creeps under constant load. A jump that is followed in that creep, with
/// the relaxed stiffness, is marked: the ladder is too coarse for it.
class CreepMarch final : public StepSolver {
 public:
  /// @pre all arguments outlive this; laws and the operators of the ladder agree.
  CreepMarch(CreepLadder& ladder, const StepSetting& setting)
      : scene_(setting.scene),
        numerics_(setting.scene.numerics),
        watch_(setting.watch),
        case_loads_(setting.loads),
        ladder_(ladder),
        following_laws_(setting.laws),
        static_laws_(without_following(setting.laws)),
        static_solver_(static_cast<std::size_t>(ladder_.n_rungs())),
        following_solver_(static_cast<std::size_t>(ladder_.n_rungs())) {}

  SolvedStep advance(const LoadStep& step, const StepLoads& loads, ContactState& state) override;
  Eigen::VectorXd observed(const StepLoads& loads, const ContactState& state) const override;
  Eigen::Matrix3Xd displacement(const StepLoads&, const ContactState&) override {
    return now_.bulk.displacement;
  }

 private:
  /// Everything that a time step changes.
  struct Point {
    double time = 0;  // s
    StepLoads loads;
    ContactState contact;
    BulkState bulk;
  };
  /// What a step does to the bulk, once it is known to be wanted: half of its back-solve.
  struct BulkMove {
    int rung;
    CreepLadder::History history;
    std::vector<double> load_increments;
    Eigen::VectorXd jump_increment;
  };
  /// A way from one point to a later one.
  struct Path {
    Point end;  ///< its bulk lags behind while there is a move to be made: see arrive().
    ContactReport contact;
    StepCreep creep;
    std::optional<BulkMove> move;
    bool good() const { return in_equilibrium(contact.outcome); }
  };

  ContactReport begin(const StepLoads& loads, ContactState& state);
  Path walked(double to);
  int rung_of(double duration) const;
  int finer(int rung) const;
  ContactSolver& solver(int rung, bool follows);
  const Point& arrive(Path& path);
  Path step(const Point& from, const StepLoads& loads, double to, int rung, bool follows);
  Path whole(const Point& from, double to, int rung, bool shortest);
  void discard(const Path& path);
  Path split(const Point& from, double to, int rung);
  static Path joined(Path first, Path second);
  Path fixed(const Point& from, double to);
  Path controlled(const Point& from, double to, Path coarse, int rung);

  const Scene& scene_;
  const Numerics& numerics_;
  ContactWatch watch_;
  const CaseLoads& case_loads_;
  CreepLadder& ladder_;
  ContactLaws following_laws_, static_laws_;
  std::vector<std::unique_ptr<ContactSolver>> static_solver_, following_solver_;  // per rung
  Point now_;
  bool has_begun_ = false;                  // step 0 is in equilibrium
  double step_from_ = 0, step_length_ = 0;  // s, of the load step
  int thrown_away_ = 0;                     // Newton iterations of paths not taken
};

/// The rung of that duration; −1 if there is none. Durations of load steps are differences of
/// times: good to the last digit of the time.
int CreepMarch::rung_of(double duration) const {
  double nearest =
      1e-6 * duration + 4 * std::numeric_limits<double>::epsilon() * (step_from_ + step_length_);
  int found = -1;
  for (int r = 1; r < ladder_.n_rungs(); ++r) {
    const double distance = std::abs(ladder_.duration(r) - duration);
    if (distance > nearest) continue;
    nearest = distance;
    found = r;
  }
  return found;
}

/// The rung of half that duration, of whichever load step it is a part; −1 if there is none or
/// nothing is to be halved.
int CreepMarch::finer(int rung) const {
  return numerics_.creep_refinements == 0 ? -1 : rung_of(ladder_.duration(rung) / 2);
}

ContactSolver& CreepMarch::solver(int rung, bool follows) {
  std::unique_ptr<ContactSolver>& chosen = (follows ? following_solver_ : static_solver_)[rung];
  if (!chosen) {
    chosen =
        std::make_unique<ContactSolver>(ladder_.op(rung), follows ? following_laws_ : static_laws_,
                                        contact_options(numerics_), watch_);
  }
  return *chosen;
}

/// The end of a path, bulk and all.
const CreepMarch::Point& CreepMarch::arrive(Path& path) {
  if (path.move) {
    BulkMove& move = *path.move;
    ladder_.advance(move.rung, std::move(move.history), move.load_increments, move.jump_increment,
                    path.end.bulk);
    path.move.reset();
  }
  return path.end;
}

/// One step of a rung, from a point to the loads given. Load factors of jumps are turned into those
/// of the load step, whose loads are linear in time.
CreepMarch::Path CreepMarch::step(const Point& from, const StepLoads& loads, double to, int rung,
                                  bool follows) {
  watch_.stop.throw_if_requested("solving a step of creep");
  const FaultOperator& op = ladder_.op(rung);
  const FaultOperator& elastic = ladder_.op(0);
  CreepLadder::History history = ladder_.history(
      rung, from.bulk, case_loads_.forces(from.loads.time, loads.time, op.n_unknowns));
  std::vector<double> increments(loads.factors.size());
  Eigen::VectorXd change = loads.locked - from.loads.locked + history.traction;
  if (loads.locked_by_forces.size() > 0)  // elastic; the rung's own is in `history`
    change -= loads.locked_by_forces - from.loads.locked_by_forces;
  for (std::size_t k = 0; k < increments.size(); ++k) {
    increments[k] = loads.factors[k] - from.loads.factors[k];
    if (increments[k] == 0 || rung == 0) continue;
    const auto column = static_cast<Eigen::Index>(k);
    change += increments[k] * (op.loads.traction.col(column) - elastic.loads.traction.col(column));
  }
  const Eigen::VectorXd before =
      from.contact.traction + elastic_traction_drop(op, from.contact.jump);
  Path path{from, {}, {}, {}};
  path.contact = solver(rung, follows).solve_step(before, before + change, path.end.contact);
  path.creep.time_steps = 1;
  for (ContactJump& jump : path.contact.jumps) {
    for (double* factor : {&jump.load_before, &jump.load_after}) {
      *factor = (from.time + *factor * (to - from.time) - step_from_) / step_length_;
    }
  }
  if (!path.good()) return path;
  path.move = BulkMove{rung, std::move(history), std::move(increments),
                       path.end.contact.jump - from.contact.jump};
  path.end.loads = loads;
  path.end.time = to;
  return path;
}

CreepMarch::Path CreepMarch::joined(Path first, Path second) {
  ContactReport& sum = first.contact;
  const ContactReport& more = second.contact;
  sum.outcome = more.outcome == Outcome::converged ? sum.outcome : more.outcome;
  sum.reason += more.reason;
  sum.jumps.insert(sum.jumps.end(), more.jumps.begin(), more.jumps.end());
  sum.counts += more.counts;
  first.creep.time_steps += second.creep.time_steps;
  first.creep.time_error = std::max(first.creep.time_error, second.creep.time_error);
  first.creep.time_resolved = first.creep.time_resolved && second.creep.time_resolved;
  first.end = std::move(second.end);
  first.move = std::move(second.move);
  return first;
}

/// On the shortest rung: the load at once, then creep at constant load.
CreepMarch::Path CreepMarch::split(const Point& from, double to, int rung) {
  const StepLoads loads = case_loads_.at(to);
  Path jump = step(from, loads, to, 0, true);
  if (!jump.good()) return jump;
  jump.creep.time_steps = 0;
  jump.end.time = from.time;
  Path creep = step(arrive(jump), loads, to, rung, true);
  creep.creep.time_resolved = creep.contact.jumps.empty();
  return joined(std::move(jump), std::move(creep));
}

void CreepMarch::discard(const Path& path) {
  const SolveCounts& counts = path.contact.counts;
  thrown_away_ += counts.newton_iterations + counts.wasted_newton_iterations;
}

/// @param shortest  no shorter step will be tried.
CreepMarch::Path CreepMarch::whole(const Point& from, double to, int rung, bool shortest) {
  Path path = step(from, case_loads_.at(to), to, rung, false);
  if (path.good() || !shortest) return path;
  discard(path);
  return split(from, to, rung);
}

CreepMarch::Path CreepMarch::fixed(const Point& from, double to) {
  const double start = from.time, length = to - from.time;
  const int n = std::max(1, static_cast<int>(std::ceil(length / numerics_.creep_time_step - 1e-9)));
  const int rung = rung_of(length / n);
  FAULTSIM_DEMAND(rung > 0, "no rung of ", length / n, " s");
  Path path = whole(from, start + length / n, rung, true);
  for (int i = 2; i <= n && path.good(); ++i) {
    const Point middle = arrive(path);
    path = joined(std::move(path), whole(middle, start + length * i / n, rung, true));
  }
  return path;
}

/// @param coarse  the way in one step of the rung, taken already.
CreepMarch::Path CreepMarch::controlled(const Point& from, double to, Path coarse, int rung) {
  const int half = finer(rung);
  if (half < 0) return coarse;
  const double middle = from.time + (to - from.time) / 2;
  const bool last = finer(half) < 0;
  Path first = whole(from, middle, half, last);
  Path second;
  double difference = std::numeric_limits<double>::infinity();
  if (first.good()) second = whole(arrive(first), to, half, last);
  if (coarse.good() && first.good() && second.good()) {
    difference =
        (coarse.end.contact.traction - second.end.contact.traction).lpNorm<Eigen::Infinity>();
  }
  discard(coarse);
  if (difference > numerics_.creep_tolerance && !last) {
    discard(second);
    Path path = controlled(from, middle, std::move(first), half);
    if (!path.good()) return path;
    const Point there = arrive(path);
    Path rest = whole(there, to, half, false);
    return joined(std::move(path), controlled(there, to, std::move(rest), half));
  }
  if (!first.good()) return first;
  Path path = joined(std::move(first), std::move(second));
  if (std::isfinite(difference))
    path.creep.time_error = std::max(path.creep.time_error, difference);
  // A jump in the way leaves nothing to compare; without one the whole step was too long.
  const bool is_shown = difference <= numerics_.creep_tolerance ||
                        (!std::isfinite(difference) && !path.contact.jumps.empty());
  path.creep.time_resolved = path.creep.time_resolved && is_shown;
  return path;
}

/// Step 0, elastic: from closed faults to the loads at t = 0.
ContactReport CreepMarch::begin(const StepLoads& loads, ContactState& state) {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(ladder_.op(0).geometry.n_dofs);
  ContactReport report = solver(0, true).solve_step(none, loads.locked, state);
  if (!in_equilibrium(report.outcome)) return report;
  now_ = {0, loads, state, ladder_.at_rest()};
  CreepLadder::History history =
      ladder_.history(0, now_.bulk, case_loads_.forces_at(loads.time, ladder_.op(0).n_unknowns));
  ladder_.advance(0, std::move(history), loads.factors, state.jump, now_.bulk);
  has_begun_ = true;
  return report;
}

/// The way to the end of a load step.
CreepMarch::Path CreepMarch::walked(double to) {
  step_from_ = now_.time;
  step_length_ = to - now_.time;
  thrown_away_ = 0;
  Path path;
  if (numerics_.creep_time_step > 0) {
    path = fixed(now_, to);
  } else {
    const int rung = rung_of(step_length_);
    FAULTSIM_DEMAND(rung > 0, "no rung of ", step_length_, " s");
    const bool only = finer(rung) < 0;
    path = controlled(now_, to, whole(now_, to, rung, only), rung);
  }
  path.contact.counts.wasted_newton_iterations += thrown_away_;
  return path;
}

SolvedStep CreepMarch::advance(const LoadStep& step, const StepLoads& loads, ContactState& state) {
  SolvedStep solved;
  if (!has_begun_) {
    solved.contact = begin(loads, state);
    if (has_begun_) solved.creep.emplace();
  } else {
    Path path = walked(step.time);
    solved.is_elastic = false;
    if (path.good()) {
      arrive(path);
      now_ = std::move(path.end);
      state = now_.contact;
    }
    solved.contact = std::move(path.contact);
    solved.creep = std::move(path.creep);
  }
  if (in_equilibrium(solved.contact.outcome)) {
    solved.creep_traction =
        state.traction - loads.locked + elastic_traction_drop(ladder_.op(0), state.jump);
  }
  return solved;
}

Eigen::VectorXd CreepMarch::observed(const StepLoads&, const ContactState&) const {
  Eigen::VectorXd u = ladder_.observed(now_.bulk);
  for (const int row : mirrored_rows(scene_, ladder_.op(0).geometry.half_domain)) u[row] *= -1;
  return u;
}

}  // namespace

MakeStepSolver creep_steps(CreepLadder& ladder) {
  return [&ladder](const StepSetting& setting) {
    return std::make_unique<CreepMarch>(ladder, setting);
  };
}

}  // namespace faultsim
