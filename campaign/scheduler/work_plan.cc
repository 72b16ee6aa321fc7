#include "campaign/scheduler/work_plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "simulator/common/errors.h"

namespace faultsweep {

WorkPlan::WorkPlan(std::vector<FamilyWork> families, const Limits& limits) : limits_(limits) {
  FAULTSIM_DEMAND(limits.n_workers > 0, limits.n_workers);
  workers_.resize(static_cast<std::size_t>(limits.n_workers));
  for (FamilyWork& work : families) {
    Family entry;
    entry.waiting.assign(work.cases.begin(), work.cases.end());
    n_waiting_ += static_cast<long>(work.cases.size());
    entry.state = work.operator_cached ? State::ready : State::cold;
    entry.work = std::move(work);
    families_.push_back(std::move(entry));
  }
  order_.resize(families_.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::stable_sort(order_.begin(), order_.end(), [this](int a, int b) {
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

double WorkPlan::total_seconds(const Family& entry) const {
  constexpr double kUnknownCase = 1e-3;  // s; only decides the order of families alike
  const double one = case_seconds(entry) > 0 ? case_seconds(entry) : kUnknownCase;
  double seconds = one * static_cast<double>(entry.waiting.size());
  if (entry.state == State::cold) {
    const double ratio = predicted_operators_ > 0 ? measured_operators_ / predicted_operators_ : 1;
    seconds += ratio * entry.work.operator_seconds;
  }
  return seconds;
}

bool WorkPlan::fits_in_memory(const Family& entry) const {
  if (limits_.memory_bytes <= 0) return true;
  double used = 0;
  for (const Family& other : families_) {
    if (other.state == State::building) used += other.work.memory_bytes;
  }
  // Alone it may always try: the prediction may be too careful.
  return used == 0 || used + entry.work.memory_bytes <= limits_.memory_bytes;
}

bool WorkPlan::has_unclaimed_family() const {
  return std::any_of(families_.begin(), families_.end(), [](const Family& entry) {
    return !entry.waiting.empty() && entry.n_workers == 0;
  });
}

int WorkPlan::choose_family(int worker) const {
  const int own = workers_[static_cast<std::size_t>(worker)].family;
  if (own >= 0 && family(own).state != State::building && !family(own).waiting.empty()) return own;
  for (const int index : order_) {
    const Family& entry = family(index);
    if (entry.waiting.empty() || entry.n_workers > 0) continue;
    if (entry.state == State::cold && !fits_in_memory(entry)) continue;
    return index;
  }
  int best = -1;
  double most = 0;
  for (const int index : order_) {
    const Family& entry = family(index);
    if (entry.waiting.empty() || entry.state != State::ready) continue;
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
  Worker& self = workers_[static_cast<std::size_t>(worker)];
  if (self.n_cases > 0) {
    // Keep the pipe full, but only with the family that is at hand.
    const Family& own = family(self.family);
    if (own.state != State::ready || own.waiting.empty()) return std::nullopt;
    const double ahead = static_cast<double>(self.n_cases) * case_seconds(own);
    if (ahead > kSliceSeconds / 2 || own.measured_cases == 0 || self.n_cases > kLargestSlice) {
      return std::nullopt;
    }
    return cut(worker, self.family);
  }
  const int index = choose_family(worker);
  if (index < 0) return std::nullopt;
  if (self.family != index) {
    leave_family(self);
    self.family = index;
    ++family(index).n_workers;
  }
  return cut(worker, index);
}

Slice WorkPlan::cut(int worker, int index) {
  Family& entry = family(index);
  Slice slice;
  slice.family = index;
  slice.builds_operator = entry.state == State::cold;
  std::size_t size = 1;  // also while the time of a case is unknown: the first tells
  const double one = case_seconds(entry);
  if (!slice.builds_operator && one > 0) {
    const int sharers = has_unclaimed_family() ? entry.n_workers : limits_.n_workers;
    const double fair = std::ceil(static_cast<double>(entry.waiting.size()) / (2.0 * sharers));
    size = static_cast<std::size_t>(
        std::clamp(std::min(std::ceil(kSliceSeconds / one), fair), 1.0, double{kLargestSlice}));
  }
  if (slice.builds_operator) entry.state = State::building;
  for (std::size_t k = 0; k < size && !entry.waiting.empty(); ++k) {
    const std::int64_t id = entry.waiting.front();
    entry.waiting.pop_front();
    --n_waiting_;
    slice.cases.push_back(id);
    in_flight_[id] = {index, worker};
    ++workers_[static_cast<std::size_t>(worker)].n_cases;
  }
  return slice;
}

void WorkPlan::leave_family(Worker& worker) {
  if (worker.family >= 0) --family(worker.family).n_workers;
  worker.family = -1;
}

void WorkPlan::operator_ready(int index, double seconds, bool from_cache) {
  Family& entry = family(index);
  if (!from_cache && entry.work.operator_seconds > 0) {
    predicted_operators_ += entry.work.operator_seconds;
    measured_operators_ += seconds;
  }
  entry.state = State::ready;
}

void WorkPlan::landed(int worker, std::int64_t case_id) {
  const auto flight = in_flight_.find(case_id);
  FAULTSIM_DEMAND(flight != in_flight_.end() && flight->second.worker == worker, case_id, " ",
                  worker);
  Family& entry = family(flight->second.family);
  in_flight_.erase(flight);
  Worker& self = workers_[static_cast<std::size_t>(worker)];
  --self.n_cases;
  // The builder ended without an operator: somebody else may try with another case.
  if (entry.state == State::building && self.n_cases == 0) {
    entry.state = State::cold;
    leave_family(self);
  } else if (entry.waiting.empty() && self.n_cases == 0) {
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
  return index >= 0 && family(index).state == State::building;
}

int WorkPlan::family_index(std::int64_t case_id) const {
  const auto flight = in_flight_.find(case_id);
  FAULTSIM_DEMAND(flight != in_flight_.end(), case_id);
  return flight->second.family;
}

double WorkPlan::seconds_left() const {
  double work = 0;
  double longest = 0;  // a single family's build cannot be shared
  for (const Family& entry : families_) {
    if (!entry.waiting.empty()) work += total_seconds(entry);
    if (entry.state == State::cold && !entry.waiting.empty()) {
      longest = std::max(longest, entry.work.operator_seconds);
    }
  }
  for (const auto& [id, flight] : in_flight_) work += case_seconds(family(flight.family));
  return std::max(work / limits_.n_workers, longest);
}

}  // namespace faultsweep
