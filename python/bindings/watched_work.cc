#include "python/bindings/watched_work.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <optional>
#include <thread>

namespace faultsim::python {

namespace py = pybind11;

namespace {

constexpr std::chrono::milliseconds kBetweenLooks(10);

/// A piece of work in its thread.
class Worker {
 public:
  explicit Worker(const std::function<void(StopToken)>& work)
      : thread_([this, &work] {
          try {
            work(StopToken(stop_));
          } catch (...) {
            failure_ = std::current_exception();
          }
          const std::lock_guard lock(mutex_);
          has_ended_ = true;
          ended_.notify_one();
        }) {}
  ~Worker() { thread_.join(); }

  bool ends_soon() {
    std::unique_lock lock(mutex_);
    return ended_.wait_for(lock, kBetweenLooks, [this] { return has_ended_; });
  }
  void stop() { stop_ = true; }
  bool is_stopped() const { return stop_; }
  const std::exception_ptr& failure() const { return failure_; }  ///< @pre it has ended.

 private:
  std::atomic<bool> stop_ = false;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool has_ended_ = false;
  std::exception_ptr failure_;
  std::thread thread_;  // last: it uses all of the above
};

/// Signals and callbacks, until one of them raises.
void look_once(Worker& worker, const std::function<void()>& look,
               std::optional<py::error_already_set>& raised) {
  if (worker.is_stopped()) return;
  try {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (look) look();
  } catch (py::error_already_set& error) {
    raised.emplace(std::move(error));
    worker.stop();
  }
}

}  // namespace

void run_watched(const std::function<void(StopToken)>& work, const std::function<void()>& look) {
  std::optional<py::error_already_set> raised;
  std::exception_ptr failure;
  {
    const py::gil_scoped_release released;
    Worker worker(work);
    while (!worker.ends_soon()) {
      const py::gil_scoped_acquire held;
      look_once(worker, look, raised);
    }
    failure = worker.failure();
  }
  if (raised) throw std::move(*raised);
  if (failure) std::rethrow_exception(failure);
  if (look) look();
}

HeldAlone::HeldAlone(std::atomic<bool>& is_held, const char* what) : is_held_(is_held) {
  if (!is_held.exchange(true)) return;
  PyErr_Format(PyExc_RuntimeError, "another thread is using this %s: give each thread its own",
               what);
  throw py::error_already_set();
}

void ToldMonitor::progress(double fraction, const std::string& what) {
  const std::lock_guard lock(mutex_);
  is_new_ = true;
  fraction_ = fraction;
  what_ = what;
}

void ToldMonitor::hand_over() {
  double fraction = 0;
  std::string what;
  {
    const std::lock_guard lock(mutex_);
    if (!is_new_ || told_.is_none()) return;
    is_new_ = false;
    fraction = fraction_;
    what = what_;
  }
  told_(fraction, what);
}

}  // namespace faultsim::python
