// V6 in plane strain: an inclined crack with friction in an infinite body.
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "simulator/common/errors.h"
#include "tests/verification/closed_forms/elastic_solutions.h"
#include "tests/verification/closed_forms/verify_cases.h"

namespace faultsim {
namespace {

const char kCrack[] = "v6_frictional_crack.json";

double slip_at(const SceneRun& run, std::size_t node) {
  return run.fields.back().jump.col(static_cast<Eigen::Index>(node)).tail<2>().norm();
}

/// Far stress of the scene, resolved on the crack's plane.
struct FarStress {
  double normal, shear;  ///< Pa, shear ≥ 0
};
FarStress far_stress(const SceneRun& run) {
  const std::array<double, 9>& rows = run.scene.box.boundary.front().stress;
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> stress(rows.data());
  const Eigen::Vector3d& normal = run.geometry().nodes.front().normal;
  const Eigen::Vector3d traction = stress * normal;
  const double along = traction.dot(normal);
  return {along, (traction - along * normal).norm()};
}

/// The crack that a scene describes: slip 4(1−ν²)/E · σ sin ψ (cos ψ − sin ψ tan φ) √(b²−s²).
struct Crack {
  double load, angle;  ///< σ > 0, Pa; ψ, rad
  double friction_coefficient;
  double half_length;  ///< b, m
  Material rock;

