#include "simulator/linalg/nested_dissection.h"

#include <gmock/gmock.h>
#include <pthread.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <set>
#include <thread>

#include "simulator/common/errors.h"
#include "simulator/common/interrupt.h"
#include "simulator/linalg/corner_dissection.h"

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

/// The nodes of tetrahedra of ten nodes, six in each of n x n x n cubes.
struct QuadraticLattice {
  explicit QuadraticLattice(int n) {
    const int line = 2 * n + 1;  // corners at even places, middles of sides at the others
    const auto number = [&](const std::array<int, 3>& at) {
      return (at[2] * line + at[1]) * line + at[0];
    };
    std::set<std::pair<int, int>> edges;
    ends.resize(static_cast<std::size_t>(line * line * line));
    std::array<int, 3> at{};
    for (at[2] = 0; at[2] < line; ++at[2])
      for (at[1] = 0; at[1] < line; ++at[1])
        for (at[0] = 0; at[0] < line; ++at[0]) {
          std::array<int, 3> below = at, above = at;
          for (std::size_t c = 0; c < 3; ++c) below[c] -= at[c] % 2, above[c] += at[c] % 2;
          ends[static_cast<std::size_t>(number(at))] = {number(below), number(above)};
          if (at == below) ends[static_cast<std::size_t>(number(at))] = {-1, -1};
          if (at == below && *std::ranges::max_element(at) + 1 < line) add_cube(at, number, edges);
        }
    graph.begin.push_back(0);
    auto edge = edges.begin();
    for (int v = 0; v < static_cast<int>(ends.size()); ++v) {
      for (; edge != edges.end() && edge->first == v; ++edge) graph.rows.push_back(edge->second);
      graph.begin.push_back(static_cast<long>(graph.rows.size()));
    }
  }

  GroupGraph graph;
  std::vector<std::array<int, 2>> ends;

 private:
  template <typename Number>
  static void add_cube(const std::array<int, 3>& at, const Number& number,
                       std::set<std::pair<int, int>>& edges) {
    std::array<std::size_t, 3> axes = {0, 1, 2};
    do {  // along the axes one after the other
      std::vector<std::array<int, 3>> corners = {at};
      for (const std::size_t axis : axes) {
        corners.push_back(corners.back());
        corners.back()[axis] += 2;
      }
      std::vector<int> nodes;
      for (const auto& a : corners)
        for (const auto& b : corners)
          nodes.push_back(number({(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2}));
      for (const int a : nodes)
        for (const int b : nodes)
          if (a < b) edges.emplace(a, b);
    } while (std::next_permutation(axes.begin(), axes.end()));
  }
};

TEST(CornerDissection, OrdersEachNodeOnceAndFillsLessThanDissectingAllNodes) {
  QuadraticLattice lattice(8);
  const std::vector<long> order = corner_dissection(lattice.graph, lattice.ends, nullptr).value();
  std::vector<long> all(order.size());
  std::iota(all.begin(), all.end(), 0L);
  EXPECT_THAT(order, testing::UnorderedElementsAreArray(all));
  EXPECT_EQ(order.size(), 17U * 17 * 17);
  const long plain = factor_entries(lattice.graph, nested_dissection(lattice.graph).value());
  EXPECT_LT(factor_entries(lattice.graph, order), 0.95 * static_cast<double>(plain));
}

/// Sets are numbered as in the walk of a binary tree that comes to both halves before what is
/// between them: neighbours are of one set, or one of them is between halves of which one has the
/// other.
TEST(NestedDissection, SetsAreDomainsAndWhatIsBetweenThem) {
  const GroupGraph graph = lattice(10);
  constexpr int kDomains = 8;
  const std::vector<int> sets = dissected_sets(graph, kDomains).value();
  ASSERT_EQ(sets.size(), 1000U);
  std::vector<int> first_below;  // of a set
  const std::function<void(int)> walk = [&](int n_domains) {
    const int first = static_cast<int>(first_below.size());
    if (n_domains > 1) {
      walk(n_domains / 2);
      walk(n_domains / 2);
    }
    first_below.push_back(first);
  };
  walk(kDomains);
  std::vector<int> sizes(2 * kDomains - 1, 0);
  for (std::size_t v = 0; v < sets.size(); ++v) {
    ASSERT_LT(sets[v], 2 * kDomains - 1);
    ++sizes[static_cast<std::size_t>(sets[v])];
    for (long k = graph.begin[v]; k < graph.begin[v + 1]; ++k) {
      const auto [low, high] = std::minmax(
          sets[v], sets[static_cast<std::size_t>(graph.rows[static_cast<std::size_t>(k)])]);
      EXPECT_GE(low, first_below[static_cast<std::size_t>(high)]) << low << " beside " << high;
    }
  }
  EXPECT_GT(*std::ranges::min_element(sizes), 0);
  EXPECT_LT(sizes.back(), 150) << "a plane of 100 would do";
}

TEST(NestedDissection, LeavesSignalsAsTheyWere) {
  stop_on_signals();
  const struct sigaction before = action_of(SIGTERM);
  nested_dissection(lattice(12));
  dissected_sets(lattice(12), 4);
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
