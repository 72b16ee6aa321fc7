#include "simulator/simulation/operator_build.h"

#include <pthread.h>

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/linalg/blas_start.h"

namespace faultsim {
namespace {

/// METIS takes SIGTERM for itself by a handler that may run in its own thread only. While another
/// waits for it, that one does not take the signal.
class SigtermLeftToTheBuild {
 public:
  SigtermLeftToTheBuild() {
    sigset_t blocked;
    sigemptyset(&blocked);
    sigaddset(&blocked, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &blocked, &before_);
  }
  ~SigtermLeftToTheBuild() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SigtermLeftToTheBuild(const SigtermLeftToTheBuild&) = delete;
  SigtermLeftToTheBuild& operator=(const SigtermLeftToTheBuild&) = delete;

 private:
  sigset_t before_;
};

}  // namespace

/// What the two threads share; the monitor keeps what is told until it is fetched.
struct OperatorBuild::Shared final : Monitor {
  std::mutex mutex;
  std::condition_variable news;
  std::pair<double, std::string> last_progress;
  bool progressed = false, ended = false;
  std::vector<std::string> notes;
  OperatorSource::Made made;
  std::exception_ptr thrown;
  std::atomic<bool> stop = false;
  std::jthread thread;  // last: it ends before what it uses

  void progress(double fraction, const std::string& what) override {
    const std::lock_guard lock(mutex);
    last_progress = {fraction, what};
    progressed = true;
    news.notify_one();
  }
  void note(const std::string& text) override {
    const std::lock_guard lock(mutex);
    notes.push_back(text);
    news.notify_one();
  }
  void tell(const RunContext& context) {
    for (const std::string& text : std::exchange(notes, {})) context.note(text);
    if (std::exchange(progressed, false))
      context.progress(last_progress.first, last_progress.second);
  }
};

OperatorBuild::OperatorBuild(std::function<OperatorSource::Made(const RunContext&)> make,
                             int n_threads)
    : shared_(std::make_unique<Shared>()) {
  take_blas_buffer();
  Shared* shared = shared_.get();
  shared->thread = std::jthread([make = std::move(make), shared, n_threads] {
    OperatorSource::Made made;
    std::exception_ptr thrown;
    try {
      made = make({*shared, StopToken(shared->stop), n_threads});
    } catch (...) {
      thrown = std::current_exception();
    }
    const std::lock_guard lock(shared->mutex);
    shared->made = std::move(made);
    shared->thrown = std::move(thrown);
    shared->ended = true;
    shared->news.notify_one();
  });
}

OperatorBuild::~OperatorBuild() { shared_->stop = true; }

void OperatorBuild::wait_for_end(const RunContext& context) {
  constexpr std::chrono::milliseconds kLook{2};
  const SigtermLeftToTheBuild left;
  Shared& shared = *shared_;
  std::unique_lock lock(shared.mutex);
  while (!shared.ended) {
    shared.news.wait_for(lock, kLook);
    if (!shared.stop) shared.tell(context);
    if (!context.stop.requested()) continue;
    shared.stop = true;
    context.stop.throw_if_requested("preparing the operator");
  }
  if (!shared.stop) shared.tell(context);
}

OperatorSource::Made OperatorBuild::wait(const RunContext& context) {
  wait_for_end(context);
  if (shared_->thrown) std::rethrow_exception(shared_->thrown);
  return std::move(shared_->made);
}

}  // namespace faultsim