  double slip(double s) const {
    return frictional_crack_slip(rock.youngs_modulus, rock.poisson_ratio, load, angle,
                                 friction_coefficient, half_length, s);
  }
};

Crack crack_of(const SceneRun& run) {
  const FarStress far = far_stress(run);
  // Turned back: uniaxial compression σ at angle ψ to the crack.
  return {-(far.normal + far.shear * far.shear / far.normal), std::atan(-far.normal / far.shear),
          std::tan(run.scene.faults.front().friction.static_friction_angle),
          run.scene.box.patches.front().width / 2, run.scene.materials.front()};
}

struct CrackErrors {
  double l2 = 0;      ///< √(Σ error² / Σ exact²) over |s| < 0.9 b
  double normal = 0;  ///< largest |t_N − exact| / |exact| there
  double centre = 0;  ///< m
};

CrackErrors crack_errors(const SceneRun& run) {
  const Crack crack = crack_of(run);
  const double far_normal = far_stress(run).normal;
  CrackErrors errors;
  double difference = 0, norm = 0;
  for (std::size_t k = 0; k < run.geometry().nodes.size(); ++k) {
    const OperatorNode& node = run.geometry().nodes[k];
    const double s = node.position.dot(node.dip);
    if (std::abs(s) < 1e-9 * crack.half_length) errors.centre = slip_at(run, k);
    if (std::abs(s) >= 0.9 * crack.half_length) continue;
    const double exact = crack.slip(s);
    difference += std::pow(slip_at(run, k) - exact, 2);
    norm += exact * exact;
    const double normal = run.fields.back().traction(0, static_cast<Eigen::Index>(k));
    errors.normal = std::max(errors.normal, std::abs(normal / far_normal - 1));
  }
  FAULTSIM_DEMAND(norm > 0, "no node of the crack is compared");
  errors.l2 = std::sqrt(difference / norm);
  return errors;
}

Settings cells(double size) {
  return {{"/mesh/dip", concat(size, " m")}, {"/mesh/normal", concat(size, " m")}};
}

Settings with_box(Settings settings, double half_size) {
  const auto corner = [&](double sign, double y) {
    return concat("[\"", sign * half_size, " m\", \"", y, " m\", \"", sign * half_size, " m\"]");
  };
  settings.push_back({"/geometry/from", corner(-1, 0)});
  settings.push_back({"/geometry/to", corner(1, 1)});
  return settings;
}

void compare_slip(const SceneRun& run, const std::string& what, VerifyReport& report) {
  const CrackErrors errors = crack_errors(run);
  report.compare("slip at the centre" + what, "mm", crack_of(run).slip(0) * 1e3,
                 errors.centre * 1e3, 0.01);
  report.bound("t_N, worst node with |s| < 0.9 b" + what, "relative", errors.normal, 0.01);
  report.bound("L2 error of slip, |s| < 0.9 b" + what, "relative", errors.l2, 0.01);
}

VerifyCase crack_case() {
  return {"V6-crack",
          "inclined crack with friction, uniaxial compression",
          {kCrack},
          false,
          [](SceneRunner& runner, VerifyReport& report) {
            const SceneRun fine = runner.run(kCrack, cells(0.0125));
            compare_slip(fine, ", 160 cells, body of half-size 20 b", report);
            compare_slip(runner.run(kCrack, with_box(cells(0.0125), 40)),
                         ", 160 cells, body of half-size 40 b", report);
            const double l2[] = {crack_errors(runner.run(kCrack, cells(0.05))).l2,
                                 crack_errors(runner.run(kCrack, cells(0.025))).l2,
                                 crack_errors(fine).l2};
            report.bound("L2 error of slip, 40 cells", "relative", l2[0], 0.04);
            report.bound("L2 error of slip, 80 cells", "relative", l2[1], 0.02);
            report.at_least("order of L2 in the cell size, 40 to 80 cells", 0.8,
                            observed_order(l2[0], l2[1]));
            report.at_least("order of L2 in the cell size, 80 to 160 cells", 0.8,
                            observed_order(l2[1], l2[2]));
          }};
}

/// The scene with another far stress, rows in MPa, and another dip of the crack.
SceneRun run_turned(SceneRunner& runner, double xx, double xz, double zz, double dip_from_vertical,
                    double cell_along_grid) {
  Settings settings = cells(0.0125);
  settings[0].value = concat(cell_along_grid, " m");
  settings.push_back(
      {"/geometry/boundary/0/stress", concat("[[\"", xx, " MPa\",\"0 MPa\",\"", xz,
                                             " MPa\"],[\"0 MPa\",\"-25 MPa\",\"0 MPa\"],[\"", xz,
                                             " MPa\",\"0 MPa\",\"", zz, " MPa\"]]")});
  settings.push_back({"/faults/0/dip_from_vertical", concat(dip_from_vertical, " deg")});
  return runner.run(kCrack, settings);
}

/// The same crack with the body turned instead of the stress, along the other grid axis, in a
/// mirror, and with its sides exchanged.
VerifyCase turned_case() {
  return {
      "V6-crack-turned",
      "the same crack inclined in the grid, along the other axis, and mirrored",
      {kCrack},
      false,
      [](SceneRunner& runner, VerifyReport& report) {
        const SceneRun given = runner.run(kCrack, cells(0.0125));
        const std::array<double, 9>& stress = given.scene.box.boundary.front().stress;
        const double normal = stress[0] / 1e6, shear = stress[2] / 1e6, along = stress[8] / 1e6;
        // σ_z = −100 MPa at 20° to the crack; 160 cells along it, seen along z.
        const double cell = 0.0125 * std::cos(20 * std::numbers::pi / 180);
        compare_slip(run_turned(runner, 0, 0, -100, 20, cell), ", crack 20° off z", report);
        compare_slip(run_turned(runner, 0, 0, -100, -20, cell), ", crack −20° off z", report);
        const double centre = crack_errors(given).centre, l2 = crack_errors(given).l2;
        const auto same = [&](const SceneRun& run, const std::string& what) {
          const CrackErrors errors = crack_errors(run);
          report.compare("slip at the centre" + what, "mm", centre * 1e3, errors.centre * 1e3,
                         1e-9);
          report.compare("L2 error of slip" + what, "relative", l2, errors.l2, 1e-9, 1);
        };
        same(run_turned(runner, along, shear, normal, 90, 0.0125), ", crack along x: as given");
        same(run_turned(runner, normal, -shear, along, 0, 0.0125), ", mirrored: as given");
        same(runner.run(kCrack, {{"/faults/0/strike", "180 deg"}}), ", strike + 180°: as given");
      }};
}

}  // namespace

std::vector<VerifyCase> crack_cases() { return {crack_case(), turned_case()}; }

}  // namespace faultsim
