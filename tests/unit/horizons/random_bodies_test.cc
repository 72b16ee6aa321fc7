#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <iostream>

#include "tests/unit/horizons/bodies.h"

namespace faultsim::horizons {
namespace {

struct Tally {
  int n_meshed = 0;
  double smallest_sicn = 1;
};

/// Builds random bodies; each is cut with every facet found, or refused before it is meshed as the
/// fourth fault, which heads for the second, cuts that in depth.
Tally try_bodies(unsigned first, unsigned n, bool change_dips = false) {
  Tally tally;
  for (unsigned seed = first; seed < first + n; ++seed) {
    LayeredBody body = test::random_body(seed);
    if (change_dips) test::change_dips(body, seed);
    try {
      const BuiltBody built = build_body(body, "body");
      const Mesh mesh = cut(built.mesh, "body");
      ++tally.n_meshed;
      for (std::size_t f = 0; f < 4; ++f)
        EXPECT_EQ(mesh.faults[f].faces.size(), built.mesh.faults[f].facets.size()) << seed;
      tally.smallest_sicn = std::min(tally.smallest_sicn, built.smallest_sicn);
      std::cout << "seed " << seed << ": " << built.mesh.n_cells() << " cells, smallest SICN "
                << built.smallest_sicn << " at " << built.worst_place.transpose() << ", "
                << built.n_slivers << " below 0.1, " << built.n_extra_nodes << " extra nodes\n";
    } catch (const InputError& error) {
      std::cout << "seed " << seed << ": " << error.what() << '\n';
      EXPECT_THAT(std::string(error.what()), testing::HasSubstr("cut each other in depth, at x "));
    }
  }
  return tally;
}

TEST(RandomBodies, AreMeshedOrRefusedWithPlace) {
  const Tally tally = try_bodies(1, 8);
  EXPECT_GE(tally.n_meshed, 6) << "most";
  EXPECT_GE(tally.smallest_sicn, 0.05);
}

TEST(RandomBodies, WithDipsThatChangeAlongTracesAreMeshedOrRefusedWithPlace) {
  const Tally tally = try_bodies(1, 5, true);
  EXPECT_GE(tally.n_meshed, 3) << "most";
  EXPECT_GE(tally.smallest_sicn, 0.05);
}

TEST(RandomBodies, SlowAHundredWithDipsThatChange) {
  const Tally tally = try_bodies(1, 100, true);
  EXPECT_GE(tally.n_meshed, 75) << "most";
  EXPECT_GE(tally.smallest_sicn, 0.015) << "dips go down to 32 degrees here";
}

TEST(RandomBodies, SlowAHundred) {
  const Tally tally = try_bodies(1, 100);
  EXPECT_GE(tally.n_meshed, 75) << "most";
  EXPECT_GE(tally.smallest_sicn, 0.05);
}

TEST(RandomBodies, SlowOfAHundredThousandCells) {
  LayeredBody body = test::random_body(1);
  body.cells.at_faults = 80;
  const auto start = std::chrono::steady_clock::now();
  const BuiltBody built = build_body(body, "body");
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  std::cout << built.mesh.n_cells() << " cells in " << seconds.count() << " s\n";
  EXPECT_LT(seconds.count() * 1e5 / static_cast<double>(built.mesh.n_cells()), 30);
}

}  // namespace
}  // namespace faultsim::horizons
