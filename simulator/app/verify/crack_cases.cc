// V6: cracks in an infinite body: inclined with friction (plane strain), penny-shaped (3D).
#include <algorithm>
#include <array>
#include <cmath>

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
  double centre = 0;  ///< m
  double moment = 0;  ///< N m
};

PennyFigures penny_figures(const SceneRun& run) {
  PennyFigures figures;
  for (std::size_t k = 0; k < run.geometry().nodes.size(); ++k) {
    if (run.geometry().nodes[k].position.norm() < 1e-6) figures.centre = slip_at(run, k);
  }
  figures.moment = run.result.steps.back().faults.front().moment;
  return figures;
}

VerifyCase penny_case() {
  return {"V6-penny",
          "penny-shaped shear crack",
          {kPenny},
          false,
          [](SceneRunner& runner, VerifyReport& report) {
            const auto run = [&](const char* cell) {
              return runner.run(
                  kPenny, {{"/mesh/strike", cell}, {"/mesh/dip", cell}, {"/mesh/normal", cell}});
            };
            const SceneRun fine_run = run("10 m");
            const PennyFigures coarse = penny_figures(run("20 m")), fine = penny_figures(fine_run);
            const Material& rock = fine_run.scene.materials.front();
            const double drop = far_stress(fine_run.scene).shear;
            const double radius = fine_run.scene.box.patches.front().width / 2;
            const double slip =
                penny_crack_slip(shear_modulus_of(rock), rock.poisson_ratio, drop, radius, 0);
            const double moment = penny_crack_moment(rock.poisson_ratio, drop, radius);
            report.compare("slip at the centre, 20 m cells", "m", slip, coarse.centre, 0.15);
            report.compare("slip at the centre, 10 m cells", "m", slip, fine.centre, 0.08);
            report.compare("slip at the centre, extrapolated", "m", slip,
                           2 * fine.centre - coarse.centre, 0.02);
            report.compare("M0, 20 m cells", "N m", moment, coarse.moment, 0.3);
            report.compare("M0, 10 m cells", "N m", moment, fine.moment, 0.15);
            report.compare("M0, extrapolated", "N m", moment, 2 * fine.moment - coarse.moment,
                           0.02);
          }};
}

}  // namespace

std::vector<VerifyCase> crack_cases() { return {crack_case(), penny_case()}; }

}  // namespace faultsim
