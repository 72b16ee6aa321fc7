#include "simulator/common/thread_team.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <thread>
#include <vector>

#include "simulator/common/process_memory.h"

namespace faultsim {
namespace {

TEST(ThreadTeam, DoesEachTaskOnceWhateverTheNumberOfThreads) {
  for (const int n_threads : {1, 2, 3, 8}) {
    ThreadTeam team(n_threads);
    for (int work = 0; work < 2000; ++work) {
      const int n = work % 23;
      std::vector<int> times(static_cast<std::size_t>(n), 0);
      team.for_each(n, [&](int i) { ++times[static_cast<std::size_t>(i)]; });
      EXPECT_EQ(times, std::vector<int>(static_cast<std::size_t>(n), 1)) << n_threads;
    }
    EXPECT_EQ(team.n_works(), 2000);
  }
}

/// The first task ends when the last one has begun: by another thread, as the caller is in one.
TEST(ThreadTeam, IsSeveralThreadsAtOnce) {
  constexpr int kThreads = 3;
  ThreadTeam team(kThreads);
  std::atomic<int> n_begun = 0;
  team.for_each(kThreads, [&](int) {
    ++n_begun;
    for (int round = 0; n_begun < kThreads; ++round) wait_a_moment(round);
  });
  EXPECT_EQ(team.n_taken_by_others(), kThreads - 1);
}

#ifndef __SANITIZE_ADDRESS__  // it maps memory of its own
/// Where no stack finds room but those that ended threads have left.
void work_within_the_memory_there_is() {
  ThreadTeam team(64);
  const rlim_t used = static_cast<rlim_t>(process_memory().address_space) + (1 << 20);
  const rlimit limit = {used, used};
  setrlimit(RLIMIT_AS, &limit);
  std::atomic<int> n_done = 0;
  team.for_each(100, [&](int) { ++n_done; });
  std::_Exit(n_done == 100 && team.n_threads() < 64 ? 0 : 1);
}

TEST(ThreadTeam, DoesWithoutThreadsThatCannotBeStarted) {
  EXPECT_EXIT(work_within_the_memory_there_is(), testing::ExitedWithCode(0), "");
}
#endif

TEST(ThreadTeam, LetsATaskWaitForThoseBeforeIt) {
  ThreadTeam team(3);
  for (int work = 0; work < 500; ++work) {
    std::atomic<int> n_done = 0;
    team.for_each(40, [&](int i) {
      for (int round = 0; n_done < i; ++round) wait_a_moment(round);
      ++n_done;
    });
    EXPECT_EQ(n_done, 40);
  }
}

TEST(ThreadTeam, CarriesAnExceptionOverAndGoesOn) {
  for (const int n_threads : {1, 2}) {
    ThreadTeam team(n_threads);
    for (int work = 0; work < 500; ++work) {
      std::atomic<int> n_begun = 0;
      const auto fail = [&](int i) {
        ++n_begun;
        if (i >= work % 5) throw std::runtime_error("task");
      };
      EXPECT_THROW(team.for_each(1000, fail), std::runtime_error);
      EXPECT_LE(n_begun, work % 5 + n_threads) << "what comes after it is not begun";
      team.for_each(3, [](int) {});
    }
  }
}

TEST(ThreadTeam, EndsAwakeAsleepAndUnused) {
  for (int k = 0; k < 200; ++k) {
    ThreadTeam unused(4), awake(2);
    awake.for_each(4, [](int) {});
  }
  ThreadTeam asleep(2);
  asleep.for_each(4, [](int) {});
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

TEST(ThreadTeam, MayBeMissing) {
  std::vector<int> order;
  for_each(nullptr, 3, [&](int i) { order.push_back(i); });
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2}));
  ThreadTeam team(2);
  for_each(&team, 1, [&](int i) { order.push_back(i); });
  EXPECT_EQ(team.n_works(), 0) << "one task is nothing to share";
}

}  // namespace
}  // namespace faultsim
