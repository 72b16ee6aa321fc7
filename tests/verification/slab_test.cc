// A stuck fault that displaces a depleting reservoir, in a slab of uneven tetrahedra three cells
// thick, against the closed form.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "simulator/condensation/condensation.h"
#include "tests/verification/closed_forms/elastic_solutions.h"
#include "tests/verification/depletion.h"
#include "tests/verification/grid_body.h"

namespace faultsim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kDip = 60 * std::numbers::pi / 180;
constexpr double kInner = 50,
                 kOuter = 150;        // m: the left block is −150 to 50, the right −50 to 150
constexpr double kEnd = 250;          // m, how far the fault goes up and down
constexpr double kFar = 9000;         // m, half of the body
constexpr double kDepletion = -20e6;  // Pa
const ElasticMaterial kRock{15e9, 0.15};

/// Even steps of about h between stops, then growing ones out to ± kFar.
std::vector<double> lines_through(const std::vector<double>& stops, double h) {
  std::vector<double> lines = {stops.front()};
  for (std::size_t k = 1; k < stops.size(); ++k) {
    const double length = stops[k] - stops[k - 1];
    const long n = std::max(1L, std::lround(length / h));
    for (long i = 1; i <= n; ++i)
      lines.push_back(stops[k - 1] + length * static_cast<double>(i) / static_cast<double>(n));
  }
  for (double step = h; lines.back() < kFar;) lines.push_back(lines.back() + (step *= 1.3));
  for (double step = h; lines.front() > -kFar;)
    lines.insert(lines.begin(), lines.front() - (step *= 1.3));
  lines.front() = -kFar;
  lines.back() = kFar;
  return lines;
}

/// Moves nodes by up to this, those of the fault, of the reservoir's surfaces and of the sides of
/// the slab within these.
void scatter(UncutMesh& body, double width, double by) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> move(-by, by);
  for (Vector3d& x : body.nodes) {
    const Vector3d moved(move(random), move(random), move(random));
    const double height = std::abs(x.z());
    if (std::abs(x.x()) > 2 * kEnd || height > kEnd - by) continue;
    const bool in_layer = std::abs(height - kInner) > by && std::abs(height - kOuter) > by;
    if (x.x() != 0) x.x() += moved.x();
    if (x.y() > 0 && x.y() < width) x.y() += moved.y();
    if (in_layer) x.z() += moved.z();
  }
}

/// The fault stands upright in the grid and is then tilted, the sides of the body are not.
BulkProblem slab(double h, double width, bool mean_dilatation) {
  const double step = h * std::sin(kDip);
  test::GridBody grid({lines_through({-h, 0, h}, h),
                       test::even_lines(0, width, static_cast<int>(width / h)),
                       lines_through({-kEnd, -kOuter, -kInner, kInner, kOuter, kEnd}, step)});
  grid.add_fault("fault", 0, 0, [](const Vector3d& x) { return std::abs(x.z()) < kEnd; });
  for (std::size_t cell = 0; cell < grid.body.n_cells(); ++cell) {
    const Vector3d x = grid.centre_of_cell(cell);
    const double z = x.x() < 0 ? x.z() : -x.z();
    grid.body.region[cell] = z > -kOuter && z < kInner ? 0 : -1;
    grid.body.region_fraction[cell] = grid.body.region[cell] == 0 ? 1 : 0;
  }
  scatter(grid.body, width, 0.15 * h);
  for (Vector3d& x : grid.body.nodes)
    x.x() += std::clamp(x.z(), -3 * kEnd, 3 * kEnd) / std::tan(kDip) * (1 - std::abs(x.x()) / kFar);
  BulkProblem problem;
  problem.mesh = cut(grid.body, "");
  problem.materials = {kRock};
  problem.mean_dilatation = mean_dilatation;
  test::deplete(problem);
  return problem;
}

Vector2d exact_traction(double z) {
  static const DisplacedReservoir kReservoir{
      shear_modulus(kRock), kRock.poisson_ratio, 1, 200, 100, kDip, kDepletion, kDepletion};
  const FaultStressChange change = displaced_fault_stress(kReservoir, z);
  return {change.normal, change.shear};
}

/// ∫ N_v t dA, normal and up dip, by node and by 2 n² points on each facet.
std::vector<Vector2d> exact_forces(const FaultSurface& fault) {
  constexpr int kPoints = 40;
  std::vector<Vector2d> forces(fault.nodes.size(), Vector2d::Zero());
  for (const FaultFace& face : fault.faces)
    for (int i = 0; i < kPoints; ++i)
      for (int j = 0; j < 2 * kPoints; ++j) {
        // The square folded onto the triangle; no point lies on a line through its corners.
        double s = (i + 0.5) / kPoints, t = (j + 0.5) / (2 * kPoints);
        if (s + t > 1) s = 1 - s, t = 1 - t;
        const std::array<double, 3> hat = {1 - s - t, s, t};
        double z = 0;
        for (std::size_t v = 0; v < 3; ++v)
          z += hat[v] * fault.points[static_cast<std::size_t>(face.points[v])].z();
        const Vector2d force = face.area / (2 * kPoints * kPoints) * exact_traction(z);
        for (std::size_t v = 0; v < 3; ++v)
          if (face.nodes[v] >= 0) forces[static_cast<std::size_t>(face.nodes[v])] += hat[v] * force;
      }
  return forces;
}

struct Errors {
  double rms = 0, largest = 0;  ///< of the largest change, away from corners.
};

Errors errors_of(double h, bool mean_dilatation) {
  const BulkProblem problem = slab(h, 120, mean_dilatation);
  SilentMonitor monitor;
  const FaultOperator op = CondensedBulk(problem, monitor).condense();
  const std::vector<Vector2d> forces = exact_forces(problem.mesh.faults[0]);
  Errors errors;
  double scale = 0;
  int n = 0;
  for (std::size_t k = 0; k < forces.size(); ++k) {
    const OperatorNode& node = op.geometry.nodes[k];
    const double z = std::abs(node.position.z());
    if (std::abs(z - kInner) < 13 || z > kOuter - 13) continue;
    // n looks to the right and down, dip leads down.
    const Vector2d traction(op.loads.traction(node.dof[0], 0), -op.loads.traction(node.dof[2], 0));
    const Vector2d exact = forces[k] / node.area, off = kDepletion * traction - exact;
    scale = std::max(scale, exact.cwiseAbs().maxCoeff());
    errors.rms += off.squaredNorm() / 2;
    errors.largest = std::max(errors.largest, off.cwiseAbs().maxCoeff());
    ++n;
  }
  return {std::sqrt(errors.rms / n) / scale, errors.largest / scale};
}

TEST(Slab, TractionsOfUnevenTetrahedraAreTheHatMeansOfTheClosedForm) {
  const Errors errors = errors_of(40, true);
  EXPECT_LT(errors.rms, 0.01);
  EXPECT_LT(errors.largest, 0.02);
  const Errors plain = errors_of(40, false);
  EXPECT_LT(plain.rms, 0.016);
  EXPECT_LT(plain.largest, 0.027);
}

/// The largest ones are next to corners, where tractions are infinite.
TEST(Slab, SlowFinerOnesAreCloser) {
  const Errors errors = errors_of(30, true);
  EXPECT_LT(errors.rms, 0.008);
  EXPECT_LT(errors.largest, 0.017);
}

}  // namespace
}  // namespace faultsim
