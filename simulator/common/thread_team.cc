#include "simulator/common/thread_team.h"

#include <sched.h>

#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

/// Looks for work before a thread sleeps, some 0.5 ms: in a case pieces follow each other closely,
/// and to be woken takes as long as a small one.
constexpr int kLooks = 20000;

}  // namespace

void wait_a_moment(int round) {
  constexpr int kBeforeOthers = 64;
  if (round % kBeforeOthers == kBeforeOthers - 1) {
    sched_yield();
    return;
  }
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

struct ThreadTeam::Shared {
  std::mutex mutex;
  std::condition_variable changed;
  const std::function<void(int)>* task = nullptr;  ///< null: whoever comes now comes too late.
  int n = 0;                                       ///< tasks.
  std::atomic<long> n_works = 0;                   ///< for_each that have begun.
  std::atomic<int> next = 0;                       ///< task.
  std::atomic<int> n_inside = 0;                   ///< others that are at it.
  std::atomic<long> n_taken = 0;                   ///< by others.
  std::exception_ptr failure;
  bool is_ending = false;
  std::vector<std::jthread> others;  ///< the last member: they use the rest.

  long take(const std::function<void(int)>& todo, int n_tasks);
  void live();
};

/// Does tasks while there are any. @returns how many.
long ThreadTeam::Shared::take(const std::function<void(int)>& todo, int n_tasks) {
  long n_done = 0;
  try {
    for (int i = next++; i < n_tasks; i = next++, ++n_done) todo(i);
  } catch (...) {
    next = n_tasks;
    const std::lock_guard lock(mutex);
    if (!failure) failure = std::current_exception();
  }
  return n_done;
}

void ThreadTeam::Shared::live() {
  long n_seen = 0;
  while (true) {
    for (int look = 0; look < kLooks && n_works == n_seen; ++look) wait_a_moment(look);
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return is_ending || n_works != n_seen; });
    if (is_ending) return;
    n_seen = n_works;
    if (task == nullptr) continue;
    const std::function<void(int)>& todo = *task;
    const int n_tasks = n;
    ++n_inside;
    lock.unlock();
    n_taken += take(todo, n_tasks);
    lock.lock();
    if (--n_inside == 0) changed.notify_all();
  }
}

ThreadTeam::ThreadTeam(int n_threads) : n_threads_(n_threads), shared_(std::make_unique<Shared>()) {
  FAULTSIM_DEMAND(n_threads >= 1, n_threads);
}

ThreadTeam::~ThreadTeam() {
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->is_ending = true;
  }
  shared_->changed.notify_all();
}

void ThreadTeam::for_each(int n, const std::function<void(int)>& task) {
  Shared& shared = *shared_;
  try {
    while (std::ssize(shared.others) < n_threads_ - 1)
      shared.others.emplace_back([&shared] { shared.live(); });
  } catch (const std::system_error&) {  // a limit on processes: those that there are will do
    n_threads_ = 1 + static_cast<int>(shared.others.size());
  }
  {
    const std::lock_guard lock(shared.mutex);
    shared.task = &task;
    shared.n = n;
    shared.next = 0;
    ++shared.n_works;
  }
  shared.changed.notify_all();
  shared.take(task, n);
  for (int look = 0; look < kLooks && shared.n_inside > 0; ++look) wait_a_moment(look);
  std::unique_lock lock(shared.mutex);
  shared.task = nullptr;
  shared.changed.wait(lock, [&] { return shared.n_inside == 0; });
  if (shared.failure) std::rethrow_exception(std::exchange(shared.failure, nullptr));
}

long ThreadTeam::n_works() const { return shared_->n_works; }
long ThreadTeam::n_taken_by_others() const { return shared_->n_taken; }

void for_each(ThreadTeam* team, int n, const std::function<void(int)>& task) {
  if (team != nullptr && n > 1 && team->n_threads() > 1) return team->for_each(n, task);
  for (int i = 0; i < n; ++i) task(i);
}

}  // namespace faultsim
