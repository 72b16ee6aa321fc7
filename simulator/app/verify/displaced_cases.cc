// V4 and V5: a fault that displaces a reservoir, stuck and slipping, in plane strain.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "simulator/app/verify/elastic_solutions.h"
#include "simulator/app/verify/verify_cases.h"
#include "simulator/common/errors.h"

namespace faultsim {
namespace {

/// A fault node in the plane convention of elastic_solutions.h.
struct LinePoint {
  double y;       ///< m, from the fault's centre, up
  double normal;  ///< σ_n effective, Pa
  double shear;   ///< τ along up-dip d, Pa
  double slip;    ///< m, of the right (plus) side along d
  double length;  ///< m along dip that the node stands for
};

/// Dip from the horizontal of a fault that leans to the right going up (dips west).
double plane_dip(const Scene& scene) {
  return std::numbers::pi / 2 + scene.box.patches.front().dip_from_vertical;
}

std::vector<LinePoint> fault_line(const SceneRun& run, const FaultFields& fields) {
  const double dip = plane_dip(run.scene);
  const Eigen::Vector3d normal(std::sin(dip), 0, -std::cos(dip)),
      up_dip(std::cos(dip), 0, std::sin(dip));
  std::vector<LinePoint> line;
  for (std::size_t k = 0; k < run.geometry().nodes.size(); ++k) {
    const OperatorNode& node = run.geometry().nodes[k];
    const auto column = static_cast<Eigen::Index>(k);
    // Tractions and jumps change sign with the normal.
    const double sign = node.normal.dot(normal) > 0 ? 1 : -1;
    const auto along = [&](const Eigen::Matrix3Xd& field) {
      return sign * (field(1, column) * node.strike + field(2, column) * node.dip).dot(up_dip);
    };
    line.push_back({node.position.z(), fields.traction(0, column), along(fields.traction),
                    along(fields.jump), node.area});
  }
  std::sort(line.begin(), line.end(),
            [](const LinePoint& p, const LinePoint& q) { return p.y < q.y; });
  return line;
}

/// The closed form's parameters, read from the scene.
DisplacedReservoir reservoir_of(const SceneRun& run) {
  const Scene& scene = run.scene;
  const Material& rock = scene.materials.front();
  const PressureRegion &left = scene.box.regions.at(0), &right = scene.box.regions.at(1);
  const std::vector<double>& pressure = run.result.steps.back().pressure_change;
  return {rock.youngs_modulus / (2 * (1 + rock.poisson_ratio)),
          rock.poisson_ratio,
          rock.biot,
          left.to[2] - left.from[2],
          right.to[2] - left.to[2],
          plane_dip(scene),
          pressure.at(0),
          pressure.at(1)};
}

SlippingFault slipping_fault_of(const SceneRun& run) {
  const InitialState& initial = run.scene.initial;
  const Fault& fault = run.scene.faults.front();
  const DisplacedReservoir reservoir = reservoir_of(run);
  return {reservoir,
          initial.vertical_stress,
          -initial.vertical_stress_gradient,
          initial.pressure,
          -initial.pressure_gradient,
          initial.ratio_across,
          initial.initial_biot,
          fault.fault_biot,
          reservoir.left_pressure_change,
          std::tan(fault.friction.static_friction_angle)};
}

Settings box_and_cells(double half_size, double cell) {
  const auto corner = [&](double sign, double y) {
    return concat("[\"", sign * half_size, " m\", \"", y, " m\", \"", sign * half_size, " m\"]");
  };
  return {{"/geometry/from", corner(-1, 0)},
          {"/geometry/to", corner(1, 1)},
          {"/mesh/dip", concat(cell, " m")},
          {"/mesh/normal", concat(cell, " m")}};
}

struct StressErrors {
  double largest = 0;  ///< max error / max |Δ| over the compared points, of σ_n and τ together
  double l1 = 0;       ///< mean error / max |Δ|
  int n = 0;
};

/// |y| ≤ 2h, outside 10 m of the four corners.
StressErrors stress_errors(const SceneRun& run) {
  const DisplacedReservoir reservoir = reservoir_of(run);
  const double h = reservoir.thickness;
  const double a = (h - reservoir.offset) / 2, b = (h + reservoir.offset) / 2;
  const std::vector<LinePoint> start = fault_line(run, run.fields.front());
  const std::vector<LinePoint> end = fault_line(run, run.fields.back());
  StressErrors errors;
  double scale = 0;
  for (std::size_t k = 0; k < start.size(); ++k) {
    const double y = start[k].y;
    const double corner = std::min(std::abs(std::abs(y) - a), std::abs(std::abs(y) - b));
    if (std::abs(y) > 2 * h || corner < 10) continue;
    const FaultStressChange exact = displaced_fault_stress(reservoir, y);
    const double normal = std::abs(end[k].normal - start[k].normal - exact.normal);
    const double shear = std::abs(end[k].shear - start[k].shear - exact.shear);
    scale = std::max({scale, std::abs(exact.normal), std::abs(exact.shear)});
    errors.largest = std::max({errors.largest, normal, shear});
    errors.l1 += (normal + shear) / 2;
    ++errors.n;
  }
  FAULTSIM_DEMAND(errors.n > 0, "no fault node of V4 is compared");
  errors.largest /= scale;
  errors.l1 /= errors.n * scale;
  return errors;
}

void compare_at_points(const SceneRun& run, VerifyReport& report) {
  const DisplacedReservoir reservoir = reservoir_of(run);
  const std::vector<LinePoint> start = fault_line(run, run.fields.front());
  const std::vector<LinePoint> end = fault_line(run, run.fields.back());
  const double scale = 15e6;  // about max |Δ|; the rows below bound the error relative to it
  for (const double y : {-100.0, -50.0, 0.0, 50.0, 100.0}) {
    std::size_t nearest = 0;
    for (std::size_t k = 0; k < start.size(); ++k) {
      if (std::abs(start[k].y - y) < std::abs(start[nearest].y - y)) nearest = k;
    }
    const FaultStressChange exact = displaced_fault_stress(reservoir, start[nearest].y);
    const std::string place = concat(" at y = ", start[nearest].y, " m (error of 15 MPa)");
    report.compare("Δσ_n" + place, "MPa", exact.normal / 1e6,
                   (end[nearest].normal - start[nearest].normal) / 1e6, 0.02, scale / 1e6);
    report.compare("Δτ" + place, "MPa", exact.shear / 1e6,
                   (end[nearest].shear - start[nearest].shear) / 1e6, 0.02, scale / 1e6);
  }
}

const char kStuck[] = "v4_displaced_fault.json";

void study_stuck_fault(SceneRunner& runner, const Settings& blocks, VerifyReport& report) {
  const auto run = [&](double half_size, double cell) {
    Settings settings = box_and_cells(half_size, cell);
    settings.insert(settings.end(), blocks.begin(), blocks.end());
    return runner.run(kStuck, settings);
  };
  const SceneRun fine = run(9000, 2.5);
  compare_at_points(fine, report);
  const StressErrors at_fine = stress_errors(fine);
  report.bound("largest error, 2.5 m cells, 18 km box", "of max |Δ|", at_fine.largest, 0.02);
  report.bound("largest error, 2.5 m cells, 9 km box", "of max |Δ|",
               stress_errors(run(4500, 2.5)).largest, 0.02);
  const double coarse = stress_errors(run(9000, 10)).l1, middle = stress_errors(run(9000, 5)).l1;
  report.bound("L1 error, 10 m cells", "of max |Δ|", coarse, 0.05);
  report.bound("L1 error, 5 m cells", "of max |Δ|", middle, 0.025);
  report.bound("L1 error, 2.5 m cells", "of max |Δ|", at_fine.l1, 0.0125);
  report.at_least("order of L1, 10 to 5 m", 0.8, observed_order(coarse, middle));
  report.at_least("order of L1, 5 to 2.5 m", 0.8, observed_order(middle, at_fine.l1));
}

VerifyCase stuck_case(const std::string& name, const std::string& title, const Settings& blocks) {
  return {name, title, {kStuck}, false, [=](SceneRunner& runner, VerifyReport& report) {
            study_stuck_fault(runner, blocks, report);
          }};
}

/// Max slip and ∫|slip| ds of a run.
struct SlipFigures {
  double max_slip = 0, integral = 0;
};

SlipFigures slip_figures(const SceneRun& run) {
  SlipFigures figures;
  for (const LinePoint& point : fault_line(run, run.fields.back())) {
    figures.max_slip = std::max(figures.max_slip, std::abs(point.slip));
    figures.integral += std::abs(point.slip) * point.length;
  }
  return figures;
}

const char kSlipping[] = "v5_slipping_fault.json";

/// The full-space solution: boundary elements at two sizes, extrapolated at first order.
SlipFigures reference_slip(const SlippingFault& fault) {
  constexpr double element = 0.25;
  const SlipProfile coarse = boundary_element_slip(fault, element);
  const SlipProfile fine = boundary_element_slip(fault, element / 2);
  return {2 * fine.max_slip - coarse.max_slip, 2 * fine.integral - coarse.integral};
}

void compare_slip_profile(const SceneRun& run, VerifyReport& report) {
  const std::vector<LinePoint> line = fault_line(run, run.fields.back());
  const SlipProfile exact = boundary_element_slip(slipping_fault_of(run), 0.125);
  const auto interpolate = [](double y, auto&& y_of, auto&& slip_of, std::size_t n) {
    std::size_t k = 1;
    while (k + 1 < n && y_of(k) < y) ++k;
    const double share = (y - y_of(k - 1)) / (y_of(k) - y_of(k - 1));
    return slip_of(k - 1) + share * (slip_of(k) - slip_of(k - 1));
  };
  for (const double y : {-72.0, -60.0, -50.0, 50.0, 60.0, 70.0, 76.0}) {
    const double expected = interpolate(
        y, [&](std::size_t k) { return exact.y[k]; }, [&](std::size_t k) { return exact.slip[k]; },
        exact.y.size());
    const double computed = interpolate(
        y, [&](std::size_t k) { return line[k].y; }, [&](std::size_t k) { return line[k].slip; },
        line.size());
    report.compare(concat("slip at y = ", y, " m, 1.25 m cells (error of the maximum)"), "mm",
                   expected * 1e3, computed * 1e3, 0.05, exact.max_slip * 1e3);
  }
}

/// value(h, W) = v + c h + d (1/W)^p: extrapolates cells at first order, then boxes by their
/// observed order.
double extrapolate(const std::array<std::array<double, 3>, 3>& by_box_then_cell) {
  std::array<double, 3> no_cell{};
  for (std::size_t box = 0; box < 3; ++box) {
    const auto& values = by_box_then_cell[box];
    no_cell[box] = 2 * values[2] - values[1];
  }
  const double ratio = (no_cell[1] - no_cell[0]) / (no_cell[2] - no_cell[1]);
  // Boxes double: the remaining difference is a geometric series if it shrinks at all.
  return ratio > 1 ? no_cell[2] + (no_cell[2] - no_cell[1]) / (ratio - 1) : no_cell[2];
}

VerifyCase slipping_case() {
  return {
      "V5-slip",
      "slip of the displaced fault, constant friction",
      {kSlipping},
      false,
      [](SceneRunner& runner, VerifyReport& report) {
        constexpr std::array<double, 3> half_sizes = {4500, 9000, 18000}, cells = {5, 2.5, 1.25};
        std::array<std::array<double, 3>, 3> max_slip{}, integral{};
        SlipFigures exact;
        for (std::size_t box = 0; box < 3; ++box) {
          for (std::size_t cell = 0; cell < 3; ++cell) {
            const SceneRun run = runner.run(kSlipping, box_and_cells(half_sizes[box], cells[cell]));
            if (exact.max_slip == 0) exact = reference_slip(slipping_fault_of(run));
            const SlipFigures figures = slip_figures(run);
            max_slip[box][cell] = figures.max_slip;
            integral[box][cell] = figures.integral;
            const std::string place =
                concat(", ", cells[cell], " m cells, ", half_sizes[box] / 500, " km box");
            const double tolerance = cells[cell] == 1.25 ? 0.03 : 0.12;
            report.compare("max slip" + place, "mm", exact.max_slip * 1e3, figures.max_slip * 1e3,
                           tolerance);
            report.compare("∫ slip ds" + place, "m²", exact.integral, figures.integral, tolerance);
            if (box == 1 && cell == 2) compare_slip_profile(run, report);
          }
        }
        report.compare("max slip, extrapolated in both", "mm", exact.max_slip * 1e3,
                       extrapolate(max_slip) * 1e3, 0.01);
        report.compare("∫ slip ds, extrapolated in both", "m²", exact.integral,
                       extrapolate(integral), 0.01);
        const auto error = [&](std::size_t box, std::size_t cell) {
          return std::abs(max_slip[box][cell] / exact.max_slip - 1);
        };
        report.holds("error falls with cell size",
                     error(1, 0) > error(1, 1) && error(1, 1) > error(1, 2));
        report.holds("error falls with box size",
                     error(0, 2) > error(1, 2) && error(1, 2) > error(2, 2));
      }};
}

const char kFrictionless[] = "v5_frictionless_fault.json";

VerifyCase frictionless_case() {
  return {"V5-frictionless",
          "slip plateau of a vertical frictionless fault",
          {kFrictionless},
          false,
          [](SceneRunner& runner, VerifyReport& report) {
            const SceneRun run = runner.run(kFrictionless, box_and_cells(9000, 2.5));
            const DisplacedReservoir reservoir = reservoir_of(run);
            const double plateau = frictionless_slip(reservoir, 0);
            double worst = 0;
            for (const LinePoint& point : fault_line(run, run.fields.back())) {
              worst = std::max(
                  worst, std::abs(std::abs(point.slip) - frictionless_slip(reservoir, point.y)));
              if (point.y == 0) {
                report.compare("slip at y = 0", "m", plateau, std::abs(point.slip), 0.01);
              }
            }
            report.bound("largest difference of the profile", "of the plateau", worst / plateau,
                         0.02);
          }};
}

}  // namespace

std::vector<VerifyCase> displaced_cases() {
  return {stuck_case("V4-both", "tractions on a stuck displaced fault, both blocks depleted", {}),
          stuck_case("V4-left", "the same, only the left block depleted",
                     {{"/compartments/right/scale", "0"}}),
          stuck_case("V4-right", "the same, only the right block depleted",
                     {{"/compartments/left/scale", "0"}}),
          slipping_case(), frictionless_case()};
}

}  // namespace faultsim
