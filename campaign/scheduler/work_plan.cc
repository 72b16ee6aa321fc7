#include "campaign/scheduler/work_plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "simulator/common/errors.h"

namespace faultsweep {

namespace {

/// What the program itself takes weighs more in a small operator, and how a large one is factorised
/// may differ.
bool are_of_one_size(double bytes, double learned_bytes) {
  return bytes >= 0.5 * learned_bytes && bytes <= 1.25 * learned_bytes;
}

}  // namespace

WorkPlan::WorkPlan(std::vector<FamilyWork> families, const Limits& limits) : limits_(limits) {
  FAULTSIM_DEMAND(limits.n_workers > 0, limits.n_workers);
  workers_.resize(limits.n_workers);
  add(std::move(families));
}

void WorkPlan::add(std::vector<FamilyWork> families) {
  for (FamilyWork& work : families) {
    const auto [place, is_new] = by_id_.emplace(work.id, n_families());
    if (is_new) families_.emplace_back();
    Family& entry = family(place->second);
    entry.waiting.insert(entry.waiting.end(), work.cases.begin(), work.cases.end());
    n_waiting_ += static_cast<long>(work.cases.size());
    if (!is_new) continue;
    work.cases.clear();
    entry.state = work.operator_cached ? State::ready : State::cold;
    entry.work = std::move(work);
  }
  order_.resize(families_.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::ranges::stable_sort(order_, [this](int a, int b) {
    const bool ready_a = family(a).state == State::ready;
    const bool ready_b = family(b).state == State::ready;
    if (ready_a != ready_b) return ready_a;
    return total_seconds(family(a)) > total_seconds(family(b));
  });
}

double WorkPlan::case_seconds(const Family& entry) const {
  if (entry.measured_cases > 0) {
    return entry.measured_seconds / static_cast<double>(entry.measured_cases);
  }
  return entry.work.case_seconds;
}

double WorkPlan::build_seconds(const Family& entry) const {
  const double ratio = predicted_operators_ > 0 ? measured_operators_ / predicted_operators_ : 1;
  return ratio * entry.work.operator_seconds;
}

/// Where nothing of its size was measured, what was predicted.
double WorkPlan::memory_bytes(const Family& entry) const {
  const double predicted = entry.work.memory_bytes;
  if (!are_of_one_size(predicted, learned_bytes_)) return predicted;
  return kMemoryMargin * memory_ratio_ * predicted;
}

void WorkPlan::learn_memory(double predicted_bytes, double peak_bytes) {
  if (predicted_bytes <= 0 || peak_bytes <= 0) return;
  const double ratio = peak_bytes / predicted_bytes;
  if (!are_of_one_size(predicted_bytes, learned_bytes_)) {
    if (predicted_bytes < learned_bytes_) return;
    memory_ratio_ = ratio;
  }
  memory_ratio_ = std::max(memory_ratio_, ratio);
  learned_bytes_ = std::max(learned_bytes_, predicted_bytes);
}

double WorkPlan::total_seconds(const Family& entry) const {
  constexpr double kUnknownCase = 1e-3;  // s; only decides the order of families alike
  const double one = case_seconds(entry) > 0 ? case_seconds(entry) : kUnknownCase;
  double seconds = one * static_cast<double>(entry.waiting.size());
  if (entry.state == State::cold) seconds += build_seconds(entry);
  return seconds;
}

/// For which those who are on the family have cases of it. One that was never timed is taken for a
/// hundredth of its operator.
double WorkPlan::busy_seconds(int index) const {
  const Family& entry = family(index);
  const double one = case_seconds(entry) > 0 ? case_seconds(entry) : build_seconds(entry) / 100;
  double n_cases = static_cast<double>(entry.waiting.size());
  for (const Worker& worker : workers_)
    if (worker.family == index) n_cases += static_cast<double>(worker.n_cases);
  return one * n_cases / std::max(entry.n_workers, 1);
}

bool WorkPlan::has_operator(int worker, int index) const {
  if (!family(index).work.creeps) return family(index).state == State::ready;
  return at(worker).holds == index && at(worker).has_operators;
}

bool WorkPlan::fits_in_memory(int worker, int index) const {
  if (limits_.memory_bytes <= 0) return true;
  double used = 0;
  for (int k = 0; k < limits_.n_workers; ++k) {
    // The worker itself lets go of what it holds before it builds.
    if (k == worker || at(k).host != at(worker).host) continue;
    if (is_building(k) && !family(at(k).family).work.creeps) {
      used += memory_bytes(family(at(k).family));
    }
    if (at(k).holds >= 0) used += memory_bytes(family(at(k).holds));
  }
  // Alone it may always try: the prediction may be too careful.
  return used == 0 || used + memory_bytes(family(index)) <= limits_.memory_bytes;
}

/// Those n who are on it need W/n seconds for what waits, n + 1 need (W + B)/(n + 1) with the build
/// B. W is not known before the first case has ended.
bool WorkPlan::pays_to_join(int index) const {
  const Family& entry = family(index);
  const auto n = std::ranges::count(workers_, index, &Worker::holds);
  const double waiting = case_seconds(entry) * static_cast<double>(entry.waiting.size());
  return !entry.alone && waiting > static_cast<double>(n) * build_seconds(entry);
}

bool WorkPlan::has_unclaimed_family() const {
  return std::ranges::any_of(families_, [](const Family& entry) {
    return !entry.waiting.empty() && entry.n_workers == 0;
  });
}

int WorkPlan::choose_family(int worker) const {
  for (const int own : {at(worker).family, at(worker).holds}) {
    if (own >= 0 && has_operator(worker, own) && !family(own).waiting.empty()) return own;
  }
  for (const int index : order_) {
    const Family& entry = family(index);
    if (entry.waiting.empty() || entry.n_workers > 0) continue;
    if (entry.work.creeps && entry.state != State::cold) continue;  // somebody still has it
    if (!has_operator(worker, index) && !fits_in_memory(worker, index)) continue;
    return index;
  }
  return family_to_join(worker);
}

/// Of those that others are on, the one with the most to do per worker; -1 = none.
int WorkPlan::family_to_join(int worker) const {
  int best = -1;
  double most = 0;
  for (const int index : order_) {
    const Family& entry = family(index);
    if (entry.waiting.empty() || entry.state != State::ready) continue;
    if (entry.work.creeps && !(pays_to_join(index) && fits_in_memory(worker, index))) continue;
    const double share = total_seconds(entry) / (entry.n_workers + 1);
    if (best < 0 || share > most) {
      best = index;
      most = share;
    }
  }
  return best;
}

std::optional<Slice> WorkPlan::next(int worker) {
  if (stopped_) return std::nullopt;
  Worker& self = at(worker);
  if (self.n_cases > 0) {
    // Keep the pipe full, but only with the family that is at hand.
    const Family& own = family(self.family);
    if (!has_operator(worker, self.family) || own.waiting.empty()) return std::nullopt;
    if (own.measured_cases == 0 || self.n_cases > kLargestSlice) return std::nullopt;
    return is_short_of_work(self) ? std::optional(cut(worker, self.family)) : std::nullopt;
  }
  const int index = choose_family(worker);
  if (index < 0) return std::nullopt;
  turn_to(worker, index);
  return cut(worker, index);
}

/// Less than half a slice ahead; or on its last case, where a next one at hand saves the way to the
/// manager and back (~25 ms), unless the case is long or another worker may soon want for one.
bool WorkPlan::is_short_of_work(const Worker& worker) const {
  const Family& own = family(worker.family);
  const double one = case_seconds(own);
  if (static_cast<double>(worker.n_cases) * one <= kSliceSeconds / 2) return true;
  return worker.n_cases == 1 && one < kLongCaseSeconds &&
         own.waiting.size() > 2 * static_cast<std::size_t>(limits_.n_workers);
}

void WorkPlan::turn_to(int worker, int index) {
  Worker& self = at(worker);
  if (self.family != index) {
    leave_family(self);
    self.family = index;
    ++family(index).n_workers;
  }
  if (self.holds != index || self.is_releasing) let_go(self);
  if (!family(index).work.creeps) {
    if (family(index).state == State::cold) family(index).state = State::building;
    return;
  }
  self.holds = index;
  update_state(index);
}

void WorkPlan::let_go(Worker& worker) {
  const int held = worker.holds;
  worker.holds = -1;
  worker.has_operators = worker.is_releasing = false;
  if (held >= 0) update_state(held);
}

/// @pre salt creeps in it.
void WorkPlan::update_state(int index) {
  State state = State::cold;
  for (const Worker& worker : workers_) {
    if (worker.holds != index || worker.is_releasing) continue;
    if (worker.has_operators) state = State::ready;
    if (state == State::cold) state = State::building;
  }
  family(index).state = state;
}

Slice WorkPlan::cut(int worker, int index) {
  Family& entry = family(index);
  Slice slice;
  slice.family = index;
  slice.builds_operator = !has_operator(worker, index);
  std::size_t size = 1;  // also while the time of a case is unknown: the first tells
  const double one = case_seconds(entry);
  if (!slice.builds_operator && one > 0) {
    const bool all_may_come = !has_unclaimed_family() && !entry.work.creeps;
    const int sharers = all_may_come ? limits_.n_workers : entry.n_workers;
    const double fair = std::ceil(static_cast<double>(entry.waiting.size()) / (2.0 * sharers));
    size = static_cast<std::size_t>(
        std::clamp(std::min(std::ceil(kSliceSeconds / one), fair), 1.0, double{kLargestSlice}));
  }
  for (std::size_t k = 0; k < size && !entry.waiting.empty(); ++k) {
    const std::int64_t id = entry.waiting.front();
    entry.waiting.pop_front();
    --n_waiting_;
    slice.cases.push_back(id);
    in_flight_[id] = {index, worker};
    ++at(worker).n_cases;
  }
  return slice;
}

void WorkPlan::leave_family(Worker& worker) {
  if (worker.family >= 0) --family(worker.family).n_workers;
  worker.family = -1;
}

void WorkPlan::operator_ready(int worker, double seconds, bool from_cache, double peak_bytes) {
  const int index = family_of(worker);
  FAULTSIM_DEMAND(index >= 0, worker);
  Family& entry = family(index);
  if (!from_cache && entry.work.operator_seconds > 0) {
    predicted_operators_ += entry.work.operator_seconds;
    measured_operators_ += seconds;
  }
  if (!from_cache && !entry.work.creeps) learn_memory(entry.work.memory_bytes, peak_bytes);
  entry.state = State::ready;
  if (entry.work.creeps) at(worker).has_operators = true;
}

bool WorkPlan::take_release(int worker) {
  Worker& self = at(worker);
  if (stopped_ || self.holds < 0 || self.n_cases > 0 || self.is_releasing) return false;
  if (!family(self.holds).waiting.empty()) return false;
  self.is_releasing = true;
  update_state(self.holds);
  return true;
}

void WorkPlan::released(int worker) {
  if (at(worker).is_releasing) let_go(at(worker));  // else it has turned to another family since
}

void WorkPlan::landed(int worker, std::int64_t case_id) {
  const auto flight = in_flight_.find(case_id);
  FAULTSIM_DEMAND(flight != in_flight_.end() && flight->second.worker == worker, case_id, " ",
                  worker);
  const int index = flight->second.family;
  in_flight_.erase(flight);
  Worker& self = at(worker);
  if (--self.n_cases > 0) return;
  if (!has_operator(worker, index)) {
    // The builder ended without an operator: somebody else may try with another case.
    if (family(index).work.creeps) {
      let_go(self);
    } else {
      family(index).state = State::cold;
    }
    leave_family(self);
  } else if (family(index).waiting.empty()) {
    leave_family(self);
  }
}

void WorkPlan::case_done(int worker, std::int64_t case_id, double seconds) {
  Family& entry = family(family_index(case_id));
  entry.measured_seconds += std::max(seconds, 1e-6);  // a clock may be coarse
  ++entry.measured_cases;
  landed(worker, case_id);
}

bool WorkPlan::case_failed(int worker, std::int64_t case_id, bool in_operator) {
  const int index = family_index(case_id);
  if (in_operator && family(index).work.creeps) {
    at(worker).has_operators = false;  // it may have had some, in a simulator that died
    update_state(index);
    if (family(index).state == State::ready) {
      // Another worker has them, so the case is not to blame: there is no room for two.
      family(index).alone = true;
      family(index).waiting.push_back(case_id);
      ++n_waiting_;
      landed(worker, case_id);
      return true;
    }
  }
  if (in_operator) ++family(index).operator_failures;
  landed(worker, case_id);
  if (limits_.on_failure == FailureAction::abort) stop();
  const bool again =
      limits_.on_failure == FailureAction::retry && ++failures_[case_id] <= limits_.retries;
  if (again) {
    family(index).waiting.push_back(case_id);
    ++n_waiting_;
  }
  return again;
}

void WorkPlan::returned(int worker, const std::vector<std::int64_t>& cases) {
  for (auto id = cases.rbegin(); id != cases.rend(); ++id) {
    family(family_index(*id)).waiting.push_front(*id);
    ++n_waiting_;
    landed(worker, *id);
  }
}

std::vector<std::int64_t> WorkPlan::take_hopeless() {
  std::vector<std::int64_t> hopeless;
  for (Family& entry : families_) {
    if (entry.operator_failures < kOperatorAttempts || entry.state != State::cold) continue;
    hopeless.insert(hopeless.end(), entry.waiting.begin(), entry.waiting.end());
    n_waiting_ -= static_cast<long>(entry.waiting.size());
    entry.waiting.clear();
  }
  return hopeless;
}

bool WorkPlan::is_finished() const { return in_flight_.empty() && (stopped_ || n_waiting_ == 0); }

bool WorkPlan::is_building(int worker) const {
  const int index = family_of(worker);
  return index >= 0 && at(worker).n_cases > 0 && !has_operator(worker, index);
}

int WorkPlan::build_threads(int worker, int cores) const {
  const double half = build_seconds_of(worker) / 2;
  int n_building = 1, n_idle = 0, n_running = 0, idle = -1;
  for (int other = 0; other < static_cast<int>(workers_.size()); ++other) {
    if (other == worker || at(other).host != at(worker).host) continue;
    if (is_building(other)) {
      ++n_building;
    } else if (at(other).n_cases > 0 && busy_seconds(family_of(other)) >= half) {
      ++n_running;
    } else {
      ++n_idle;
      idle = other;
    }
  }
  long n_cold = 0;  // that find room beside this one
  for (int index = 0; idle >= 0 && index < n_families(); ++index) {
    const bool is_cold = family(index).state == State::cold && !family(index).waiting.empty();
    n_cold += is_cold && fits_in_memory(idle, index);
  }
  const int sharers = n_building + static_cast<int>(std::min<long>(n_idle, n_cold));
  return std::max(1, (cores - n_running) / sharers);
}

int WorkPlan::family_index(std::int64_t case_id) const {
  const auto flight = in_flight_.find(case_id);
  FAULTSIM_DEMAND(flight != in_flight_.end(), case_id);
  return flight->second.family;
}

double WorkPlan::build_seconds_of(int worker) const {
  return is_building(worker) ? build_seconds(family(family_of(worker))) : 0;
}

double WorkPlan::seconds_left() const {
  double work = 0;
  double longest = 0;  // of what cannot be shared: a build, cases of a family that is not joined
  for (const Family& entry : families_) {
    if (entry.waiting.empty()) continue;
    work += total_seconds(entry);
    if (entry.work.creeps) {
      longest = std::max(longest, total_seconds(entry) / std::max(entry.n_workers, 1));
    } else if (entry.state == State::cold) {
      longest = std::max(longest, entry.work.operator_seconds);
    }
  }
  for (const auto& [id, flight] : in_flight_) work += case_seconds(family(flight.family));
  return std::max(work / limits_.n_workers, longest);
}

}  // namespace faultsweep
