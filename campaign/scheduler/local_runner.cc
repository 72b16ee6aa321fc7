#include "campaign/scheduler/local_runner.h"

#include <algorithm>
#include <cmath>
#include <csignal>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "simulator/common/exit_code.h"
#include "simulator/result/result_bytes.h"

namespace faultsweep {

namespace {

constexpr int kProtocolVersion = 4;

/// A reply that is not what the protocol allows.
struct Garbled {
  std::string what;
};

std::string shortened(const std::string& text) {
  constexpr std::size_t kShown = 120;
  std::string shown = text.substr(0, kShown);
  for (char& c : shown) {
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f) c = '?';
  }
  return text.size() > kShown ? shown + "..." : shown;
}

bool mentions_memory(const std::string& text) {
  return text.find("out of memory") != std::string::npos ||
         text.find("not enough memory") != std::string::npos ||
         text.find("bad_alloc") != std::string::npos;
}

/// What an exit code of the simulator says about the case (common/exit_code.h).
RunStatus status_of(int exit_code, const std::string& text) {
  switch (exit_code) {
    case static_cast<int>(ExitCode::input):
      return RunStatus::refused;
    case static_cast<int>(ExitCode::world):
      return mentions_memory(text) ? RunStatus::memory : RunStatus::world;
    case static_cast<int>(ExitCode::bug):
      return RunStatus::bug;
    default:
      return RunStatus::crashed;
  }
}

OperatorRecord operator_record(const json& reply) {
  return {reply.at("fingerprint"), reply.at("from_cache"),    reply.at("seconds"),
          reply.at("unknowns"),    reply.at("jump_unknowns"), reply.at("bytes"),
          reply.at("peak_bytes")};
}

}  // namespace

void LocalRunner::begin_family(const FamilyTask& task) {
  end_family();
  task_ = task;
}

void LocalRunner::end_family() {
  FAULTSIM_DEMAND(jobs_.empty(), jobs_.size());
  if (!process_) return;
  process_->finish();
  process_->exchange(0);
  process_->wait(kEndGrace);
  process_.reset();
}

void LocalRunner::hold(std::int64_t base, const std::string& scene) {
  bases_[base] = json::parse(scene).dump();  // one line
}

void LocalRunner::add(Job job) {
  jobs_.push_back(std::move(job));
  if (!process_) {
    start();
    return;
  }
  if (jobs_.size() == 1) since_ = {};
  send(jobs_.back());
}

void LocalRunner::start() {
  SimulatorProcess::Options options = options_.process;
  options.memory_limit = task_.memory_limit;
  options.threads = task_.threads;
  process_ = std::make_unique<SimulatorProcess>(options);
  greeted_ = operator_known_ = started_ = false;
  operator_seconds_ = 0;
  since_ = {};
  bases_sent_.clear();
  result_.reset();
  for (const Job& job : jobs_) send(job);
}

void LocalRunner::send(const Job& job) {
  if (bases_sent_.insert(job.base).second) {
    process_->send(concat("{\"base\":", job.base, ",\"scene\":", bases_.at(job.base), "}"));
  }
  std::string line = concat("{\"run\":", job.case_id, ",\"base\":", job.base,
                            ",\"changes\":", job.changes, ",\"source\":", json(job.source).dump());
  if (!job.identity.empty()) line += concat(",\"identity\":\"", job.identity, "\"");
  if (!job.fields_folder.empty()) {
    const json fields = {{"folder", job.fields_folder}, {"steps", to_string(job.keep_fields)}};
    line += ",\"fields\":" + fields.dump();
  }
  process_->send(line + "}");
}

