#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <map>
#include <set>

#include "tests/unit/horizons/bodies.h"

namespace faultsim::horizons {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kTraceDepth = -2000;
constexpr std::size_t kFaults = 3, kHorizons = 3;
using FaultSides = std::array<bool, kFaults>;  ///< right of each.

/// A plane fault with a throw along it.
struct PlaneFault {
  Vector2d from, to;
  double dip;         ///< > 0.
  double towards;     ///< 1: dips to the right, −1: to the left.
  double right_down;  ///< m, where it is largest.
  bool starts_at_fault;

  Vector2d along() const { return (to - from).normalized(); }
  Vector2d right() const { return {along().y(), -along().x()}; }
  bool is_right(const Vector3d& at) const {
    const double gone = towards * (kTraceDepth - at.z()) / std::tan(dip);
    return (at.head<2>() - from).dot(right()) > gone;
  }
  double throw_at(const Vector2d& at) const {
    const double s = (at - from).dot(along()) / (to - from).norm();
    const double u = starts_at_fault ? s : 2 * s - 1;
    if (u >= 1 || u <= -1) return 0;
    return right_down * (1 - u * u) * (1 - u * u);
  }
  /// How far rock of one side has moved up.
  double up(const Vector2d& at, bool on_right) const {
    const double away = (on_right ? 1 : -1) * (at - from).dot(right());
    return (on_right ? -0.6 : 0.4) * throw_at(at) * std::exp(-away / 3000);
  }
};

/// A dome of three horizons, cut by two faults and a third that ends at the first: turned in the
/// map and with dips, throws and shapes of all kinds.
class SidedRock {
 public:
  explicit SidedRock(unsigned seed) : random_(seed) {
    const double turned = between(0, 6);
    const auto place = [&](double x, double y) {
      return Vector2d(x * std::cos(turned) - y * std::sin(turned),
                      x * std::sin(turned) + y * std::cos(turned));
    };
    const auto fault = [&](const Vector2d& from, const Vector2d& to, double most,
                           bool starts_at_fault) {
      return PlaneFault{from,
                        to,
                        between(60, 85) * test::kDegree,
                        between(-1, 1) < 0 ? -1. : 1.,
                        (between(-1, 1) < 0 ? -1 : 1) * most * between(0.5, 1),
                        starts_at_fault};
    };
    const double x2 = between(2000, 2400), y3 = between(-400, 400), end3 = between(-600, 600);
    faults_ = {fault(place(-500, -2000), place(-500, 2000), 94, false),
               fault(place(x2, -2200), place(x2 + between(-200, 200), 1800), 94, false),
               fault(place(-500, y3), place(1200, y3 + end3), 45, true)};
    amplitude_ = between(100, 250);
    middle_ = place(between(-500, 500), between(-500, 500));
    wide_ = between(2800, 3500);
  }

  double z(std::size_t horizon, const Vector2d& at, const FaultSides& right) const {
    const double r2 = (at - middle_).squaredNorm() / (wide_ * wide_);
    double z = -2080 - 110. * static_cast<double>(horizon) + amplitude_ * std::exp(-r2);
    for (std::size_t f = 0; f < 2; ++f) z += faults_[f].up(at, right[f]);
    // What the third moves ends at the first, and with it.
    const double part = faults_[0].throw_at(at) / faults_[0].right_down;
    return right[0] ? z + part * faults_[2].up(at, right[2]) : z;
  }
  FaultSides sides(const Vector3d& at) const {
    FaultSides right;
    for (std::size_t f = 0; f < kFaults; ++f) right[f] = faults_[f].is_right(at);
    return right;
  }

  LayeredBody body() {
    LayeredBody body;
    body.low = {-4500, -4500};
    body.high = {4500, 4500};
    body.base = -3500;
    body.trace_depth = kTraceDepth;
    body.cells = {80, 900, 0.25};
    for (std::size_t k = 0; k < kHorizons; ++k)
      body.horizons.push_back({"H" + std::to_string(k), points(k)});
    body.layers = {{0}, {1, true}, {2, true}, {3}};
    for (const PlaneFault& one : faults_) {
      LayeredFault fault;
      fault.name = "F" + std::to_string(body.faults.size());
      fault.trace = {one.from, one.to};
      if (one.starts_at_fault) fault.first_end = TraceEnd::at_fault;
      fault.profiles = {straight_profile((one.towards > 0 ? 1 : -1) / std::tan(one.dip))};
      fault.top = -1450;
      fault.bottom = -2800;
      body.faults.push_back(fault);
    }
    return body;
  }

