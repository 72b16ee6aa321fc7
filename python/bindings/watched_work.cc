#include "python/bindings/watched_work.h"

#include <chrono>
#include <exception>
#include <optional>
#include <thread>

#include "python/bindings/lent_worker.h"
#include "simulator/common/errors.h"

namespace faultsim::python {

namespace py = pybind11;

namespace {

/// The thread that ends Python; none while it runs.
std::optional<unsigned long> ending_thread;

/// Signals and callbacks, until one of them raises.
void look_once(LentWorker& worker, const std::function<void()>& look,
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
  if (ending_thread && *ending_thread != PyThread_get_thread_ident())
    throw Interrupted("Python ends: other threads than the one that ends it begin no work");
  std::optional<py::error_already_set> raised;
  std::exception_ptr failure;
  {
    LentWorker worker(work);
    const py::gil_scoped_release released;
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

void end_watched_works() {
  ending_thread = PyThread_get_thread_ident();
  LentWorker::stop_all();
  constexpr std::chrono::milliseconds kBetweenLooks(1);
  // Not for ever: a callback may wait for what no longer comes.
  for (int look = 0; look < 2000 && !LentWorker::are_all_idle(); ++look) {
    const py::gil_scoped_release released;
    std::this_thread::sleep_for(kBetweenLooks);
  }
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