JobEvents LocalRunner::work(int timeout_ms) {
  JobEvents events;
  if (draining_ && !jobs_.empty()) {
    // The case in flight goes on; an operator build is given up, as it may take an hour.
    const std::size_t kept = started_ ? 1 : 0;
    while (jobs_.size() > kept) {
      events.returned.insert(events.returned.begin(), jobs_.back().case_id);
      jobs_.pop_back();
    }
    if (jobs_.empty()) process_.reset();
  }
  if (!process_) return events;
  process_->exchange(timeout_ms);
  try {
    // A drained process may be ahead of us with a case that was handed back.
    while (!(draining_ && jobs_.empty()) && handle_next(events)) {
    }
  } catch (const Garbled& garbled) {
    process_->kill();
    const ProcessEnd end = process_->wait(0);
    process_failed(RunStatus::garbled, garbled.what, end, events);
    return events;
  }
  if (draining_ && jobs_.empty()) {
    process_.reset();
  } else if (process_->is_silent()) {
    process_ended(events);
  } else if (const auto limit = time_limit(); limit && since_.seconds() > *limit) {
    process_->kill();
    const ProcessEnd end = process_->wait(0);
    process_failed(RunStatus::hung, concat("exceeded its time limit of ", *limit, " s"), end,
                   events);
  }
  return events;
}

void LocalRunner::drain() { draining_ = true; }

std::optional<double> LocalRunner::time_limit() const {
  if (jobs_.empty()) return std::nullopt;
  if (started_ || operator_known_) return task_.time_limit;
  return task_.operator_time_limit.value_or(
      std::max(kOperatorLeast, kOperatorFactor * task_.operator_seconds));
}

std::string LocalRunner::under_limit() const {
  return concat("; /policy/memory_limit is ", std::llround(*task_.memory_limit / 1e6), " MB");
}

RunRecord LocalRunner::blank_run(std::int64_t case_id) const {
  RunRecord run;
  run.case_id = case_id;
  run.host = options_.host;
  run.rank = options_.rank;
  run.wall_seconds = since_.seconds();
  return run;
}

bool LocalRunner::handle_next(JobEvents& events) {
  if (!result_) {
    const auto reply = process_->next_reply();
    if (reply) handle(*reply, events);
    return reply.has_value();
  }
  auto bytes = process_->next_bytes(result_->at("result_bytes").get<std::size_t>());
  if (!bytes) return false;
  const json reply = std::move(*result_);
  result_.reset();
  try {
    faultsim::require_sound_result(*bytes);
  } catch (const StorageError& error) {
    throw Garbled{concat("sent a result that cannot be read: ", error.what())};
  }
  handle_done(reply, std::move(*bytes), events);
  return true;
}

void LocalRunner::handle(const std::string& line, JobEvents& events) {
  const json reply = json::parse(line, nullptr, false);
  if (!reply.is_object() || !reply.contains("event") || !reply["event"].is_string()) {
    throw Garbled{concat("wrote '", shortened(line), "', which is not a reply")};
  }
  const std::string event = reply["event"];
  try {
    if (event == "hello") {
      const int version = reply.at("version").get<int>();
      const std::string program = options_.process.binary.string();
      if (version != kProtocolVersion) {
        throw ResourceError(concat("the simulator ", program, " speaks protocol version ", version,
                                   ", faultsweep ", kProtocolVersion,
                                   "; install both from the same source"));
      }
      if (reply.at("result_layout") != faultsim::result_layout()) {
        throw ResourceError(
            concat("the simulator ", program,
                   " is from another build than faultsweep: its results have different",
                   " fields; install both from the same source"));
      }
      greeted_ = true;
      return;
    }
    const std::int64_t run = reply.at("run").get<std::int64_t>();
    if (jobs_.empty() || jobs_.front().case_id != run) {
      throw Garbled{concat("replied to run ", run, " out of turn")};
    }
    if (event == "operator") {
      events.operators.push_back(operator_record(reply));
      operator_seconds_ = events.operators.back().seconds;
      operator_known_ = true;
      since_ = {};
    } else if (event == "building") {
      events.building = shortened(reply.at("what").get<std::string>());
    } else if (event == "started") {
      started_ = true;
      since_ = {};
    } else if (event == "done" && reply.contains("result_bytes")) {
      if (reply["result_bytes"].get<std::size_t>() > SimulatorProcess::kLongestReply)
        throw Garbled{"announced a result that is too long"};
      result_ = reply;
    } else if (event == "done") {
      handle_done(reply, "", events);
    } else {
      throw Garbled{concat("sent the unknown event '", shortened(event), "'")};
    }
  } catch (const json::exception& error) {
    throw Garbled{concat("sent an incomplete reply: ", error.what())};
  }
}