 private:
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / 4294967296.0;
  }
  PointDepth points(std::size_t horizon) {
    PointDepth all;
    for (double x = -4500; x <= 4500; x += 128)
      for (double y = -4500; y <= 4500; y += 128)
        for (int sides = 0; sides < 8; ++sides) {
          const Vector2d at(x + between(-20, 20), y + between(-20, 20));
          const FaultSides right = {(sides & 1) != 0, (sides & 2) != 0, (sides & 4) != 0};
          const Vector3d point(at.x(), at.y(), z(horizon, at, right));
          if (this->sides(point) == right) all.points.push_back(point);
        }
    return all;
  }

  std::mt19937 random_;
  std::vector<PlaneFault> faults_;
  double amplitude_ = 0, wide_ = 0;
  Vector2d middle_;
};

struct SidedErrors {
  double at_faults = 0, elsewhere = 0;
  std::size_t n_at_faults = 0;
  Vector3d worst_place = Vector3d::Zero();  ///< of those at faults.
};

/// Of nodes between a layer and the next on one side of all faults. On faults depths of two sides
/// that nearly meet have been joined, which are not counted.
SidedErrors errors_in(const SidedRock& rock, const LayeredBody& body, const BuiltBody& built) {
  const UncutMesh& mesh = built.mesh;
  std::set<int> on_faults;
  for (const FacetGroup& fault : mesh.faults)
    for (const std::array<int, 4>& facet : fault.facets)
      on_faults.insert(facet.begin(), facet.begin() + 3);
  std::map<std::pair<int, FaultSides>, std::set<int>> layers;  // per node and sides
  for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell) {
    Vector3d middle = Vector3d::Zero();
    for (std::size_t v = 0; v < 4; ++v) middle += mesh.nodes[mesh.corners[4 * cell + v]] / 4;
    const FaultSides sides = rock.sides(middle);
    for (std::size_t v = 0; v < 4; ++v)
      layers[{mesh.corners[4 * cell + v], sides}].insert(built.layer[cell]);
  }
  SidedErrors errors;
  for (const auto& [key, found] : layers) {
    if (found.size() != 2) continue;
    const Vector3d& at = mesh.nodes[key.first];
    const auto horizon = static_cast<std::size_t>(*found.begin());
    const double error = std::abs(at.z() - rock.z(horizon, at.head<2>(), key.second));
    if (at.head<2>().cwiseAbs().maxCoeff() > 4300) continue;
    if (!on_faults.contains(key.first)) {
      errors.elsewhere = std::max(errors.elsewhere, error);
      continue;
    }
    int n_near = 0;
    for (int sides = 0; sides < 8; ++sides) {
      const FaultSides right = {(sides & 1) != 0, (sides & 2) != 0, (sides & 4) != 0};
      for (std::size_t k = 0; k < kHorizons; ++k)
        n_near += right != key.second &&
                  std::abs(rock.z(k, at.head<2>(), right) - at.z()) < 0.15 * body.cells.at_faults;
    }
    if (n_near > 0) continue;
    if (error > errors.at_faults) errors.worst_place = at;
    errors.at_faults = std::max(errors.at_faults, error);
    ++errors.n_at_faults;
  }
  return errors;
}

void try_sided_bodies(unsigned first, unsigned n, double most_off) {
  for (unsigned seed = first; seed < first + n; ++seed) {
    SidedRock rock(seed);
    const LayeredBody body = rock.body();
    try {
      const BuiltBody built = build_body(body, "body");
      const Mesh mesh = cut(built.mesh, "body");
      for (std::size_t f = 0; f < kFaults; ++f)
        EXPECT_EQ(mesh.faults[f].faces.size(), built.mesh.faults[f].facets.size()) << seed;
      EXPECT_GE(built.smallest_sicn, 0.05) << seed;
      const SidedErrors errors = errors_in(rock, body, built);
      EXPECT_LT(errors.at_faults, most_off) << seed;
      EXPECT_LT(errors.elsewhere, 1) << seed;
      EXPECT_GT(errors.n_at_faults, 30u) << seed;
      std::cout << "seed " << seed << ": " << built.mesh.n_cells() << " cells, smallest SICN "
                << built.smallest_sicn << " at " << built.worst_place.transpose() << "; at "
                << errors.n_at_faults << " nodes of faults depths off by " << errors.at_faults
                << " m, worst at " << errors.worst_place.transpose() << "; elsewhere by "
                << errors.elsewhere << " m\n";
    } catch (const InputError& error) {
      ADD_FAILURE() << "seed " << seed << ": " << error.what();
    }
  }
}

TEST(SidedBodies, HaveTheThrowsOfTheirPoints) { try_sided_bodies(1, 4, 0.4); }

TEST(SidedBodies, SlowThirty) { try_sided_bodies(1, 30, 0.8); }

}  // namespace
}  // namespace faultsim::horizons
