// V6 in 3D: a penny-shaped shear crack in an infinite body, in several orientations.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulator/common/errors.h"
#include "simulator/common/units.h"
#include "tests/verification/closed_forms/elastic_solutions.h"
#include "tests/verification/closed_forms/verify_cases.h"

namespace faultsim {
namespace {

const char kPenny[] = "v6_penny_crack.json";
constexpr double kRadius = 100;           // m, of the scene
constexpr double kFarNormalStress = -20;  // MPa on every plane: the crack stays closed
constexpr double kStressDrop = 5;         // MPa
constexpr double kHalfSize = 600;         // m, of the body: 6 a

/// How the crack lies and which way it is sheared, degrees.
struct Orientation {
  double strike;
  double dip_from_vertical;
  double rake;  ///< of the shear traction, from down dip towards along strike
};

struct CrackFrame {
  Eigen::Vector3d normal, shear;  ///< unit; the traction on the plane is −20 n + 5 m MPa
  Eigen::Vector3d half_extent;    ///< of the circle along x, y, z, m
};

CrackFrame frame_of(const Orientation& orientation) {
  const double s = orientation.strike * kDegree, b = orientation.dip_from_vertical * kDegree;
  const double rake = orientation.rake * kDegree;
  const Eigen::Vector3d along(std::sin(s), std::cos(s), 0);
  const Eigen::Vector3d down(std::sin(b) * std::cos(s), -std::sin(b) * std::sin(s), -std::cos(b));
  return {along.cross(down), std::cos(rake) * down + std::sin(rake) * along,
          kRadius * (along.array().square() + down.array().square()).sqrt()};
}

/// The scene turned to an orientation, with so many cells along the crack's radius on the grid.
Settings crack_settings(const Orientation& orientation, int cells_per_radius, double half_size) {
  const CrackFrame frame = frame_of(orientation);
  const Eigen::Matrix3d stress = kFarNormalStress * Eigen::Matrix3d::Identity() +
                                 kStressDrop * (frame.normal * frame.shear.transpose() +
                                                frame.shear * frame.normal.transpose());
  std::string rows;
  for (Eigen::Index i = 0; i < 3; ++i) {
    rows += concat(i > 0 ? "," : "", "[\"", stress(i, 0), " MPa\",\"", stress(i, 1), " MPa\",\"",
                   stress(i, 2), " MPa\"]");
  }
  const auto corner = [](double x) {
    return concat("[\"", x, " m\",\"", x, " m\",\"", x, " m\"]");
  };
  return {{"/geometry/boundary/0/stress", "[" + rows + "]"},
          {"/geometry/from", corner(-half_size)},
          {"/geometry/to", corner(half_size)},
          {"/faults/0/strike", concat(orientation.strike, " deg")},
          {"/faults/0/dip_from_vertical", concat(orientation.dip_from_vertical, " deg")},
          {"/mesh/strike", concat(frame.half_extent.y() / cells_per_radius, " m")},
          {"/mesh/dip", concat(frame.half_extent.z() / cells_per_radius, " m")},
          {"/mesh/normal", concat(kRadius / cells_per_radius, " m")}};
}

struct PennyFigures {
  int cells_per_radius = 0;
  double centre = 0;      ///< m, slip at the centre along the shear traction
  double across = 0;      ///< m, the same across it
  double moment = 0;      ///< N m
  double area_share = 0;  ///< area of the split nodes / πa²
};

PennyFigures penny_figures(const SceneRun& run, const Orientation& orientation,
                           int cells_per_radius) {
  PennyFigures figures;
  figures.cells_per_radius = cells_per_radius;
  const CrackFrame frame = frame_of(orientation);
  bool found = false;
  for (std::size_t k = 0; k < run.geometry().nodes.size(); ++k) {
    const OperatorNode& node = run.geometry().nodes[k];
    figures.area_share += node.area / (std::numbers::pi * kRadius * kRadius);
    if (node.position.norm() > 1e-6 * kRadius) continue;
    const auto jump = run.fields.back().jump.col(static_cast<Eigen::Index>(k));
    // The plus side slips along the shear traction that acts on the minus side's normal n.
    const double sign = node.normal.dot(frame.normal) > 0 ? 1 : -1;
    const Eigen::Vector3d slip = sign * (jump[1] * node.strike + jump[2] * node.dip);
    figures.centre = slip.dot(frame.shear);
    figures.across = (slip - figures.centre * frame.shear).norm();
    found = true;
  }
  FAULTSIM_DEMAND(found, "no node at the crack's centre");
  figures.moment = run.result.steps.back().faults.front().moment;
  return figures;
}

/// The value at no cell size of a straight line through lengths, one per mesh: Richardson
/// extrapolation of first order with more meshes than two. The nodes strictly inside a circle cover
/// a jagged area A, so that a mesh's crack is as if of radius a √(A/πa²); lengths of all meshes are
/// brought to the circle's.
template <typename Length>
double extrapolated(const std::vector<PennyFigures>& meshes, const Length& length) {
  const auto n = static_cast<Eigen::Index>(meshes.size());
  Eigen::MatrixXd columns(n, 2);
  Eigen::VectorXd values(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const PennyFigures& mesh = meshes[static_cast<std::size_t>(i)];
    columns.row(i) << 1, 1.0 / mesh.cells_per_radius;
    values[i] = length(mesh) / std::sqrt(mesh.area_share);
  }
  return columns.colPivHouseholderQr().solve(values)[0];
}

PennyFigures run_penny(SceneRunner& runner, const Orientation& orientation, int cells_per_radius) {
  const SceneRun run = runner.run(kPenny, crack_settings(orientation, cells_per_radius, kHalfSize));
  return penny_figures(run, orientation, cells_per_radius);
}

/// The closed form for the scene's rock.
struct PennyExact {
  double centre;  ///< m
  double moment;  ///< N m
};
PennyExact exact_penny(const Material& rock) {
  const double modulus = rock.youngs_modulus / (2 * (1 + rock.poisson_ratio));
  const double drop = kStressDrop * 1e6;
  return {penny_crack_slip(modulus, rock.poisson_ratio, drop, kRadius, 0),
          penny_crack_moment(rock.poisson_ratio, drop, kRadius)};
}

void study_penny(SceneRunner& runner, const Orientation& orientation,
                 const std::vector<int>& cells_per_radius, VerifyReport& report) {
  std::vector<PennyFigures> meshes;
  Material rock;
  double across = 0;
  for (const int cells : cells_per_radius) {
    const SceneRun run = runner.run(kPenny, crack_settings(orientation, cells, kHalfSize));
    meshes.push_back(penny_figures(run, orientation, cells));
    rock = run.scene.materials.front();
    across = std::max(across, meshes.back().across);
  }
  const PennyExact exact = exact_penny(rock);
  for (const PennyFigures& mesh : meshes) {
    const std::string place = concat(", ", mesh.cells_per_radius, " cells per radius");
    const bool finest = &mesh == &meshes.back();
    report.compare("slip at the centre" + place, "m", exact.centre, mesh.centre,
                   finest ? 0.02 : 0.04);
    report.compare("M0" + place, "N m", exact.moment, mesh.moment, 0.08);
  }
  const auto centre = [](const PennyFigures& mesh) { return mesh.centre; };
  const auto root = [](const PennyFigures& mesh) { return std::cbrt(mesh.moment); };
  report.compare("slip at the centre, extrapolated", "m", exact.centre,
                 extrapolated(meshes, centre), 0.02);
  report.compare("M0, extrapolated", "N m", exact.moment, std::pow(extrapolated(meshes, root), 3),
                 0.02);
  report.bound("slip at the centre across the load, worst mesh", "of that along it",
               across / exact.centre, 0.001);
}

VerifyCase penny_case(const std::string& name, const std::string& title,
                      const Orientation& orientation, bool fine) {
  return {name, title, {kPenny}, fine, [=](SceneRunner& runner, VerifyReport& report) {
            study_penny(runner, orientation,
                        fine ? std::vector<int>{6, 7, 8, 9, 10, 12} : std::vector<int>{4, 5, 6, 8},
                        report);
          }};
}

/// The same crack seen in a mirror, and with the ends of its strike exchanged: other nodes, other
/// cells, other far stresses, the same numbers.
VerifyCase mirrored_case() {
  return {"V6-penny-mirrored",
          "penny-shaped crack: mirrored and reversed scenes give the same figures",
          {kPenny},
          false,
          [](SceneRunner& runner, VerifyReport& report) {
            const int cells = 5;
            const PennyFigures given = run_penny(runner, {30, -20, 40}, cells);
            const auto same = [&](const std::string& what, const Orientation& orientation) {
              const PennyFigures other = run_penny(runner, orientation, cells);
              report.compare(what + ": slip at the centre", "m", given.centre, other.centre, 1e-9);
              report.compare(what + ": M0", "N m", given.moment, other.moment, 1e-9);
              report.compare(what + ": area of the split nodes", "of πa²", given.area_share,
                             other.area_share, 1e-9);
            };
            same("in the mirror x → −x", {-30, 20, 40});
            same("in the mirror y → −y", {-30, -20, -40});
            same("strike + 180°, the same plane", {210, 20, -40});
            same("sheared the other way", {30, -20, 220});
          }};
}

}  // namespace

std::vector<VerifyCase> penny_cases() {
  return {
      penny_case("V6-penny", "penny-shaped shear crack, vertical, coarse cells", {0, 0, 0}, false),
      mirrored_case(),
      penny_case("V6-penny-vertical", "penny-shaped shear crack, vertical", {0, 0, 0}, true),
      penny_case("V6-penny-dip30", "penny-shaped shear crack 30° from the vertical", {0, 30, 0},
                 true),
      penny_case("V6-penny-dip45", "penny-shaped shear crack 45° from the vertical", {0, 45, 0},
                 true),
      penny_case("V6-penny-oblique",
                 "penny-shaped shear crack, strike 30°, dip −20°, sheared 40° off its dip",
                 {30, -20, 40}, true)};
}

}  // namespace faultsim
