// Random faults in random grids: each is found, or the report says what became of it. The judge
// compares corners of neighbouring columns itself, and knows the lines that the faults were made
// on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <iterator>
#include <numbers>
#include <set>

#include "random_grid.h"
#include "simulator/corner_point/structure_finder.h"

namespace faultsim::corner_point {
namespace {

using Columns = std::set<std::pair<int, int>>;  ///< pairs of columns, the smaller first.

/// The largest offset between two columns on the pillars that they share.
double step_between(const CornerPointGrid& grid, int column, int other, bool is_along_i) {
  double largest = 0, any = 0;
  bool has_both = false;
  for (int k = 0; k < grid.size[2]; ++k) {
    double here = 0;
    for (const bool bottom : {false, true}) {
      for (const bool far : {false, true}) {
        const CornerPlace one = is_along_i ? CornerPlace{true, far, bottom}
                                           : CornerPlace{far, true, bottom},
                          two = is_along_i ? CornerPlace{false, far, bottom}
                                           : CornerPlace{far, false, bottom};
        here = std::max(here, std::abs(grid.z(column, k, one) - grid.z(other, k, two)));
      }
    }
    any = std::max(any, here);
    if (grid.is_active[static_cast<std::size_t>(grid.cell(column, k))] == 0 ||
        grid.is_active[static_cast<std::size_t>(grid.cell(other, k))] == 0)
      continue;
    has_both = true;
    largest = std::max(largest, here);
  }
  return has_both ? largest : any;
}

/// Columns with an active cell, and those that inactive ones do not join to the edge of the grid.
std::vector<bool> inside(const CornerPointGrid& grid) {
  std::vector<bool> is_inside(static_cast<std::size_t>(grid.n_columns()), true);
  std::vector<std::array<int, 2>> queue;
  for (int i = 0; i < grid.size[0]; ++i) queue.insert(queue.end(), {{i, 0}, {i, grid.size[1] - 1}});
  for (int j = 0; j < grid.size[1]; ++j) queue.insert(queue.end(), {{0, j}, {grid.size[0] - 1, j}});
  while (!queue.empty()) {
    const auto [i, j] = queue.back();
    queue.pop_back();
    if (i < 0 || j < 0 || i >= grid.size[0] || j >= grid.size[1]) continue;
    const int column = grid.column(i, j);
    if (grid.has_active_cell(column) || !is_inside[static_cast<std::size_t>(column)]) continue;
    is_inside[static_cast<std::size_t>(column)] = false;
    queue.insert(queue.end(), {{i - 1, j}, {i + 1, j}, {i, j - 1}, {i, j + 1}});
  }
  return is_inside;
}

Columns stepping(const CornerPointGrid& grid, double least, double below) {
  Columns all;
  const std::vector<bool> is_inside = inside(grid);
  for (int j = 0; j < grid.size[1]; ++j) {
    for (int i = 0; i < grid.size[0]; ++i) {
      const int column = grid.column(i, j);
      const auto look_at = [&](int other, bool is_along_i) {
        if (!is_inside[static_cast<std::size_t>(column)] ||
            !is_inside[static_cast<std::size_t>(other)])
          return;
        const double step = step_between(grid, column, other, is_along_i);
        if (step >= least && step < below) all.insert({column, other});
      };
      if (i + 1 < grid.size[0]) look_at(grid.column(i + 1, j), true);
      if (j + 1 < grid.size[1]) look_at(grid.column(i, j + 1), false);
    }
  }
  return all;
}

Columns on_faults(const GridStructure& found) {
  Columns all;
  for (const Fault& fault : found.faults) {
    for (const FaultEdge& edge : fault.edges)
      all.insert({std::min(edge.left, edge.right), std::max(edge.left, edge.right)});
  }
  return all;
}

int n_left_out(const GridStructure& found, bool small) {
  int n = 0;
  for (const LeftOut& left : found.left_out) {
    if ((left.reason == LeftOutReason::small_offset) == small) n += left.n_edges;
  }
  return n;
}

/// Parts of the map between the faults found, by flooding.
std::vector<int> flooded(const CornerPointGrid& grid, const Columns& barriers) {
  std::vector<int> part(static_cast<std::size_t>(grid.n_columns()), -1);
  const std::vector<bool> is_inside = inside(grid);
  int n = 0;
  for (int begin = 0; begin < grid.n_columns(); ++begin) {
    if (part[static_cast<std::size_t>(begin)] >= 0 || !is_inside[static_cast<std::size_t>(begin)])
      continue;
    std::vector<int> queue = {begin};
    part[static_cast<std::size_t>(begin)] = n;
    while (!queue.empty()) {
      const int column = queue.back();
      queue.pop_back();
      const auto [i, j] = grid.place(column);
      for (const auto& [x, y] : {std::pair{i - 1, j}, {i + 1, j}, {i, j - 1}, {i, j + 1}}) {
        if (x < 0 || y < 0 || x >= grid.size[0] || y >= grid.size[1]) continue;
        const int other = grid.column(x, y);
        if (!is_inside[static_cast<std::size_t>(other)] ||
            part[static_cast<std::size_t>(other)] >= 0 ||
            barriers.contains({std::min(column, other), std::max(column, other)}))
          continue;
        part[static_cast<std::size_t>(other)] = n;
        queue.push_back(other);
      }
    }
    ++n;
  }
  return part;
}

/// The lines on which columns may step: of a fault that another ends at, beyond its tips as well.
double distance_from_made(const MadeGrid& model, std::size_t made, const Eigen::Vector2d& at) {
  const bool bounds_others =
      made == 0 && std::ranges::any_of(model.faults, [](const MadeFault& fault) {
        return fault.only_right_of == 0;
      });
  return bounds_others ? distance_from_line(model.faults[made], at)
                       : distance_from(model.faults[made], at);
}

/// How many of the middles of a fault's edges are near the line of a made one.
int n_near(const Fault& fault, const MadeGrid& model, std::size_t made, double reach) {
  int n = 0;
  for (std::size_t e = 0; e < fault.edges.size(); ++e) {
    const Eigen::Vector2d middle = (fault.pillars[e] + fault.pillars[e + 1]) / 2;
    n += distance_from_made(model, made, middle) <= reach ? 1 : 0;
  }
  return n;
}

TEST(RandomGrids, EveryStepIsAFaultOrLeftOutWithAReason) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const CornerPointGrid grid = made(RandomGrid(seed).grid());
    const StructureOptions options;
    const GridStructure found = recognise_structure(grid, options);
    const Columns steps = stepping(grid, options.least_offset, 1e9), faults = on_faults(found);
    const Columns small = stepping(grid, options.negligible_offset, options.least_offset);
    Columns steep, bridges;
    std::ranges::set_intersection(steps, faults, std::inserter(steep, steep.end()));
    std::ranges::set_intersection(small, faults, std::inserter(bridges, bridges.end()));
    EXPECT_EQ(steep.size() + bridges.size(), faults.size()) << seed;
    EXPECT_EQ(steps.size() - steep.size(), n_left_out(found, false)) << seed;
    EXPECT_EQ(small.size() - bridges.size(), n_left_out(found, true)) << seed;
    EXPECT_EQ(bridges.size(), found.n_bridged) << seed;
    EXPECT_LE(n_left_out(found, false), static_cast<int>(steps.size()) / 5) << seed;
  }
}

