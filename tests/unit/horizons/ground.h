#pragma once

#include <vector>

#include "simulator/horizons/sided_horizon.h"
#include "tests/unit/horizons/bodies.h"

namespace faultsim::horizons::test {

/// What stands before horizons of points are looked at.
struct Ground {
  LayeredBody body;
  MapMesh map;
  std::vector<MapSide> sides;
  Pillars pillars;
  MapLocator locator;

  explicit Ground(const LayeredBody& of)
      : body(of),
        map(meshed(of)),
        sides(sides_of(map.triangles)),
        pillars(body, map),
        locator(body, map, sides, pillars) {}
  Ground(const Ground&) = delete;
  Ground& operator=(const Ground&) = delete;

  /// Depths of the first horizon of the body.
  SidedHorizon horizon(const PointSurface& surface, std::vector<Problem>& problems) const {
    return {{body, map, sides, pillars, locator}, 0, surface, problems};
  }
};

/// A dome that a fault along y at x = 0 (at the depth of traces) cuts and that dips to larger x.
/// Its throw is `most` in the middle, nothing at its tips and dies away from it.
struct FaultedDome {
  double half = 2000;
  double dip = 65 * kDegree;
  double trace_depth = -2000;
  double most = 90;

  double throw_at(double y) const {
    const double u = y / half;
    return std::abs(u) >= 1 ? 0 : most * (1 - u * u) * (1 - u * u);
  }
  double fault_x(double z) const { return (trace_depth - z) / std::tan(dip); }
  /// Of one side's rock at x, y.
  double z(double x, double y, bool is_right) const {
    const double r2 = (x - 300) * (x - 300) / (3000. * 3000.) + y * y / (2600. * 2600.);
    const double dome = -2150 + 250 * std::exp(-r2);
    const double away = (is_right ? 1 : -1) * (x - fault_x(dome));
    return dome + (is_right ? -0.6 : 0.4) * throw_at(y) * std::exp(-away / 2000);
  }
  LayeredBody body() const {
    LayeredBody body = reservoir_body();
    body.low = {-3000, -3000};
    body.high = {3000, 3000};
    body.cells.at_faults = 50;
    LayeredFault fault = dipping_fault();
    fault.profiles = {straight_profile(1 / std::tan(dip))};
    fault.trace = {{0, -half}, {0, half}};
    fault.first_end = fault.last_end = TraceEnd::in_rock;
    body.faults = {fault};
    return body;
  }
  /// Points at about the places of a grid, where their rock is.
  PointDepth points(double spacing, double noise) const {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> jitter(-0.2, 0.2);
    std::normal_distribution<double> error(0, 1);
    PointDepth all;
    for (double gx = -3000; gx <= 3000; gx += spacing)
      for (double gy = -3000; gy <= 3000; gy += spacing)
        for (const bool is_right : {false, true}) {
          const double x = gx + spacing * jitter(random), y = gy + spacing * jitter(random);
          const double depth = z(x, y, is_right);
          if ((x > fault_x(depth)) != is_right) continue;
          all.points.emplace_back(x, y, depth + noise * error(random));
        }
    return all;
  }
  /// Adds points a metre beside the fault.
  void add_chain(double spacing, PointDepth& points) const {
    for (double y = -half + 20; y < half; y += spacing)
      for (const bool is_right : {false, true}) {
        double x = 0;
        for (int k = 0; k < 50; ++k) x = fault_x(z(x, y, is_right)) + (is_right ? 1 : -1);
        points.points.emplace_back(x, y, z(x, y, is_right));
      }
  }
};

}  // namespace faultsim::horizons::test
