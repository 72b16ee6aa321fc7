#include "simulator/what_if/resident_case.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "simulator/common/errors.h"
#include "simulator/common/thread_team.h"
#include "simulator/operators/prepare_operator.h"
#include "simulator/simulation/inside.h"
#include "simulator/simulation/loaded_scene.h"

namespace faultsim {

/// What the thread and those who ask share: under the mutex; `simulation` and `taken_scene` are the
/// thread's.
struct ResidentCase::Impl {
  Impl(int threads, std::chrono::milliseconds between)
      : n_threads(threads), between_words(between), team(std::min(threads, kMostThreadsOfCase)) {}
  void live();
  bool take_next();
  void hold(long question);
  bool leaves_build(long question);
  void answer(long question);
  std::shared_ptr<const ShownCase> run(long question);
  void tell(long question, const QuestionProgress& how);
  void tell_build(const std::string& what);
  /// The thread is at an operator that the newest question needs too.
  bool keeps_build() const { return is_at_build && taken_key == operator_key; }
  bool is_known(const std::string& key) const {
    const std::lock_guard lock(mutex);
    return key == operator_key;
  }

  const int n_threads;
  const std::chrono::milliseconds between_words;  ///< about a run.
  ThreadTeam team;                                ///< of the thread, for cases.
  Simulation simulation;
  LoadedScene taken_scene;  ///< until it is held.
  Listener listener = [](long, const QuestionProgress&) {};

  std::mutex listening;  ///< one call of the listener at a time; taken before the other.
  mutable std::mutex mutex;
  mutable std::condition_variable changed;
  long newest = 0;            ///< number of the newest question; 0: none.
  QuestionProgress progress;  ///< of the newest.
  LoadedScene scene;          ///< of the newest, until it is taken.
  std::string operator_key;   ///< of the newest: with its surface, if it is on one.
  long taken = 0;             ///< the question that the thread is on, or was.
  std::string taken_key;      ///< its operator_key.
  bool is_at_build = false;   ///< the thread is at that operator.
  bool is_ending = false;
  std::atomic<bool> stop = false;  ///< ends what the thread is doing.
  std::thread thread;              ///< the last member: it uses all others.
};

namespace {

/// Tells what an operator's build is doing.
class BuildWords final : public Monitor {
 public:
  explicit BuildWords(std::function<void(const std::string&)> tell) : tell_(std::move(tell)) {}
  void progress(double, const std::string& what) override { tell_(what); }
  void note(const std::string&) override {}

 private:
  std::function<void(const std::string&)> tell_;
};

/// Tells how far a run is, "production, 40 %", now and then: most runs end before the first.
class RunWords final : public Monitor {
 public:
  RunWords(std::chrono::milliseconds between, std::function<void(const std::string&)> tell)
      : between_(between), tell_(std::move(tell)) {}
  void progress(double fraction, const std::string& what) override {
    const auto now = std::chrono::steady_clock::now();
    if (now - told_ < between_) return;
    told_ = now;
    tell_(concat(what, ", ", std::lround(100 * fraction), " %"));
  }
  void note(const std::string&) override {}

