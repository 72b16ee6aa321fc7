#include "simulator/horizons/throws.h"

#include <gtest/gtest.h>

#include <cmath>

#include "simulator/horizons/map_operator.h"
#include "tests/unit/horizons/bodies.h"

namespace faultsim::horizons {
namespace {

using test::dipping_fault;
using test::reservoir_body;

TEST(Throws, FadeWithTheirReach) {
  LayeredBody body = reservoir_body();
  body.faults = {dipping_fault()};
  body.faults[0].moved = FaultThrow{100, 0.25, 800};
  std::vector<Problem> problems;
  const MapMesh map = mesh_map(body, meeting_lines(body, problems), problems);
  ASSERT_TRUE(problems.empty());
  const CutMap cut = cut_map(map);
  const Eigen::MatrixXd up = throw_fields(body, map, cut);
  for (std::size_t t = 0; t < cut.places.size(); ++t) {
    double middle = 0;
    for (const int v : map.triangles[t]) middle += map.vertices[v].x() / 3;
    for (std::size_t v = 0; v < 3; ++v) {
      // u − reach² u'' = 0 between the fault and the side of the box, where u' = 0.
      const double away = std::abs(map.vertices[map.triangles[t][v]].x());
      const double part = std::cosh((3000 - away) / 800) / std::cosh(3000. / 800);
      EXPECT_NEAR(up(cut.places[t][v], 0), part * (middle > 0 ? -75 : 25), 2) << "at x " << away;
    }
  }
}

/// Squares of powers of two have pivots that are nothing, not nearly nothing.
TEST(Throws, APartThatNothingHoldsStaysAsItIs) {
  const std::vector<Eigen::Vector2d> corners = {{0, 0}, {1, 0}, {1, 1}, {0, 1},
                                                {2, 0}, {3, 0}, {3, 1}, {2, 1}};
  const Triangles triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  const MapOperator op = map_operator(corners, triangles, triangles, corners.size());
  std::vector<bool> fixed(corners.size(), false);
  fixed[1] = true;
  Eigen::VectorXd values = Eigen::VectorXd::Zero(8);
  values[1] = 3;
  const Eigen::VectorXd u = fill_between(op, Eigen::VectorXd::Zero(8), fixed, values);
  EXPECT_NEAR((u.head(4).array() - 3).abs().maxCoeff(), 0, 1e-14);
  EXPECT_EQ(u.tail(4).cwiseAbs().maxCoeff(), 0);
}

TEST(Throws, FallToNothingAtEndsInDepth) {
  LayeredFault fault = dipping_fault();
  fault.moved = FaultThrow{100};
  EXPECT_EQ(throw_in_depth(fault, -5000), 1);
  fault.top = -1000;
  fault.bottom = -3000;
  EXPECT_EQ(throw_in_depth(fault, -2000), 1);
  EXPECT_NEAR(throw_in_depth(fault, -1050), 0.25, 1e-12) << "over 2 |throw|";
  EXPECT_NEAR(throw_in_depth(fault, -2900), 0.5, 1e-12);
  EXPECT_EQ(throw_in_depth(fault, -900), 0);
}

}  // namespace
}  // namespace faultsim::horizons
