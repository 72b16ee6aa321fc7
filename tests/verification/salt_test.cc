// Salt that hardly changes its volume beside a depleting reservoir, in tetrahedra: tractions on a
// stuck fault through both, and whether the pressures of its cells oscillate.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "simulator/condensation/condensation.h"
#include "simulator/elasticity/element.h"
#include "tests/verification/depletion.h"
#include "tests/verification/grid_body.h"

namespace faultsim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kDip = 60 * std::numbers::pi / 180;
constexpr double kInner = 50,
                 kOuter = 150;        // m: the left block is −150 to 50, the right −50 to 150
constexpr double kTop = 250;          // m, of the salt, which lies on the right block
constexpr double kEnd = 300;          // m, how far the fault goes up and down
constexpr double kFar = 6000;         // m, half of the body
constexpr double kDepletion = -20e6;  // Pa
constexpr double kAway = 15;          // m, from corners and layers: where tractions count
const ElasticMaterial kRock{15e9, 0.15}, kSalt{15e9, 0.4999};

/// Even steps h to both sides as far as `to`, then growing ones.
std::vector<double> graded(double to, double h) {
  std::vector<double> up;
  for (int k = 1; k <= std::lround(to / h); ++k) up.push_back(k * h);
  for (double step = h; up.back() < kFar;) up.push_back(up.back() + (step *= 1.3));
  up.back() = kFar;
  std::vector<double> lines;
  for (auto x = up.rbegin(); x != up.rend(); ++x) lines.push_back(-*x);
  lines.push_back(0);
  lines.insert(lines.end(), up.begin(), up.end());
  return lines;
}

/// The fault stands upright in the grid and is then tilted, the sides of the body are not.
BulkProblem salt_problem(double h, bool mean_dilatation) {
  test::GridBody grid({graded(h, h), {0, h}, graded(kEnd, h)});
  grid.add_fault("fault", 0, 0, [](const Vector3d& x) { return std::abs(x.z()) < kEnd; });
  for (std::size_t cell = 0; cell < grid.body.n_cells(); ++cell) {
    const Vector3d x = grid.centre_of_cell(cell);
    const bool depletes =
        x.x() < 0 ? x.z() > -kOuter && x.z() < kInner : x.z() > -kInner && x.z() < kOuter;
    grid.body.region[cell] = depletes ? 0 : -1;
    grid.body.region_fraction[cell] = depletes ? 1 : 0;
    if (x.z() > kOuter && x.z() < kTop) grid.body.material[cell] = 1;
  }
  for (Vector3d& x : grid.body.nodes)
    x.x() += std::clamp(x.z(), -2 * kEnd, 2 * kEnd) / std::tan(kDip) * (1 - std::abs(x.x()) / kFar);
  BulkProblem problem;
  problem.mesh = cut(grid.body, "");
  problem.materials = {kRock, kSalt};
  problem.mean_dilatation = mean_dilatation;
  test::deplete(problem);
  return problem;
}

/// Of the nodes at one height: area and normal and shear force, per metre of y.
struct Band {
  double area = 0;
  Vector2d force = Vector2d::Zero();
};
using Bands = std::map<long, Band>;  // by height, in 1e-3 m

Bands bands_of(const FaultOperator& op, double h) {
  Bands bands;
  for (const OperatorNode& node : op.geometry.nodes) {
    Band& band = bands[std::lround(1e3 * node.position.z())];
    band.area += node.area / h;
    const Vector2d traction(op.loads.traction(node.dof[0], 0), op.loads.traction(node.dof[2], 0));
    band.force += kDepletion * node.area / h * traction;
  }
  return bands;
}

/// What a mesh of half the size of cells has on the hats of a mesh.
Vector2d coarser(const Bands& fine, long height, long step) {
  const auto at = [&](long place) { return fine.at(place).force; };
  return at(height) + (at(height - step) + at(height + step)) / 2;
}

/// Pressures of the cells of the salt near the fault, Pa: mean dilatation times bulk modulus.
struct Pressures {
  double scatter = 0;  ///< rms of those of the six cells of a hexahedron about their mean.
  double largest = 0;  ///< of the means.
};