 private:
  std::chrono::milliseconds between_;
  std::function<void(const std::string&)> tell_;
  std::chrono::steady_clock::time_point told_ = std::chrono::steady_clock::now();
};

}  // namespace

/// Waits for a question and takes it. @returns false at the end.
bool ResidentCase::Impl::take_next() {
  std::unique_lock lock(mutex);
  changed.wait(lock, [&] { return is_ending || taken != newest; });
  if (is_ending) return false;
  taken = newest;
  taken_key = operator_key;
  taken_scene = std::move(scene);
  stop = false;
  return true;
}

void ResidentCase::Impl::live() {
  while (take_next()) answer(taken);
}

/// Holds the scene of the question that was taken.
void ResidentCase::Impl::hold(long question) {
  Inside::hold(simulation, std::move(taken_scene));
  const std::lock_guard lock(mutex);
  is_at_build = simulation.needs_operator();
  if (is_at_build && question == newest) progress.state = QuestionState::building;
}

/// @returns whether the question is still the newest.
bool ResidentCase::Impl::leaves_build(long question) {
  const std::lock_guard lock(mutex);
  is_at_build = false;
  return question == newest;
}

/// Says so to whoever waits and listens, unless the question is superseded.
void ResidentCase::Impl::tell(long question, const QuestionProgress& how) {
  const std::lock_guard in_turn(listening);
  {
    const std::lock_guard lock(mutex);
    if (question != newest) return;
    progress = how;
  }
  changed.notify_all();
  listener(question, how);
}

/// What the build is doing is said of the newest question, where it needs that operator.
void ResidentCase::Impl::tell_build(const std::string& what) {
  long question = 0;
  {
    const std::lock_guard lock(mutex);
    if (!keeps_build() || progress.says == what) return;
    question = newest;
  }
  tell(question, {.state = QuestionState::building, .says = what});
}

/// Runs what the thread has taken; what is superseded meanwhile is left.
void ResidentCase::Impl::answer(long question) {
  try {
    hold(question);
    BuildWords words([&](const std::string& what) { tell_build(what); });
    simulation.prepare({words, StopToken(stop), n_threads});
    if (!leaves_build(question)) return;
    tell(question, {.state = QuestionState::running});
    std::shared_ptr<const ShownCase> shown = run(question);
    if (shown->result.outcome != Outcome::interrupted)
      tell(question, {.state = QuestionState::done, .shown = std::move(shown)});
  } catch (const Interrupted&) {  // superseded, or the end
    leaves_build(question);
  } catch (const std::exception& error) {  // whoever asks goes on
    leaves_build(question);
    tell(question, {.state = QuestionState::failed, .says = error.what()});
  }
}

std::shared_ptr<const ShownCase> ResidentCase::Impl::run(long question) {
  const LoadedScene& loaded = Inside::scene(simulation);
  auto shown = std::make_shared<ShownCase>(ShownCase{
      loaded.document, loaded.scene, {}, FieldRecorder(Inside::prepared(simulation).op->geometry)});
  RunWatch watch;
  watch.step = [&](const StepResult& step, const FaultFields& fields) {
    shown->fields.add_step(step, fields);
  };
  RunWords words(between_words, [&](const std::string& how_far) {
    tell(question, {.state = QuestionState::running, .says = how_far});
  });
  RunContext context(words, StopToken(stop));
  context.team = &team;
  shown->result = simulation.run(context, watch);
  return shown;
}

ResidentCase::ResidentCase(const CachePolicy& cache, int n_threads,
                           std::chrono::milliseconds between_words)
    : impl_(std::make_unique<Impl>(n_threads, between_words)) {
  impl_->simulation.keep_operators(cache);
  impl_->thread = std::thread([&self = *impl_] { self.live(); });
}

ResidentCase::~ResidentCase() {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->is_ending = true;
    impl_->stop = true;
  }
  impl_->changed.notify_all();
  impl_->thread.join();
}

void ResidentCase::ask(long number, JsonDocument scene, const Changes& changes) {
  apply(changes, scene);
  LoadedScene loaded = load_scene(std::move(scene));
  const std::string key = operator_key(loaded);
  if (!impl_->is_known(key)) check_geometry(loaded);  // of a family once: it takes its mesh
  long superseded = 0;
  {
    const std::lock_guard lock(impl_->mutex);
    FAULTSIM_DEMAND(number > impl_->newest, number, " after ", impl_->newest);
    if (impl_->progress.is_open()) superseded = impl_->newest;
    impl_->newest = number;
    impl_->scene = std::move(loaded);
    impl_->operator_key = key;
    if (!impl_->keeps_build()) {
      impl_->progress = {};
      impl_->stop = true;
    }
  }
  impl_->changed.notify_all();
  if (superseded > 0) {
    const std::lock_guard in_turn(impl_->listening);
    impl_->listener(superseded, {.state = QuestionState::superseded});
  }
}

QuestionProgress ResidentCase::progress(long number) const {
  const std::lock_guard lock(impl_->mutex);
  FAULTSIM_DEMAND(number >= 1 && number <= impl_->newest, number);
  if (number < impl_->newest) return {.state = QuestionState::superseded};
  return impl_->progress;
}

QuestionProgress ResidentCase::wait(long number, std::chrono::milliseconds longest) const {
  {
    std::unique_lock lock(impl_->mutex);
    impl_->changed.wait_for(lock, longest,
                            [&] { return number < impl_->newest || !impl_->progress.is_open(); });
  }
  return progress(number);
}

void ResidentCase::listen(Listener listener) { impl_->listener = std::move(listener); }

}  // namespace faultsim
