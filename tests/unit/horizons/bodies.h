#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/horizons/build_body.h"
#include "simulator/horizons/map_mesh.h"

/// Layered bodies to build in tests.
namespace faultsim::horizons::test {

constexpr double kDegree = std::numbers::pi / 180;

/// The map of a body without problems.
inline MapMesh meshed(const LayeredBody& body) {
  std::vector<Problem> problems;
  const MapLines lines = meeting_lines(body, problems);
  MapMesh map = mesh_map(body, lines, problems);
  for (const Problem& one : problems) ADD_FAILURE() << one.pointer << ": " << one.what;
  return map;
}

/// A box of 6 by 4 by 3 km with a reservoir of 200 m below 1,900 m, and no fault.
inline LayeredBody reservoir_body() {
  LayeredBody body;
  body.low = {-3000, -2000};
  body.high = {3000, 2000};
  body.top = 0;
  body.base = -4000;
  body.trace_depth = -2000;
  body.horizons = {{"top", ConstantDepth{-1900}}, {"bottom", ConstantDepth{-2100}}};
  body.layers = {{0}, {1, true}, {2}};
  body.cells = {200, 800, 0.3};
  return body;
}

/// A plane that dips by so many degrees from the horizontal to the right of its trace; < 0: to the
/// left.
inline std::vector<DipProfile> dipping(double degrees) {
  return {straight_profile(1 / std::tan(degrees * kDegree))};
}

/// Across the box along y at x = 0, dipping by 60 degrees to larger x.
inline LayeredFault dipping_fault() {
  LayeredFault fault;
  fault.name = "F";
  fault.trace = {{0, -2000}, {0, 2000}};
  fault.first_end = fault.last_end = TraceEnd::at_edge;
  fault.profiles = dipping(60);
  return fault;
}

/// A trace that bows to the right by `bow`.
inline std::vector<Eigen::Vector2d> bowed(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                          double bow) {
  const Eigen::Vector2d along = (to - from).normalized(), right(along.y(), -along.x());
  std::vector<Eigen::Vector2d> trace;
  constexpr int kPoints = 40;
  for (int k = 0; k <= kPoints; ++k) {
    const double u = static_cast<double>(k) / kPoints;
    trace.emplace_back(from + u * (to - from) + bow * std::sin(std::numbers::pi * u) * right);
  }
  return trace;
}

/// A listric profile to the right from `upper` at z = -1950 to `lower` at z = -3100 m (dips).
inline DipProfile listric(double upper, double lower) {
  DipProfile profile = {{-1950, 0}};
  constexpr int kPieces = 12;
  for (int k = 0; k < kPieces; ++k) {
    const double dip = upper + (lower - upper) * (k + 0.5) / kPieces, down = 1150.0 / kPieces;
    profile.push_back({profile.back().z - down, profile.back().shift + down / std::tan(dip)});
  }
  return profile;
}

/// Three listric faults that end in the rock, a fourth that ends at the first (T), four wavy
/// horizons; dips 40 to 85 degrees, throws to 220 m either way.
inline LayeredBody random_body(unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  LayeredBody body;
  body.low = {-6000, -6000};
  body.high = {6000, 6000};
  body.base = -5000;
  body.trace_depth = -2500;
  body.cells = {150, 1000, 0.25};
  const std::vector<double> depths = {-1800, -2400, -2600, -3300};
  for (std::size_t k = 0; k < depths.size(); ++k) {
    GridDepth grid{{-6000, -6000}, {500, 500}, 25, 25, {}};
    const double phase = between(0, 6);
    for (int j = 0; j < 25; ++j)
      for (int i = 0; i < 25; ++i)
        grid.z.push_back(depths[k] + 40 * std::sin(i / 2.2 + phase) * std::cos(j / 2.9) + 4 * i);
    body.horizons.push_back({"H" + std::to_string(k), grid});
  }
  body.layers = {{0}, {1}, {2, true}, {3}, {4}};
  const auto near = [&](double x, double y) {
    return Eigen::Vector2d(x + between(-350, 350), y + between(-350, 350));
  };
  const auto fault = [&](const std::string& name, const std::vector<Eigen::Vector2d>& trace) {
    LayeredFault one;
    one.name = name;
    one.trace = trace;
    const int side = between(0, 1) < 0.5 ? -1 : 1;
    const double dip = between(40, 85);
    one.profiles = {listric(dip * kDegree, std::max(40.0, dip - between(0, 22)) * kDegree)};
    for (DipPoint& point : one.profiles[0]) point.shift *= side;
    one.top = -1950;
    one.bottom = -3100;
    one.moved = FaultThrow{side * between(-220, 220), 0.5, 900};
    return one;
  };
  const auto trace = [&](double x0, double y0, double x1, double y1) {
    const Eigen::Vector2d from = near(x0, y0), to = near(x1, y1);
    return bowed(from, to, between(-350, 350));
  };
  body.faults.push_back(fault("F1", trace(-1500, -3500, -900, 3500)));
  body.faults.push_back(fault("F2", trace(1800, -3000, 2600, 3200)));
  body.faults.push_back(fault("F3", trace(-3600, -1500, -3000, 2500)));
  const std::vector<Eigen::Vector2d> first = body.faults[0].trace;
  const auto at = static_cast<std::size_t>(between(12, 28));
  body.faults.push_back(fault("F4", bowed(first[at], {1300, 900}, 80)));
  body.faults.back().first_end = TraceEnd::at_fault;
  return body;
}

/// Lets dips change along each trace: shifts by up to a third less or more at its ends.
inline void change_dips(LayeredBody& body, unsigned seed) {
  std::mt19937 random(seed);
  for (LayeredFault& fault : body.faults) {
    const auto change = [&] {
      return static_cast<double>(random()) / 4294967296.0 * 2 / 3 - 1. / 3;
    };
    const double first = change(), last = change();
    const DipProfile profile = fault.profiles[0];
    const auto n = static_cast<double>(fault.trace.size() - 1);
    fault.profiles.clear();
    for (std::size_t k = 0; k < fault.trace.size(); ++k) {
      fault.profiles.push_back(profile);
      const double u = static_cast<double>(k) / n, factor = 1 + (1 - u) * first + u * last;
      for (DipPoint& point : fault.profiles.back()) point.shift *= factor;
    }
  }
}

/// What building the body says is wrong, or "".
inline std::string refusal_of(const LayeredBody& body) {
  try {
    build_body(body, "body");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace faultsim::horizons::test