TEST(RandomGrids, FaultsSeparateWhatFloodingDoesNotReach) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const CornerPointGrid grid = made(RandomGrid(seed).grid());
    const GridStructure found = recognise_structure(grid, {});
    const std::vector<int> part = flooded(grid, on_faults(found));
    std::set<std::pair<int, int>> pairs;
    for (int cell = 0; cell < grid.n_cells(); ++cell) {
      const int compartment = found.compartment_of_cell[static_cast<std::size_t>(cell)];
      EXPECT_EQ(compartment >= 0, grid.is_active[static_cast<std::size_t>(cell)] != 0);
      if (compartment >= 0)
        pairs.insert({compartment, part[static_cast<std::size_t>(cell % grid.n_columns())]});
    }
    const auto n_parts = static_cast<std::size_t>(*std::ranges::max_element(part) + 1);
    EXPECT_EQ(pairs.size(), n_parts) << seed;  // one to one
    EXPECT_EQ(found.compartments.size(), n_parts) << seed;
  }
}

/// Each edge of a fault is within half a diagonal of a made line, most faults follow one line, and
/// then their traces do; most made faults have a fault of their own.
TEST(RandomGrids, TracesLieOnTheLinesThatFaultsWereMadeOn) {
  int n_made = 0, n_found = 0, n_traces = 0, n_pure = 0;
  for (unsigned seed = 0; seed < 50; ++seed) {
    const RandomGrid random(seed);
    const MadeGrid& model = random.grid();
    const GridStructure found = recognise_structure(made(model), {.reference_z = model.reference});
    const double half = 0.5 * std::hypot(model.dx, model.dy);
    std::set<std::size_t> has_own;
    for (const Fault& fault : found.faults) {
      n_traces += 1;
      EXPECT_LE(fault.largest_distance, 0.5 * fault.cell * (1 + 1e-9)) << seed;
      for (std::size_t e = 0; e < fault.edges.size(); ++e) {
        const Eigen::Vector2d middle = (fault.pillars[e] + fault.pillars[e + 1]) / 2;
        double least = 1e9;
        for (std::size_t m = 0; m < model.faults.size(); ++m)
          least = std::min(least, distance_from_made(model, m, middle));
        EXPECT_LE(least, half) << seed;
      }
      for (std::size_t m = 0; m < model.faults.size(); ++m) {
        const int n = n_near(fault, model, m, half), all = static_cast<int>(fault.edges.size());
        if (2 * n > all) has_own.insert(m);
        if (n < all) continue;
        n_pure += 1;
        for (const Eigen::Vector2d& point : fault.trace)  // ends reach half an edge further
          EXPECT_LE(distance_from_line(model.faults[m], point), 1.5 * half) << seed;
        break;
      }
    }
    n_made += static_cast<int>(model.faults.size());
    n_found += static_cast<int>(has_own.size());
  }
  std::cout << n_made << " made, " << n_found << " found; " << n_traces << " traces, " << n_pure
            << " along one line\n";
  EXPECT_GE(n_pure, n_traces * 85 / 100);
  EXPECT_GE(n_found, n_made * 80 / 100);
}

}  // namespace
}  // namespace faultsim::corner_point
