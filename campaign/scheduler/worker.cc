#include "campaign/scheduler/worker.h"

#include <iterator>

#include "campaign/scheduler/messenger.h"
#include "simulator/common/errors.h"
#include "simulator/common/machine.h"

namespace faultsweep {

namespace {

/// Results wait this long for company, s: a message costs little, but not nothing.
constexpr double kReportSeconds = 0.02;

template <typename Value>
void append(std::vector<Value>& to, std::vector<Value>& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

}  // namespace

bool Worker::turn(int timeout_ms) {
  busy_ = false;
  while (const auto received = link_.receive()) {
    busy_ = true;
    const Message& message = received->message;
    if (const auto* work = std::get_if<message::Work>(&message)) {
      take(*work);
    } else if (is(message, message::Signal::release)) {
      release();
    } else if (is(message, message::Signal::drain)) {
      draining_ = true;
      runner_.drain();
    } else {
      FAULTSIM_DEMAND(is(message, message::Signal::quit), message.index());
      quit_ = true;
    }
  }
  if (quit_) return false;
  if (!in_trouble_) {
    try {
      collect(runner_.work(timeout_ms));
    } catch (const faultsim::ResourceError& error) {
      in_trouble_ = true;
      tell(message::Trouble{error.what()});
    }
  }
  busy_ = busy_ || (!runner_.is_idle() && !in_trouble_);
  report(runner_.is_idle());
  if (draining_ && !said_drained_ && (in_trouble_ || runner_.is_idle())) {
    said_drained_ = true;
    tell(message::Signal::drained);
  }
  return true;
}

void Worker::take(const message::Work& work) {
  for (const auto& [id, scene] : work.scenes) {
    sources_[id] = scene.source;
    runner_.hold(id, scene.document);
  }
  if (draining_ || in_trouble_) {
    for (const CaseInput& one : work.cases) pending_.returned.push_back(one.id);
    return;
  }
  try {
    if (work.task.family != family_) {
      runner_.begin_family(work.task);
      family_ = work.task.family;
    }
    for (const CaseInput& one : work.cases) {
      Job job;
      job.case_id = one.id;
      job.identity = one.identity;
      job.base = one.scene;
      job.changes = one.changes;
      job.source = sources_.at(one.scene);
      if (work.task.keep_fields != KeepFields::none) {
        job.fields_folder = faultsim::concat(work.task.fields_folder, '/', one.position);
        job.keep_fields = work.task.keep_fields;
      }
      runner_.add(std::move(job));
    }
  } catch (const faultsim::ResourceError& error) {
    in_trouble_ = true;
    tell(message::Trouble{error.what()});
  }
}

void Worker::release() {
  if (!in_trouble_) {
    runner_.end_family();
    family_ = -1;
  }
  tell(message::Signal::released);
}

void Worker::collect(JobEvents events) {
  if (events.empty()) return;
  busy_ = true;
  // An operator is news for the others: it goes out at once.
  const bool urgent = !events.operators.empty();
  append(pending_.completed, events.completed);
  append(pending_.failed, events.failed);
  append(pending_.returned, events.returned);
  append(pending_.operators, events.operators);
  if (!events.building.empty()) pending_.building = std::move(events.building);
  report(urgent);
}

void Worker::report(bool now) {
  if (pending_.empty() || (!now && since_report_.seconds() < kReportSeconds)) return;
  tell(std::move(pending_));
  pending_ = {};
  since_report_ = {};
}

void run_worker(Link& link, JobRunner& runner, const std::string& host,
                const std::function<bool()>& must_leave) {
  link.send(0, message::Hello{host, faultsim::usable_cores()});
  Worker worker(link, runner);
  IdleSleep idle;
  constexpr int kWaitMs =
      2;  // for the simulator's replies, which wake us; messages must wait so long
  while (!must_leave() && worker.turn(kWaitMs)) idle.after_turn(worker.is_busy());
}

}  // namespace faultsweep