double pressure_of(const Mesh& mesh, const Eigen::Matrix3Xd& u, std::size_t cell) {
  double dilatation = 0;
  with_element(mesh, static_cast<int>(cell), [&](const auto& element) {
    for (Eigen::Index a = 0; a < element.mean_gradient.rows(); ++a)
      dilatation +=
          element.mean_gradient.row(a).dot(u.col(mesh.cells[cell][static_cast<std::size_t>(a)]));
  });
  return -kSalt.youngs_modulus / 3 / (1 - 2 * kSalt.poisson_ratio) * dilatation;
}

Pressures pressures_of(CondensedBulk& bulk, const FaultOperator& op) {
  const Mesh& mesh = bulk.problem().mesh;
  const Eigen::Matrix3Xd u =
      bulk.displacement({kDepletion}, Eigen::VectorXd::Zero(op.geometry.n_dofs));
  Pressures found;
  int n = 0;
  for (std::size_t first = 0; first < mesh.cells.size(); first += 6) {
    const Vector3d& x = mesh.nodes[static_cast<std::size_t>(mesh.cells[first][0])];
    if (mesh.material[first] != 1 || std::abs(x.x() - x.z() / std::tan(kDip)) > kEnd) continue;
    if (x.z() < kOuter + kAway || x.z() > kTop - kAway) continue;
    std::array<double, 6> pressure{};
    for (std::size_t k = 0; k < 6; ++k) pressure[k] = pressure_of(mesh, u, first + k);
    const double mean = std::accumulate(pressure.begin(), pressure.end(), 0.) / 6;
    for (const double one : pressure) found.scatter += (one - mean) * (one - mean);
    n += 6;
    found.largest = std::max(found.largest, std::abs(mean));
  }
  found.scatter = std::sqrt(found.scatter / n);
  return found;
}

struct Study {
  double h;
  Bands bands;
  Pressures pressures;
};

Study study(double h, bool mean_dilatation) {
  SilentMonitor monitor;
  CondensedBulk bulk(salt_problem(h, mean_dilatation), monitor);
  const FaultOperator op = bulk.condense();
  return {h, bands_of(op, h), pressures_of(bulk, op)};
}

/// The largest difference of tractions away from ends and corners, of the largest of them.
double difference(const Study& study, const Study& finer) {
  double scale = 0, largest = 0;
  for (const auto& [height, band] : study.bands) {
    const double z = 1e-3 * static_cast<double>(height);
    const bool near =
        std::ranges::any_of(std::array{-kOuter, -kInner, kInner, kOuter, kTop},
                            [&](double corner) { return std::abs(z - corner) < kAway - 1e-6; });
    if (near || std::abs(z) > kTop) continue;
    const Vector2d exact = coarser(finer.bands, height, std::lround(1e3 * finer.h));
    scale = std::max(scale, exact.cwiseAbs().maxCoeff() / band.area);
    largest = std::max(largest, (band.force - exact).cwiseAbs().maxCoeff() / band.area);
  }
  return largest / scale;
}

TEST(Salt, TractionsConvergeWithBothKindsOfCells) {
  const Study finer = study(5, true), mean = study(10, true), plain = study(10, false);
  EXPECT_LT(difference(mean, finer), 0.0011);
  EXPECT_LT(difference(plain, finer), 0.012);
  // Pressures of single cells are of little worth; those of neighbours together agree.
  EXPECT_LT(mean.pressures.scatter, 0.01 * std::abs(kDepletion));
  EXPECT_LT(plain.pressures.scatter, 0.025 * std::abs(kDepletion));
  EXPECT_LT(finer.pressures.scatter, mean.pressures.scatter);
  EXPECT_NEAR(mean.pressures.largest, finer.pressures.largest, 0.05 * finer.pressures.largest);
  EXPECT_NEAR(plain.pressures.largest, finer.pressures.largest, 0.1 * finer.pressures.largest);
}

TEST(Salt, SlowTractionsOfFineCellsConverge) {
  const Study finer = study(2.5, true), mean = study(5, true), plain = study(5, false);
  EXPECT_LT(difference(mean, finer), 0.0004);
  EXPECT_LT(difference(plain, finer), 0.0035);
  EXPECT_LT(finer.pressures.scatter, 1.05 * mean.pressures.scatter);
  EXPECT_NEAR(mean.pressures.largest, finer.pressures.largest, 0.05 * finer.pressures.largest);
}

}  // namespace
}  // namespace faultsim