void LocalRunner::handle_done(const json& reply, std::string result, JobEvents& events) {
  RunRecord run = blank_run(jobs_.front().case_id);
  if (!result.empty()) {
    run.has_fields = !jobs_.front().fields_folder.empty();
    if (run.has_fields && !reply.contains("fields")) {
      throw Garbled{"sent a result without the requested fault fields"};
    }
    run.status = RunStatus::completed;
    // The first case's time has the operator in it, which is not part of what a case takes.
    run.wall_seconds = std::max(0.0, reply.at("seconds").get<double>() - operator_seconds_);
    operator_known_ = true;
    events.completed.push_back({std::move(run), std::move(result)});
  } else {
    const int exit_code = reply.at("exit_code").get<int>();
    run.reason = reply.at("error").get<std::string>();
    if (exit_code == static_cast<int>(ExitCode::interrupted)) {
      events.returned.push_back(run.case_id);
    } else {
      run.status = status_of(exit_code, run.reason);
      if (run.status == RunStatus::memory && task_.memory_limit) run.reason += under_limit();
      run.exit_code = exit_code;
      run.log_tail = process_->log_tail();
      const bool in_operator = !started_ && !operator_known_ && run.status != RunStatus::refused;
      events.failed.push_back({std::move(run), in_operator});
    }
  }
  jobs_.pop_front();
  started_ = false;
  operator_seconds_ = 0;
  since_ = {};
}

void LocalRunner::process_ended(JobEvents& events) {
  const ProcessEnd end = process_->wait(kEndGrace);
  const std::string tail = process_->log_tail();
  // Whatever ends it that early would end the next one too, unless somebody killed it.
  if (!greeted_ && end.signal != SIGKILL) {
    throw ResourceError(
        concat("the simulator ", options_.process.binary.string(), " ", describe(end),
               " before it said hello; its last words: ", tail.empty() ? "none" : tail));
  }
  RunStatus status = RunStatus::crashed;
  std::string reason = describe(end);
  if (process_->overflowed()) {
    status = RunStatus::garbled;
    reason =
        concat("wrote more than ", SimulatorProcess::kLongestReply, " bytes without a newline");
  } else if (end.signal == SIGKILL) {
    status = RunStatus::memory;
    reason += ", as the kernel does when memory runs out";
  } else if (mentions_memory(tail)) {
    status = RunStatus::memory;
    reason += ", out of memory";
    if (task_.memory_limit) reason += under_limit();
  } else if (end.exit_code) {
    status = status_of(*end.exit_code, tail);
  }
  if (jobs_.empty()) {
    process_.reset();  // between slices: nobody is to blame, the next job starts another one
    return;
  }
  process_failed(status, reason, end, events);
}

void LocalRunner::process_failed(RunStatus status, std::string reason, const ProcessEnd& end,
                                 JobEvents& events) {
  const std::string tail = process_->log_tail();
  process_.reset();
  if (jobs_.empty()) return;
  RunRecord run = blank_run(jobs_.front().case_id);
  run.status = status;
  const bool in_operator = !started_ && !operator_known_;
  const char* const phase = !greeted_     ? "before it said hello: "
                            : in_operator ? "while building the operator: "
                                          : "";
  run.reason = phase + std::move(reason);
  run.signal = end.signal;
  run.exit_code = end.exit_code;
  run.log_tail = tail;
  events.failed.push_back({std::move(run), in_operator});
  jobs_.pop_front();
  if (in_operator) {
    for (const Job& job : jobs_) events.returned.push_back(job.case_id);
    jobs_.clear();
  }
  started_ = false;
  if (!jobs_.empty() && !draining_) start();
}

}  // namespace faultsweep
