#include "simulator/linalg/nested_dissection.h"

#include <gmock/gmock.h>
#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <set>
#include <thread>

#include "simulator/common/errors.h"
#include "simulator/common/interrupt.h"

namespace faultsim {
namespace {

/// n x n x n points, each with its neighbours along the three axes.
GroupGraph lattice(long n) {
  GroupGraph graph;
  graph.begin.push_back(0);
  for (long p = 0; p < n * n * n; ++p) {
    if (p % n + 1 < n) graph.rows.push_back(p + 1);
    if (p / n % n + 1 < n) graph.rows.push_back(p + n);
    if (p / n / n + 1 < n) graph.rows.push_back(p + n * n);
    graph.begin.push_back(static_cast<long>(graph.rows.size()));
  }
  return graph;
}

struct sigaction action_of(int number) {
  struct sigaction action = {};
  sigaction(number, nullptr, &action);
  return action;
}

/// Entries of the Cholesky factor if the vertices are eliminated in this order.
long factor_entries(const GroupGraph& graph, const std::vector<long>& order) {
  const long n = static_cast<long>(order.size());
  std::vector<long> place(n);
  for (long k = 0; k < n; ++k) place[order[k]] = k;
  std::vector<std::set<long>> later(n);  // by place
  for (long j = 0; j < n; ++j) {
    for (long k = graph.begin[j]; k < graph.begin[j + 1]; ++k) {
      const auto [first, last] = std::minmax(place[j], place[graph.rows[k]]);
      later[first].insert(last);
    }
  }
  long n_entries = n;
  for (std::set<long>& mine : later) {  // what a column leaves goes to its parent
    n_entries += static_cast<long>(mine.size());
    if (mine.empty()) continue;
    const long parent = *mine.begin();
    mine.erase(mine.begin());
    later[parent].insert(mine.begin(), mine.end());
  }
  return n_entries;
}

TEST(NestedDissection, OrdersEachVertexOnceAndFillsLittle) {
  const GroupGraph graph = lattice(12);
  const std::vector<long> order = nested_dissection(graph).value();
  std::vector<long> all(order.size());
  std::iota(all.begin(), all.end(), 0L);
  EXPECT_THAT(order, testing::UnorderedElementsAreArray(all));
  EXPECT_EQ(order.size(), 12U * 12 * 12);
  EXPECT_LT(2 * factor_entries(graph, order), factor_entries(graph, all));
}

TEST(NestedDissection, LeavesSignalsAsTheyWere) {
  stop_on_signals();
  const struct sigaction before = action_of(SIGTERM);
  nested_dissection(lattice(12));
  EXPECT_EQ(action_of(SIGTERM).sa_handler, before.sa_handler);
  EXPECT_EQ(action_of(SIGTERM).sa_flags, before.sa_flags);
}

/// METIS's own handler of SIGTERM crashes in any thread but the one that orders.
void be_terminated_while_ordering() {
  const StopToken stop = stop_on_signals();
  static std::atomic<bool> about_to_begin = false;
  std::thread([] {
    while (!about_to_begin) std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    pthread_kill(pthread_self(), SIGTERM);
  }).detach();
  try {
    nested_dissection(lattice(60), [=] {
      about_to_begin = true;
      return stop.requested();
    });
  } catch (const Interrupted& stopped) {
    std::fputs(stopped.what(), stderr);
    std::_Exit(75);
  }
  std::_Exit(1);
}

TEST(NestedDissectionDeathTest, AnotherThreadMayTakeATermination) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(be_terminated_while_ordering(), testing::ExitedWithCode(75),
              "stopped while ordering the unknowns");
}

}  // namespace
}  // namespace faultsim
