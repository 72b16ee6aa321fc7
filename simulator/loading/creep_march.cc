#include "simulator/loading/creep_march.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "simulator/common/errors.h"
#include "simulator/loading/case_contact.h"
#include "simulator/operators/prepare_operator.h"

namespace faultsim {
namespace {

ContactLaws without_following(ContactLaws laws) {
  for (CoulombLaw& law : laws) law.damping = 0;
  return laws;
}

void add_counts(SolveCounts& sum, const SolveCounts& part, bool wasted) {
  sum.sub_steps += wasted ? 0 : part.sub_steps;
  sum.active_set_passes += part.active_set_passes;
  sum.newton_iterations += wasted ? 0 : part.newton_iterations;
  sum.wasted_newton_iterations +=
      part.wasted_newton_iterations + (wasted ? part.newton_iterations : 0);
}

/// A⁻¹ H g over the columns with g ≠ 0, n_dofs, Pa.
Eigen::VectorXd elastic_traction_drop(const FaultOperator& op, const Eigen::VectorXd& jump) {
  Eigen::VectorXd drop = Eigen::VectorXd::Zero(op.geometry.n_dofs);
  for (Eigen::Index d = 0; d < jump.size(); ++d) {
    if (jump[d] != 0) drop += jump[d] * op.compliance->column(static_cast<int>(d));
  }
  return drop.cwiseQuotient(op.geometry.dof_area);
}

}  // namespace

struct CreepMarch::Impl {
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

  Impl(CreepLadder& given_ladder, const StepSetting& setting)
      : scene(setting.scene),
        numerics(setting.scene.numerics),
        watch(setting.watch),
        case_loads(setting.loads),
        ladder(given_ladder),
        following_laws(setting.laws),
        static_laws(without_following(setting.laws)),
        static_solver(static_cast<std::size_t>(ladder.n_rungs())),
        following_solver(static_cast<std::size_t>(ladder.n_rungs())) {}

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

  const Scene& scene;
  const Numerics& numerics;
  ContactWatch watch;
  const CaseLoads& case_loads;
  CreepLadder& ladder;
  ContactLaws following_laws, static_laws;
  std::vector<std::unique_ptr<ContactSolver>> static_solver, following_solver;  // per rung
  Point now;
  bool has_begun = false;                 // step 0 is in equilibrium
  double step_from = 0, step_length = 0;  // s, of the load step
  int thrown_away = 0;                    // Newton iterations of paths not taken
};

/// The rung of that duration; −1 if there is none. Durations of load steps are differences of
/// times: good to the last digit of the time.
int CreepMarch::Impl::rung_of(double duration) const {
  double nearest =
      1e-6 * duration + 4 * std::numeric_limits<double>::epsilon() * (step_from + step_length);
  int found = -1;
  for (int r = 1; r < ladder.n_rungs(); ++r) {
    const double distance = std::abs(ladder.duration(r) - duration);
    if (distance > nearest) continue;
    nearest = distance;
    found = r;
  }
  return found;
}

/// The rung of half that duration, of whichever load step it is a part; −1 if there is none or
/// nothing is to be halved.
int CreepMarch::Impl::finer(int rung) const {
  return numerics.creep_refinements == 0 ? -1 : rung_of(ladder.duration(rung) / 2);
}

ContactSolver& CreepMarch::Impl::solver(int rung, bool follows) {
  std::unique_ptr<ContactSolver>& chosen = (follows ? following_solver : static_solver)[rung];
  if (!chosen) {
    chosen = std::make_unique<ContactSolver>(
        ladder.op(rung), follows ? following_laws : static_laws, contact_options(numerics), watch);
  }
  return *chosen;
}

/// The end of a path, bulk and all.
const CreepMarch::Impl::Point& CreepMarch::Impl::arrive(Path& path) {
  if (path.move) {
    BulkMove& move = *path.move;
    ladder.advance(move.rung, std::move(move.history), move.load_increments, move.jump_increment,
                   path.end.bulk);
    path.move.reset();
  }
  return path.end;
}

/// One step of a rung, from a point to the loads given. Load factors of jumps are turned into those
/// of the load step, whose loads are linear in time.
CreepMarch::Impl::Path CreepMarch::Impl::step(const Point& from, const StepLoads& loads, double to,
                                              int rung, bool follows) {
  watch.stop.throw_if_requested("solving a step of creep");
  const FaultOperator& op = ladder.op(rung);
  const FaultOperator& elastic = ladder.op(0);
  CreepLadder::History history = ladder.history(
      rung, from.bulk, case_loads.forces(from.loads.time, loads.time, op.n_unknowns));
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
      *factor = (from.time + *factor * (to - from.time) - step_from) / step_length;
    }
  }
  if (!path.good()) return path;
  path.move = BulkMove{rung, std::move(history), std::move(increments),
                       path.end.contact.jump - from.contact.jump};
  path.end.loads = loads;
  path.end.time = to;
  return path;
}

CreepMarch::Impl::Path CreepMarch::Impl::joined(Path first, Path second) {
  ContactReport& sum = first.contact;
  const ContactReport& more = second.contact;
  sum.outcome = more.outcome == Outcome::converged ? sum.outcome : more.outcome;
  sum.reason += more.reason;
  sum.jumps.insert(sum.jumps.end(), more.jumps.begin(), more.jumps.end());
  add_counts(sum.counts, more.counts, false);
  first.creep.time_steps += second.creep.time_steps;
  first.creep.time_error = std::max(first.creep.time_error, second.creep.time_error);
  first.creep.time_resolved = first.creep.time_resolved && second.creep.time_resolved;
  first.end = std::move(second.end);
  first.move = std::move(second.move);
  return first;
}

