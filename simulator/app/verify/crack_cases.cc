// V6: cracks in an infinite body: inclined with friction (plane strain), penny-shaped (3D).
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "simulator/app/verify/elastic_solutions.h"
#include "simulator/app/verify/verify_cases.h"
#include "simulator/common/errors.h"

namespace faultsim {
namespace {

const char kCrack[] = "v6_frictional_crack.json";
const char kPenny[] = "v6_penny_crack.json";

double shear_modulus_of(const Material& rock) {
  return rock.youngs_modulus / (2 * (1 + rock.poisson_ratio));
}

double slip_at(const SceneRun& run, std::size_t node) {
  return run.fields.back().jump.col(static_cast<Eigen::Index>(node)).tail<2>().norm();
}

/// Far stress of the scene on the crack's plane x = 0.
struct FarStress {
  double normal, shear;  ///< Pa
};
FarStress far_stress(const Scene& scene) {
  const std::array<double, 9>& stress = scene.box.boundary.front().stress;
  return {stress[0], std::hypot(stress[1], stress[2])};
}

struct CrackErrors {
  double l2 = 0;      ///< √(Σ error² / Σ exact²) over |s| < 0.9 b
  double normal = 0;  ///< largest |t_N − exact| / |exact|
  double centre = 0;  ///< m
};

CrackErrors crack_errors(const SceneRun& run) {
  const Material& rock = run.scene.materials.front();
  const double half_length = run.scene.box.patches.front().width / 2;
  const FarStress far = far_stress(run.scene);
  const double mu = std::tan(run.scene.faults.front().friction.static_friction_angle);
  // Turned back: uniaxial compression σ at angle ψ to the crack.
  const double load = -(far.normal + far.shear * far.shear / far.normal);
  const double angle = std::atan(-far.normal / far.shear);
  CrackErrors errors;
  double difference = 0, norm = 0;
  for (std::size_t k = 0; k < run.geometry().nodes.size(); ++k) {
    const double s = run.geometry().nodes[k].position.z();
    if (std::abs(s) < 1e-9 * half_length) errors.centre = slip_at(run, k);
    if (std::abs(s) >= 0.9 * half_length) continue;
    const double exact = frictional_crack_slip(rock.youngs_modulus, rock.poisson_ratio, load, angle,
                                               mu, half_length, s);
    difference += std::pow(slip_at(run, k) - exact, 2);
    norm += exact * exact;
    const double normal = run.fields.back().traction(0, static_cast<Eigen::Index>(k));
    errors.normal = std::max(errors.normal, std::abs(normal / far.normal - 1));
  }
  FAULTSIM_DEMAND(norm > 0, "no node of the crack is compared");
  errors.l2 = std::sqrt(difference / norm);
  return errors;
}

VerifyCase crack_case() {
  return {"V6-crack",
          "inclined crack with friction, uniaxial compression",
          {kCrack},
          false,
          [](SceneRunner& runner, VerifyReport& report) {
            const auto run = [&](const char* cell) {
              return runner.run(kCrack, {{"/mesh/dip", cell}, {"/mesh/normal", cell}});
            };
            const SceneRun fine = run("0.0125 m");
            const CrackErrors errors = crack_errors(fine);
            const Material& rock = fine.scene.materials.front();
            const FarStress far = far_stress(fine.scene);
            const double mu = std::tan(fine.scene.faults.front().friction.static_friction_angle);
            const double exact = 4 * (1 - rock.poisson_ratio * rock.poisson_ratio) /
                                 rock.youngs_modulus * (far.shear + mu * far.normal) *
                                 fine.scene.box.patches.front().width / 2;
            report.compare("slip at the centre, 160 cells", "mm", exact * 1e3, errors.centre * 1e3,
                           0.01);
            report.bound("t_N, worst node with |s| < 0.9", "relative", errors.normal, 0.01);
            report.bound("L2 error of slip, 160 cells", "relative", errors.l2, 0.01);
            const CrackErrors middle = crack_errors(run("0.025 m")),
                              coarse = crack_errors(run("0.05 m"));
            report.bound("L2 error of slip, 80 cells", "relative", middle.l2, 0.03);
            report.bound("L2 error of slip, 40 cells", "relative", coarse.l2, 0.06);
            report.holds("error falls with cell size",
                         coarse.l2 > middle.l2 && middle.l2 > errors.l2);
          }};
}

struct PennyFigures {
  double cell = 0;        ///< m
  double centre = 0;      ///< m
  double moment = 0;      ///< N m
  double area_share = 0;  ///< area of the split nodes / πa²
};

PennyFigures penny_figures(const SceneRun& run, double cell) {
  PennyFigures figures;
  figures.cell = cell;
  const double radius = run.scene.box.patches.front().width / 2;
  for (std::size_t k = 0; k < run.geometry().nodes.size(); ++k) {
    const OperatorNode& node = run.geometry().nodes[k];
    if (node.position.norm() < 1e-6 * radius) figures.centre = slip_at(run, k);
    figures.area_share += node.area / (std::numbers::pi * radius * radius);
  }
  figures.moment = run.result.steps.back().faults.front().moment;
  return figures;
}

/// The moment of cells of no size. The nodes strictly inside a circle cover a jagged area A; as M0
/// ∝ a³, the figures of all meshes are brought to the circle's area, and ∛M0 ∝ a is then linear in
/// the cell size.
double extrapolated_moment(const std::vector<PennyFigures>& meshes) {
  const auto n = static_cast<Eigen::Index>(meshes.size());
  Eigen::MatrixXd columns(n, 2);
  Eigen::VectorXd root(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const PennyFigures& mesh = meshes[static_cast<std::size_t>(i)];
    columns.row(i) << 1, mesh.cell;
    root[i] = std::cbrt(mesh.moment) / std::sqrt(mesh.area_share);
  }
  const Eigen::VectorXd fit = columns.colPivHouseholderQr().solve(root);
  return std::pow(fit[0], 3);
}

void study_penny(SceneRunner& runner, const std::vector<int>& cells_per_radius,
                 VerifyReport& report) {
  std::vector<PennyFigures> meshes;
  Scene scene;
  for (const int cells : cells_per_radius) {
    const double size = 100.0 / cells;
    const std::string cell = concat(size, " m");
    const SceneRun run =
        runner.run(kPenny, {{"/mesh/strike", cell}, {"/mesh/dip", cell}, {"/mesh/normal", cell}});
    meshes.push_back(penny_figures(run, size));
    scene = run.scene;
  }
  const Material& rock = scene.materials.front();
  const double drop = far_stress(scene).shear, radius = scene.box.patches.front().width / 2;
  const double slip = penny_crack_slip(shear_modulus_of(rock), rock.poisson_ratio, drop, radius, 0);
  const double moment = penny_crack_moment(rock.poisson_ratio, drop, radius);
  for (const PennyFigures& mesh : meshes) {
    const std::string place = ", " + short_number(mesh.cell) + " m cells";
    report.compare("slip at the centre" + place, "m", slip, mesh.centre,
                   mesh.cell <= 12.5 ? 0.02 : 0.04);
    report.compare("M0" + place, "N m", moment, mesh.moment, 0.08);
  }
  report.compare("M0, extrapolated", "N m", moment, extrapolated_moment(meshes), 0.02);
}

std::vector<VerifyCase> penny_cases() {
  return {{"V6-penny",
           "penny-shaped shear crack",
           {kPenny},
           false,
           [](SceneRunner& runner, VerifyReport& report) {
             study_penny(runner, {4, 5, 6, 8}, report);
           }},
          {"V6-penny-fine",
           "penny-shaped shear crack, finer cells",
           {kPenny},
           true,
           [](SceneRunner& runner, VerifyReport& report) {
             study_penny(runner, {6, 8, 10, 12}, report);
           }}};
}

}  // namespace

std::vector<VerifyCase> crack_cases() {
  std::vector<VerifyCase> cases = penny_cases();
  cases.insert(cases.begin(), crack_case());
  return cases;
}

}  // namespace faultsim
