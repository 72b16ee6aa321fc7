#include "python/bindings/lent_worker.h"

#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <iterator>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "simulator/common/errors.h"

namespace faultsim::python {

using Work = std::function<void(StopToken)>;

/// It is never destroyed: its thread waits until the process ends, and touches nothing but this.
class Worker {
 public:
  Worker() { std::thread(&Worker::serve, this).detach(); }

  void begin(const Work& work) {
    const std::lock_guard lock(mutex_);
    stop_ = false;
    failure_ = nullptr;
    pthread_sigmask(SIG_SETMASK, nullptr, &signals_of_caller_);
    work_ = &work;
    changed_.notify_one();
  }
  bool ends_soon() {
    if (process_ != getpid()) {  // a callback has forked, and this is the child: nobody works here
      failure_ = std::make_exception_ptr(Error("the work was left to the parent process"));
      return true;
    }
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::milliseconds(10), [this] { return !work_; });
  }
  void stop() { stop_ = true; }
  bool is_stopped() const { return stop_; }
  const std::exception_ptr& failure() const { return failure_; }

  bool is_lent = false;

 private:
  [[noreturn]] void serve();
  void run() noexcept;

  std::mutex mutex_;
  std::condition_variable
      changed_;                 ///< of work_: this thread waits for some, or the caller for none.
  const Work* work_ = nullptr;  ///< null: nothing to do.
  sigset_t signals_of_caller_ = {};
  std::atomic<bool> stop_ = false;
  std::exception_ptr failure_;
  const pid_t process_ = getpid();
};

/// While it waits it takes no signal: who waits for one has blocked it in all threads that there
/// were, and those that are kept must not be where it is delivered instead.
void Worker::serve() {
  sigset_t all;
  sigfillset(&all);
  for (;;) {
    pthread_sigmask(SIG_SETMASK, &all, nullptr);
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return work_ != nullptr; });
    }
    pthread_sigmask(SIG_SETMASK, &signals_of_caller_, nullptr);
    run();
  }
}

void Worker::run() noexcept {
  try {
    (*work_)(StopToken(stop_));
  } catch (...) {
    failure_ = std::current_exception();
  }
  const std::lock_guard lock(mutex_);
  work_ = nullptr;
  changed_.notify_one();
}

namespace {

/// The threads of this process.
std::vector<Worker*>& workers() {
  static auto& all = *new std::vector<Worker*>;  // threads of Python may outlive what is destroyed
  static pid_t process = getpid();
  if (std::exchange(process, getpid()) != process) all.clear();  // their threads are the parent's
  return all;
}

Worker& lent_worker() {
  std::vector<Worker*>& all = workers();
  auto one = std::ranges::find(all, false, &Worker::is_lent);
  if (one == all.end()) {
    all.push_back(new Worker);
    one = std::prev(all.end());
  }
  (*one)->is_lent = true;
  return **one;
}

}  // namespace

LentWorker::LentWorker(const Work& work) : worker_(lent_worker()) { worker_.begin(work); }
LentWorker::~LentWorker() { worker_.is_lent = false; }

bool LentWorker::ends_soon() { return worker_.ends_soon(); }
void LentWorker::stop() { worker_.stop(); }
bool LentWorker::is_stopped() const { return worker_.is_stopped(); }
std::exception_ptr LentWorker::failure() const { return worker_.failure(); }

void LentWorker::stop_all() {
  for (Worker* one : workers()) one->stop();
}
bool LentWorker::are_all_idle() { return std::ranges::none_of(workers(), &Worker::is_lent); }

}  // namespace faultsim::python