/// On the shortest rung: the load at once, then creep at constant load.
CreepMarch::Impl::Path CreepMarch::Impl::split(const Point& from, double to, int rung) {
  const StepLoads loads = case_loads.at(to);
  Path jump = step(from, loads, to, 0, true);
  if (!jump.good()) return jump;
  jump.creep.time_steps = 0;
  jump.end.time = from.time;
  Path creep = step(arrive(jump), loads, to, rung, true);
  creep.creep.time_resolved = creep.contact.jumps.empty();
  return joined(std::move(jump), std::move(creep));
}

void CreepMarch::Impl::discard(const Path& path) {
  const SolveCounts& counts = path.contact.counts;
  thrown_away += counts.newton_iterations + counts.wasted_newton_iterations;
}

/// @param shortest  no shorter step will be tried.
CreepMarch::Impl::Path CreepMarch::Impl::whole(const Point& from, double to, int rung,
                                               bool shortest) {
  Path path = step(from, case_loads.at(to), to, rung, false);
  if (path.good() || !shortest) return path;
  discard(path);
  return split(from, to, rung);
}

CreepMarch::Impl::Path CreepMarch::Impl::fixed(const Point& from, double to) {
  const double start = from.time, length = to - from.time;
  const int n = std::max(1, static_cast<int>(std::ceil(length / numerics.creep_time_step - 1e-9)));
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
CreepMarch::Impl::Path CreepMarch::Impl::controlled(const Point& from, double to, Path coarse,
                                                    int rung) {
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
  if (difference > numerics.creep_tolerance && !last) {
    discard(second);
    Path path = controlled(from, middle, std::move(first), half);
    if (!path.good()) return path;
    const Point there = arrive(path);
    Path rest = whole(there, to, half, false);
    return joined(std::move(path), controlled(there, to, std::move(rest), half));
  }
  if (!first.good()) return first;
  Path path = joined(std::move(first), std::move(second));
  if (std::isfinite(difference)) {  // else a jump was in the way, and there is nothing to compare
    path.creep.time_error = std::max(path.creep.time_error, difference);
    path.creep.time_resolved = path.creep.time_resolved && difference <= numerics.creep_tolerance;
  }
  return path;
}

/// Step 0, elastic: from closed faults to the loads at t = 0.
ContactReport CreepMarch::Impl::begin(const StepLoads& loads, ContactState& state) {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(ladder.op(0).geometry.n_dofs);
  ContactReport report = solver(0, true).solve_step(none, loads.locked, state);
  if (!in_equilibrium(report.outcome)) return report;
  now = {0, loads, state, ladder.at_rest()};
  CreepLadder::History history =
      ladder.history(0, now.bulk, case_loads.forces_at(loads.time, ladder.op(0).n_unknowns));
  ladder.advance(0, std::move(history), loads.factors, state.jump, now.bulk);
  has_begun = true;
  return report;
}

/// The way to the end of a load step.
CreepMarch::Impl::Path CreepMarch::Impl::walked(double to) {
  step_from = now.time;
  step_length = to - now.time;
  thrown_away = 0;
  Path path;
  if (numerics.creep_time_step > 0) {
    path = fixed(now, to);
  } else {
    const int rung = rung_of(step_length);
    FAULTSIM_DEMAND(rung > 0, "no rung of ", step_length, " s");
    const bool only = finer(rung) < 0;
    path = controlled(now, to, whole(now, to, rung, only), rung);
  }
  path.contact.counts.wasted_newton_iterations += thrown_away;
  return path;
}

CreepMarch::CreepMarch(CreepLadder& ladder, const StepSetting& setting)
    : impl_(std::make_unique<Impl>(ladder, setting)) {}

CreepMarch::~CreepMarch() = default;

SolvedStep CreepMarch::advance(const LoadStep& step, const StepLoads& loads, ContactState& state) {
  Impl& self = *impl_;
  SolvedStep solved;
  if (!self.has_begun) {
    solved.contact = self.begin(loads, state);
    if (self.has_begun) solved.creep.emplace();
  } else {
    Impl::Path path = self.walked(step.time);
    solved.is_elastic = false;
    if (path.good()) {
      self.arrive(path);
      self.now = std::move(path.end);
      state = self.now.contact;
    }
    solved.contact = std::move(path.contact);
    solved.creep = std::move(path.creep);
  }
  if (in_equilibrium(solved.contact.outcome)) {
    solved.creep_traction =
        state.traction - loads.locked + elastic_traction_drop(self.ladder.op(0), state.jump);
  }
  return solved;
}

Eigen::VectorXd CreepMarch::observed(const StepLoads&, const ContactState&) const {
  Eigen::VectorXd u = impl_->ladder.observed(impl_->now.bulk);
  const bool half = impl_->ladder.op(0).geometry.half_domain;
  for (const int row : mirrored_rows(impl_->scene, half)) u[row] *= -1;
  return u;
}

Eigen::Matrix3Xd CreepMarch::displacement(const StepLoads&, const ContactState&) {
  return impl_->now.bulk.displacement;
}

}  // namespace faultsim
