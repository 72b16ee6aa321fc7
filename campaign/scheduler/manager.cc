#include "campaign/scheduler/manager.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/scheduler/fields_choice.h"
#include "campaign/store/same_numbers.h"
#include "simulator/result/result_bytes.h"

namespace faultsweep {

namespace {

FamilyWork work_of(const WaitingFamily& waiting, const Store& store) {
  FamilyWork work;
  work.id = waiting.family;
  work.name = waiting.predicted.fingerprint;
  work.cases = waiting.cases;
  work.operator_seconds = waiting.predicted.operator_seconds;
  work.case_seconds = waiting.seconds_per_case.value_or(0);
  work.memory_bytes = waiting.predicted.memory_bytes;
  work.creeps = waiting.predicted.creeps();
  work.operator_cached = !work.creeps && is_cached_operator(store, waiting.operator_fingerprint);
  return work;
}

/// "; Slurm job 17", "" outside of Slurm.
std::string slurm_text() {
  const char* job = std::getenv("SLURM_JOB_ID");
  return job != nullptr ? concat("; Slurm job ", job) : std::string();
}

}  // namespace

Manager::Manager(Store& store, Link& link, ProgressDisplay& display, const Options& options)
    : store_(store), link_(link), display_(display), options_(options) {
  store_.wait_for_locks(kLockSeconds);
  long n_lost = 0;
  insist([&] {
    campaign_ = store_.campaign(options.campaign);
    store_.claim_ownership(campaign_.id, n_workers());
  });
  insist([&] { n_lost = store_.requeue_missing_fields(campaign_); });
  if (n_lost > 0) {
    display_.note(concat("the fields of ", counted(n_lost, "case", "cases"), " are gone: ",
                         campaign_.keep_fields == KeepFields::shown
                             ? "those of the cases ranked first are written again"
                             : "written again"));
  }
  fields_folder_ =
      std::filesystem::absolute(store_.fields_folder(campaign_.name)).lexically_normal();
  plan_ = std::make_unique<WorkPlan>(
      std::vector<FamilyWork>(),
      WorkPlan::Limits{n_workers(), options.memory_bytes, campaign_.policy.on_failure,
                       campaign_.policy.retries});
  take_work();
  scenes_sent_.resize(n_workers());
  hosts_.resize(n_workers());
  cores_.resize(n_workers());
  since_build_.resize(n_workers());
  building_.resize(n_workers());
  if (campaign_.cancelled) plan_->stop();
  note_event("started", concat(counted(campaign_.n_waiting, "case", "cases"), " in ",
                               counted(plan_->n_families(), "family", "families"), ", ",
                               counted(n_workers(), "worker", "workers"),
                               fields_only_.empty() ? std::string()
                                                    : concat("; ", fields_only_.size(),
                                                             " cases for their fields only"),
                               slurm_text()));
  commit();
}

bool Manager::try_store(const std::function<void()>& work, Access access) {
  try {
    work();
  } catch (const StoreBusy&) {
    note_lock();
    return false;
  }
  if (access == Access::reads) return true;  // which a writer elsewhere need not hold up
  if (locked_ && lock_is_noted_) display_.note("the store is free again");
  locked_ = lock_is_noted_ = false;
  return true;
}

void Manager::insist(const std::function<void()>& work, Access access) {
  while (!try_store(work, access)) {
    if (!plan_ && options_.is_stopped && options_.is_stopped())
      throw StoreBusy("stopped while another process had locked the store; nothing was begun");
  }
}

void Manager::note_lock() {
  constexpr double kRepeatSeconds = 900;
  if (!locked_) since_lock_note_ = {};
  locked_ = true;
  const double patience = lock_is_noted_ ? kRepeatSeconds : options_.lock_note_seconds;
  if (since_lock_note_.seconds() < patience) return;
  since_lock_note_ = {};
  lock_is_noted_ = true;
  const std::vector<std::string> holders = store_.lock_holders();
  display_.note(
      concat("the store is locked by ",
             holders.empty() ? std::string("another process (an open sqlite3 session, say)")
                             : concat("process ", joined(holders, ", ")),
             "; ", counted(std::ssize(uncommitted_), "result waits", "results wait"),
             " in memory until it is free", interrupted_ ? "; stop again to give them up" : ""));
}

void Manager::note_event(const std::string& kind, const std::string& text) {
  events_.emplace_back(kind, text);
}

/// What waits in the store: all of it, of a further round, or put back by others.
void Manager::take_work() {
  std::vector<WaitingFamily> waiting;
  std::vector<Store::FamilyProgress> known;
  insist(
      [&] {
        campaign_ = store_.campaign(campaign_.name);
        waiting = store_.waiting_families(campaign_.id);
        known = store_.family_progress(campaign_.id);
      },
      Access::reads);
  n_incomplete_ = campaign_.n_done - campaign_.n_complete();
  std::vector<FamilyWork> work;
  for (const WaitingFamily& family : waiting) {
    work.push_back(work_of(family, store_));
    for (const std::int64_t id : family.cases) fields_only_.erase(id);  // put back as a whole
    fields_only_.insert(family.fields_only.begin(), family.fields_only.end());
  }
  plan_->add(std::move(work));
  for (const Store::FamilyProgress& family : known) {
    const bool is_one = family.n_operators == 1;  // creeping salt has several
    if (is_one && family.peak_bytes)
      plan_->learn_memory(family.memory_bytes, static_cast<double>(*family.peak_bytes));
  }
}

/// Another campaign's `retry` may have put cases back that this one has too. Nobody tells us.
bool Manager::take_requeued() {
  if (plan_->stopped() || chose_fields_) return false;
  long n_waiting = 0;
  insist([&] { n_waiting = store_.campaign(campaign_.name).n_waiting; }, Access::reads);
  if (n_waiting == 0) return false;
  const std::string text = concat(counted(n_waiting, "case waits", "cases wait"), " again");
  note_event("requeued", text);
  display_.note(text);
  take_work();
  return true;
}

bool Manager::take_next_round() {
  if (plan_->stopped() || chose_fields_ || !options_.next_round) return false;
  bool is_found = false;
  const bool is_asked = try_store([&] { is_found = options_.next_round(store_, campaign_.name); });
  if (!is_asked) return true;  // in the next turn again, or it was recorded and its cases wait
  if (!is_found) return false;
  RoundRecord round;
  insist([&] { round = store_.rounds(campaign_.id).back(); }, Access::reads);
  const std::string text = concat("next round, ", round.n_cases, " cases: ", round.reason);
  note_event("round", text);
  display_.note(text);
  take_work();
  return true;
}

std::vector<std::int64_t> Manager::cases_shown_first() {
  try {
    return options_.shown_first(store_, campaign_);
  } catch (const InputError& error) {  // an order that these results do not have
    display_.note(concat("no fault fields are kept, as cases cannot be ranked: ", error.what()));
    return {};
  }
}

/// All is decided: now the fields of the cases that a report and the page show first.
bool Manager::take_shown_fields() {
  const bool wanted = campaign_.keep_fields == KeepFields::shown && options_.shown_first;
  if (plan_->stopped() || chose_fields_ || !wanted) return false;
  chose_fields_ = true;
  FieldsChoice choice;
  insist([&] { choice = choose_fields(store_, campaign_, cases_shown_first()); }, Access::reads);
  const auto say = [&](const std::string& text) {
    note_event("fields", text);
    display_.note(text);
  };
  for (const std::string& text : choice.left_out) say(text);
  insist([&] { store_.want_fields(campaign_.id, choice.cases); });
  if (choice.cases.empty()) return false;
  say(concat("all cases are decided; the fault fields of the cases ranked first follow: ",
             joined(choice.positions, ", ")));
  plan_->go_on_after_failures();
  n_extras_left_ = std::ssize(choice.cases);
  take_work();
  return true;
}

Manager::~Manager() {
  try {
    store_.release_ownership();
  } catch (...) {  // the next manager sees that we are gone
  }
}

bool Manager::turn() {
  busy_ = false;
  beat();
  while (auto received = link_.receive()) {
    busy_ = true;
    const int worker = received->from - 1;
    Message& message = received->message;
    if (const auto* hello = std::get_if<message::Hello>(&message)) {
      greet(worker, *hello);
    } else if (auto* events = std::get_if<JobEvents>(&message)) {
      handle(worker, std::move(*events));
    } else if (const auto* trouble = std::get_if<message::Trouble>(&message)) {
      if (trouble_.empty()) trouble_ = trouble->text;
      plan_->stop();
    } else if (is(message, message::Signal::released)) {
      plan_->released(worker);
    } else {
      FAULTSIM_DEMAND(is(message, message::Signal::drained), message.index());
      ++n_drained_;
    }
  }
  if (knows_all_hosts() && uncommitted_.size() < kMostUncommitted) hand_out();
  const bool is_old = !uncommitted_.empty() && since_first_uncommitted_.seconds() > kCommitSeconds;
  if (is_old || uncommitted_.size() >= kCommitRuns || !operators_.empty() || !events_.empty())
    commit();
  const bool over = plan_->is_finished() || interrupted_ || !trouble_.empty();
  if (over && !draining_ && (plan_->stopped() || commit()) && !take_requeued() &&
      !take_next_round() && !take_shown_fields())
    begin_drain();
  if (!draining_) return true;
  if (!workers_are_drained() && since_drain_.seconds() < options_.patience) return true;
  return !commit();
}

void Manager::greet(int worker, const message::Hello& hello) {
  ++n_greeted_;
  hosts_[worker] = hello.host;
  cores_[worker] = hello.cores;
  const int fresh = static_cast<int>(host_numbers_.size()) + 1;  // 0 = not known yet
  plan_->place(worker, host_numbers_.try_emplace(hello.host, fresh).first->second);
}

void Manager::begin_drain() {
  draining_ = true;
  since_drain_ = {};
  plan_->stop();
  for (int worker = 0; worker < n_workers(); ++worker) tell(worker, message::Signal::drain);
}

void Manager::interrupt() {
  if (interrupted_) return;
  interrupted_ = true;
  plan_->stop();
  display_.note(
      concat("stopping: ", plan_->n_in_flight(),
             " cases were handed out; each worker may finish its current one, for at most ",
             options_.patience, " s"));
  if (locked_) {
    lock_is_noted_ = false;  // say what is waited for
    options_.lock_note_seconds = 0;
  }
}

void Manager::handle(int worker, JobEvents events) {
  for (const OperatorRecord& record : events.operators) {
    const int family = plan_->family_of(worker);
    FAULTSIM_DEMAND(family >= 0, worker);
    plan_->operator_ready(worker, record.seconds, record.from_cache,
                          static_cast<double>(record.peak_bytes));
    operators_.emplace_back(family, record);
  }
  for (JobEvents::Completed& one : events.completed) handle_result(worker, std::move(one));
  for (const JobEvents::Failure& failure : events.failed) handle_failure(worker, failure);
  if (!events.returned.empty()) {
    plan_->returned(worker, events.returned);
    for (const std::int64_t id : events.returned) positions_.erase(id);
  }
  if (!events.building.empty()) building_[worker] = std::move(events.building);
  fail_hopeless();
}

void Manager::handle_result(int worker, JobEvents::Completed completed) {
  RunRecord& run = completed.run;
  try {
    run.result = faultsim::result_from_bytes(completed.result);
    run.reason = run.result->reason;
  } catch (const StorageError& error) {
    run.status = RunStatus::garbled;
    run.reason = concat("sent a result that cannot be read: ", error.what());
    run.has_fields = false;
    handle_failure(worker, {std::move(run), false});
    return;
  }
  if (fields_only_.count(run.case_id) > 0) {
    if (const auto failure = refuse_fields(run)) {
      handle_failure(worker, *failure);
      return;
    }
  }
  plan_->case_done(worker, run.case_id, run.wall_seconds);
  if (is_extra(run.case_id)) {
    --n_extras_left_;
  } else {
    ++campaign_.n_done;
    if (!faultsim::in_equilibrium(run.result->outcome)) ++n_incomplete_;
  }
  add_run(std::move(run));
}

std::optional<JobEvents::Failure> Manager::refuse_fields(const RunRecord& run) {
  std::optional<faultsim::CaseResult> stored;
  insist([&] { stored = store_.stored_result(run.case_id); }, Access::reads);
  FAULTSIM_DEMAND(stored.has_value(), run.case_id);
  const std::string difference = first_difference(*stored, *run.result);
  if (difference.empty()) return std::nullopt;
  const bool same_operator = stored->operator_fingerprint == run.result->operator_fingerprint;
  RunRecord refused = run;
  refused.result.reset();
  refused.has_fields = false;
  refused.status = same_operator ? RunStatus::bug : RunStatus::world;
  refused.reason = concat(
      "the fields are not those of the stored result, from which this run differs in ", difference,
      same_operator ? std::string(", with the same operator")
                    : concat(": it used the operator ", run.result->operator_fingerprint,
                             ", the stored one comes from ", stored->operator_fingerprint));
  std::error_code ignored;  // if they cannot be removed, the store still says that there are none
  std::filesystem::remove_all(store_.fields_folder(campaign_.name, positions_.at(run.case_id)),
                              ignored);
  return JobEvents::Failure{std::move(refused), false};
}

void Manager::handle_failure(int worker, const JobEvents::Failure& failure) {
  RunRecord run = failure.run;
  run.final = !plan_->case_failed(worker, run.case_id, failure.in_operator);
  const long position = positions_.contains(run.case_id) ? positions_[run.case_id] : 0;
  const std::string text =
      concat(fields_only_.count(run.case_id) > 0 ? "fields of case " : "case ", position, " ",
             to_string(run.status), ": ", run.reason, run.final ? "" : "; it will be tried again");
  note_event("case failed", text);
  show_failure(text);
  if (run.final && is_extra(run.case_id)) {
    --n_extras_left_;
  } else if (run.final) {
    ++campaign_.n_failed;
    if (campaign_.policy.on_failure == FailureAction::abort && !aborted_) {
      aborted_ = true;
      note_event("aborted", "a case failed, and the spec's on_failure is abort");
    }
  }
  add_run(std::move(run));
}

/// What a mistake does to all cases alike is not told ten thousand times.
void Manager::show_failure(const std::string& text) {
  ++n_failures_shown_;
  if (n_failures_shown_ <= kFailuresShown) display_.note(text);
  if (n_failures_shown_ == kFailuresShown + 1)
    display_.note(concat("further failures are not shown here: `faultsweep status ", campaign_.name,
                         "` has them"));
}

void Manager::fail_hopeless() {
  for (const std::int64_t id : plan_->take_hopeless()) {
    RunRecord run;
    run.case_id = id;
    run.reason = concat("not tried: the operator of its family failed ",
                        WorkPlan::kOperatorAttempts, " times, see the failed cases of that family");
    is_extra(id) ? --n_extras_left_ : ++campaign_.n_failed;
    add_run(std::move(run));
  }
}

void Manager::add_run(RunRecord run) {
  if (uncommitted_.empty()) since_first_uncommitted_ = {};
  ++n_finished_now_;
  run.fields_only = fields_only_.count(run.case_id) > 0;
  positions_.erase(run.case_id);
  uncommitted_.push_back(std::move(run));
}

bool Manager::commit() {
  const bool is_empty = events_.empty() && operators_.empty() && uncommitted_.empty();
  if (is_empty) return true;
  return try_store([this] {
    for (; !events_.empty(); events_.pop_front())
      store_.record_event(campaign_.id, events_.front().first, events_.front().second);
    for (; !operators_.empty(); operators_.pop_front())
      store_.record_operator(plan_->work(operators_.front().first).id, operators_.front().second);
    store_.record_runs(campaign_.id, uncommitted_);
    uncommitted_.clear();
  });
}

void Manager::hand_out() {
  // Round by round, so that nobody gets a second slice before everybody had a first.
  for (bool any = true; any;) {
    any = false;
    for (int worker = 0; worker < n_workers(); ++worker) {
      if (const auto slice = plan_->next(worker)) {
        send_work(worker, *slice);
        any = busy_ = true;
      }
    }
  }
  for (int worker = 0; worker < n_workers(); ++worker) {
    if (plan_->take_release(worker)) tell(worker, message::Signal::release);
  }
}

void Manager::send_work(int worker, const Slice& slice) {
  if (slice.builds_operator) {
    since_build_[worker] = {};
    building_[worker].clear();
  }
  message::Work work;
  work.task.family = slice.family;
  work.task.time_limit = campaign_.policy.time_limit;
  work.task.operator_time_limit = campaign_.policy.operator_time_limit;
  work.task.memory_limit = campaign_.policy.memory_limit;
  work.task.threads = options_.threads.value_or(plan_->build_threads(worker, cores_[worker]));
  const bool extra = is_extra(slice.cases.front());  // then all of the slice are
  work.task.keep_fields = campaign_.keep_fields != KeepFields::shown || extra
                              ? steps_of(campaign_.keep_fields)
                              : KeepFields::none;
  work.task.fields_folder = fields_folder_;
  work.task.operator_seconds = plan_->work(slice.family).operator_seconds;
  std::set<std::int64_t>& sent = scenes_sent_[worker];
  for (const std::int64_t id : slice.cases) {
    CaseInput input;
    insist([&] { input = store_.case_input(campaign_.id, id); }, Access::reads);
    if (sent.insert(input.scene).second) {
      auto& base = work.scenes.emplace_back(input.scene, BaseScene());
      insist([&] { base.second = store_.base_scene(base.first); }, Access::reads);
    }
    positions_[id] = input.position;
    work.cases.push_back(std::move(input));
  }
  tell(worker, work);
}

void Manager::beat() {
  constexpr double kBeatSeconds = 1;
  constexpr double kLookSeconds = 0.1;  // the sums below are not for every turn
  if (since_look_.seconds() < kLookSeconds) return;
  since_look_ = {};
  Progress progress{campaign_.n_cases, campaign_.n_done, campaign_.n_failed, seconds_left(), ""};
  int n_building = 0;
  for (int worker = 0; worker < n_workers(); ++worker) n_building += plan_->is_building(worker);
  progress.doing = what_is_built(n_building);
  if (n_finished_now_ == 0 && n_building == 0) progress.seconds_left = -1;
  display_.show(progress);
  if (since_beat_.seconds() < kBeatSeconds) return;
  since_beat_ = {};
  bool is_cancelled = false;
  // Before anything else is written: by now another manager may have taken the store.
  const bool is_told = try_store([&] {
    store_.heartbeat(progress_json());
    is_cancelled = store_.is_cancelled(campaign_.id);
  });
  if (is_told && is_cancelled && !cancelled_) {
    cancelled_ = true;
    display_.note(concat(campaign_.name, " was cancelled: no more cases are handed out"));
    plan_->stop();
  }
}

/// "building 2 operators (operator 31 of a surface: meshing; factorising 97188 unknowns)".
std::string Manager::what_is_built(int n_building) const {
  constexpr int kFew = 3;  // more than these are not read
  if (n_building == 0) return "";
  std::string text = concat("building ", counted(n_building, "operator", "operators"));
  if (n_building > kFew) return text;
  std::vector<std::string> parts;
  for (int worker = 0; worker < n_workers(); ++worker) {
    if (plan_->is_building(worker) && !building_[worker].empty())
      parts.push_back(building_[worker]);
  }
  return parts.empty() ? text : concat(text, " (", joined(parts, "; "), ")");
}

/// A surface takes minutes to build, and its cases wait meanwhile.
double Manager::seconds_left() const {
  double longest = 0;
  for (int worker = 0; worker < n_workers(); ++worker)
    longest = std::max(longest, plan_->build_seconds_of(worker) - since_build_[worker].seconds());
  return plan_->seconds_left() + longest;
}

std::string Manager::progress_json() const {
  json workers = json::array();
  for (int worker = 0; worker < n_workers(); ++worker) {
    const int family = plan_->family_of(worker);
    const std::string state = plan_->n_outstanding(worker) == 0 ? "waiting"
                              : !plan_->is_building(worker)     ? "running cases"
                              : building_[worker].empty()       ? "building operator"
                                                                : "building: " + building_[worker];
    workers.push_back({{"rank", worker + 1},
                       {"host", hosts_[worker]},
                       {"state", state},
                       {"cases_at_hand", plan_->n_outstanding(worker)},
                       {"family", family < 0 ? json() : json(plan_->work(family).name)}});
  }
  const double seconds = since_start_.seconds();
  const json progress = {
      {"seconds", seconds},
      {"seconds_left", seconds_left()},
      {"finished_in_this_run", n_finished_now_},
      {"cases_per_second", seconds > 0 ? static_cast<double>(n_finished_now_) / seconds : 0},
      {"in_flight", plan_->n_in_flight()},
      {"stopping", draining_},
      {"workers", workers}};
  return progress.dump();
}

ExitCode Manager::status() const {
  if (!trouble_.empty()) return ExitCode::world;
  const bool undecided = campaign_.n_done + campaign_.n_failed < campaign_.n_cases;
  if (interrupted_ && (undecided || n_extras_left_ > 0)) return ExitCode::interrupted;
  if (undecided || campaign_.n_failed > 0 || n_incomplete_ > 0) {
    return ExitCode::incomplete;
  }
  return ExitCode::done;
}

}  // namespace faultsweep
