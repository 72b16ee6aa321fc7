// V4 and V5: a fault that displaces a reservoir, stuck and slipping, in plane strain.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "simulator/common/errors.h"
#include "tests/verification/closed_forms/elastic_solutions.h"
#include "tests/verification/closed_forms/verify_cases.h"

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

/// Dip from the horizontal of a fault that leans to the right going up (dips west); beyond 90° for
/// one that leans to the left. A strike of 180° describes the plane from its other side.
double plane_dip(const Scene& scene) {
  const PatchGeometry& patch = scene.box.patches.front();
  const double side = std::cos(patch.strike) > 0 ? 1 : -1;
  return std::numbers::pi / 2 + side * patch.dip_from_vertical;
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

/// True within 10 m of one of the four corners ±a, ±b, where the exact tractions are infinite.
bool is_near_corner(const SceneRun& run, double y) {
  const DisplacedReservoir reservoir = reservoir_of(run);
  const double a = (reservoir.thickness - reservoir.offset) / 2;
  const double b = (reservoir.thickness + reservoir.offset) / 2;
  return std::min(std::abs(std::abs(y) - a), std::abs(std::abs(y) - b)) < 10;
}

/// |y| ≤ 2h, outside 10 m of the four corners.
StressErrors stress_errors(const SceneRun& run) {
  const DisplacedReservoir reservoir = reservoir_of(run);
  const std::vector<LinePoint> start = fault_line(run, run.fields.front());
  const std::vector<LinePoint> end = fault_line(run, run.fields.back());
  StressErrors errors;
  double scale = 0;
  for (std::size_t k = 0; k < start.size(); ++k) {
    const double y = start[k].y;
    if (std::abs(y) > 2 * reservoir.thickness || is_near_corner(run, y)) continue;
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
    const std::string place = " at y = " + short_number(start[nearest].y) + " m (error of 15 MPa)";
    report.compare("Δσ_n" + place, "MPa", exact.normal / 1e6,
                   (end[nearest].normal - start[nearest].normal) / 1e6, 0.02, scale / 1e6);
    report.compare("Δτ" + place, "MPa", exact.shear / 1e6,
                   (end[nearest].shear - start[nearest].shear) / 1e6, 0.02, scale / 1e6);
  }
}

const char kStuck[] = "v4_displaced_fault.json";

/// Mean |difference| of the traction changes of two runs at the nodes of the coarser one, Pa. It
/// shows the order in the cell size alone: both runs share the box, whose error may be larger.
double mean_difference(const SceneRun& coarse, const SceneRun& fine) {
  const std::vector<LinePoint> p0 = fault_line(coarse, coarse.fields.front());
  const std::vector<LinePoint> p1 = fault_line(coarse, coarse.fields.back());
  const std::vector<LinePoint> q0 = fault_line(fine, fine.fields.front());
  const std::vector<LinePoint> q1 = fault_line(fine, fine.fields.back());
  double sum = 0;
  int n = 0;
  for (std::size_t i = 0, k = 0; i < p0.size(); ++i) {
    while (k + 1 < q0.size() && q0[k].y < p0[i].y - 1e-3) ++k;
    if (std::abs(q0[k].y - p0[i].y) > 1e-3 || is_near_corner(coarse, p0[i].y)) continue;
    sum += std::abs((p1[i].normal - p0[i].normal) - (q1[k].normal - q0[k].normal)) +
           std::abs((p1[i].shear - p0[i].shear) - (q1[k].shear - q0[k].shear));
    n += 2;
  }
  FAULTSIM_DEMAND(n > 10, "grids of V4 share only ", n, " values");
  return sum / n;
}

void study_stuck_fault(SceneRunner& runner, const Settings& blocks, VerifyReport& report) {
  const auto run = [&](double half_size, double cell) {
    Settings settings = box_and_cells(half_size, cell);
    settings.insert(settings.end(), blocks.begin(), blocks.end());
    return runner.run(kStuck, settings);
  };
  const SceneRun fine = run(9000, 2.5), middle = run(9000, 5), coarse = run(9000, 10);
  compare_at_points(fine, report);
  const StressErrors small_box = stress_errors(run(4500, 2.5)), large_box = stress_errors(fine);
  report.bound("largest error, 2.5 m cells, 9 km box", "of max |Δ|", small_box.largest, 0.02);
  report.bound("largest error, 2.5 m cells, 18 km box", "of max |Δ|", large_box.largest, 0.02);
  report.holds("error falls with box size", large_box.largest < small_box.largest);
  report.bound("L1 error, 10 m cells", "of max |Δ|", stress_errors(coarse).l1, 0.02);
  report.bound("L1 error, 5 m cells", "of max |Δ|", stress_errors(middle).l1, 0.01);
  report.bound("L1 error, 2.5 m cells", "of max |Δ|", large_box.l1, 0.005);
  report.at_least("order of L1 in the cell size, 10, 5, 2.5 m", 0.8,
                  observed_order(mean_difference(coarse, middle), mean_difference(middle, fine)));
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

constexpr std::size_t kBoxes = 3, kCells = 4;
constexpr std::array<double, kBoxes> kHalfSizes = {4500, 9000, 18000};
constexpr std::array<double, kCells> kCellSizes = {5, 2.5, 1.25, 0.625};
/// Of slip, per cell size.
constexpr std::array<double, kCells> kTolerances = {0.06, 0.06, 0.025, 0.013};

const char kSlipping[] = "v5_slipping_fault.json";

/// The full-space solution: boundary elements at two sizes, extrapolated at first order.
SlipFigures reference_slip(const SlippingFault& fault) {
  constexpr double element = 0.25;
  const SlipProfile coarse = boundary_element_slip(fault, element);
  const SlipProfile fine = boundary_element_slip(fault, element / 2);
  return {2 * fine.max_slip - coarse.max_slip, 2 * fine.integral - coarse.integral};
}

/// Linear interpolation of slip at y; ascending in y.
template <typename Y, typename Slip>
double interpolate(double y, std::size_t n, const Y& y_of, const Slip& slip_of) {
  std::size_t k = 1;
  while (k + 1 < n && y_of(k) < y) ++k;
  const double share = (y - y_of(k - 1)) / (y_of(k) - y_of(k - 1));
  return slip_of(k - 1) + share * (slip_of(k) - slip_of(k - 1));
}

double slip_at(const SlipProfile& profile, double y) {
  return interpolate(
      y, profile.y.size(), [&](std::size_t k) { return profile.y[k]; },
      [&](std::size_t k) { return profile.slip[k]; });
}

/// Where the slip patches of a profile end: heights of its first and last slipping points above and
/// below the centre, m.
struct PatchEnds {
  double lower_from = 0, lower_to = -1e9, upper_from = 1e9, upper_to = 0;

  void add(double y) {
    lower_from = std::min(lower_from, y);
    upper_to = std::max(upper_to, y);
    if (y < 0) lower_to = std::max(lower_to, y);
    if (y > 0) upper_from = std::min(upper_from, y);
  }
};

void compare_patch_ends(const SceneRun& run, double cell, VerifyReport& report) {
  const SlipProfile profile = boundary_element_slip(slipping_fault_of(run), 0.125);
  PatchEnds expected, computed;
  for (std::size_t k = 0; k < profile.y.size(); ++k)
    if (std::abs(profile.slip[k]) > 0) expected.add(profile.y[k]);
  for (const LinePoint& point : fault_line(run, run.fields.back()))
    if (std::abs(point.slip) > 0) computed.add(point.y);
  const std::string place = ", " + short_number(cell) + " m cells (error in cells)";
  report.compare("lower patch from" + place, "m", expected.lower_from, computed.lower_from, 2,
                 cell);
  report.compare("lower patch to" + place, "m", expected.lower_to, computed.lower_to, 2, cell);
  report.compare("upper patch from" + place, "m", expected.upper_from, computed.upper_from, 2,
                 cell);
  report.compare("upper patch to" + place, "m", expected.upper_to, computed.upper_to, 2, cell);
}

void compare_slip_profile(const SceneRun& run, double cell, double tolerance,
                          VerifyReport& report) {
  const std::vector<LinePoint> line = fault_line(run, run.fields.back());
  const SlippingFault fault = slipping_fault_of(run);
  const SlipProfile coarse = boundary_element_slip(fault, 0.25);
  const SlipProfile fine = boundary_element_slip(fault, 0.125);
  for (const double y : {-72.0, -60.0, -50.0, 50.0, 60.0, 70.0, 76.0}) {
    const double expected = 2 * slip_at(fine, y) - slip_at(coarse, y);
    const double computed = interpolate(
        y, line.size(), [&](std::size_t k) { return line[k].y; },
        [&](std::size_t k) { return line[k].slip; });
    report.compare("slip at y = " + short_number(y) + " m, " + short_number(cell) +
                       " m cells (error of the maximum)",
                   "mm", expected * 1e3, computed * 1e3, tolerance, fine.max_slip * 1e3);
  }
}

using Study = std::array<std::array<double, kCells>, kBoxes>;

/// To cells of no size at first order, from the two finest, then to an infinite box by the order
/// that the three boxes show.
double extrapolate(const Study& values) {
  std::array<double, kBoxes> no_cell{};
  for (std::size_t box = 0; box < kBoxes; ++box) {
    no_cell[box] = 2 * values[box][kCells - 1] - values[box][kCells - 2];
  }
  const double last = no_cell[2] - no_cell[1];
  const double ratio = (no_cell[1] - no_cell[0]) / last;
  // Boxes double, so the differences left are a geometric series if they shrink at all.
  return ratio > 1 ? no_cell[2] + last / (ratio - 1) : no_cell[2];
}

void compare_study(const std::string& quantity, const std::string& unit, double exact,
                   double factor, const Study& values, VerifyReport& report) {
  const auto error = [&](std::size_t box, std::size_t cell) {
    return std::abs(values[box][cell] / exact - 1);
  };
  for (std::size_t box = 0; box < kBoxes; ++box) {
    for (std::size_t cell = 0; cell < kCells; ++cell) {
      const std::string place = ", " + short_number(kCellSizes[cell]) + " m cells, " +
                                short_number(kHalfSizes[box] / 500) + " km box";
      report.compare(quantity + place, unit, exact * factor, values[box][cell] * factor,
                     kTolerances[cell]);
    }
  }
  report.compare(quantity + ", extrapolated in both", unit, exact * factor,
                 extrapolate(values) * factor, 0.01);
  bool with_cell = true, with_box = true;
  for (std::size_t cell = 1; cell < kCells; ++cell)
    with_cell &= error(1, cell) < error(1, cell - 1);
  for (std::size_t box = 1; box < kBoxes; ++box) with_box &= error(box, 2) < error(box - 1, 2);
  report.holds("error of " + quantity + " falls with cell size (18 km box)", with_cell);
  report.holds("error of " + quantity + " falls with box size (1.25 m cells)", with_box);
}

VerifyCase slipping_case() {
  return {"V5-slip",
          "slip of the displaced fault, constant friction",
          {kSlipping},
          false,
          [](SceneRunner& runner, VerifyReport& report) {
            Study max_slip{}, integral{};
            SlipFigures exact;
            for (std::size_t box = 0; box < kBoxes; ++box) {
              for (std::size_t cell = 0; cell < kCells; ++cell) {
                const SceneRun run =
                    runner.run(kSlipping, box_and_cells(kHalfSizes[box], kCellSizes[cell]));
                if (exact.max_slip == 0) exact = reference_slip(slipping_fault_of(run));
                const SlipFigures figures = slip_figures(run);
                max_slip[box][cell] = figures.max_slip;
                integral[box][cell] = figures.integral;
                if (box + 1 < kBoxes || cell + 2 < kCells) continue;
                compare_slip_profile(run, kCellSizes[cell], kTolerances[cell], report);
                compare_patch_ends(run, kCellSizes[cell], report);
              }
            }
            compare_study("max slip", "mm", exact.max_slip, 1e3, max_slip, report);
            compare_study("∫ slip ds", "m²", exact.integral, 1, integral, report);
          }};
}

/// The scene in the mirror x → −x: the other dip, and the blocks change sides.
Settings mirrored(Settings settings) {
  settings.push_back({"/faults/0/dip_from_vertical", "20 deg"});
  settings.push_back({"/geometry/regions", R"([
    {"name":"left","shape":"box","from":["-100 km","-1 m","-75 m"],"to":["0 m","2 m","150 m"]},
    {"name":"right","shape":"box","from":["0 m","-1 m","-150 m"],"to":["100 km","2 m","75 m"]}])"});
  return settings;
}

/// Largest difference of |slip|, of σ_n and of |τ| (which change sign in a mirror) of two runs on
/// the same heights, relative to the largest value in `given`.
struct LineDifference {
  double slip = 0, normal = 0, shear = 0;
};
LineDifference line_difference(const SceneRun& given, const SceneRun& other) {
  const std::vector<LinePoint> p = fault_line(given, given.fields.back());
  const std::vector<LinePoint> q = fault_line(other, other.fields.back());
  if (p.size() != q.size()) throw Error("the runs have different numbers of fault nodes");
  LineDifference difference, scale;
  for (std::size_t k = 0; k < p.size(); ++k) {
    if (std::abs(p[k].y - q[k].y) > 1e-6) throw Error("the runs have different fault nodes");
    const auto note = [](double& worst, double& largest, double a, double b) {
      worst = std::max(worst, std::abs(std::abs(a) - std::abs(b)));
      largest = std::max(largest, std::abs(a));
    };
    note(difference.slip, scale.slip, p[k].slip, q[k].slip);
    note(difference.normal, scale.normal, p[k].normal, q[k].normal);
    note(difference.shear, scale.shear, p[k].shear, q[k].shear);
  }
  return {difference.slip / scale.slip, difference.normal / scale.normal,
          difference.shear / scale.shear};
}

VerifyCase mirrored_case() {
  return {"V5-mirrored",
          "slip of the displaced fault: mirrored and reversed scenes give the same figures",
          {kSlipping},
          false,
          [](SceneRunner& runner, VerifyReport& report) {
            const Settings settings = box_and_cells(18000, 2.5);
            const SceneRun given = runner.run(kSlipping, settings);
            Settings reversed = settings;
            reversed.push_back({"/faults/0/strike", "180 deg"});
            reversed.push_back({"/faults/0/dip_from_vertical", "20 deg"});
            const auto same = [&](const std::string& what, const Settings& changed) {
              const LineDifference worst = line_difference(given, runner.run(kSlipping, changed));
              report.bound(what + ": slip, worst node", "of the maximum", worst.slip, 1e-8);
              report.bound(what + ": σ_n, worst node", "of the maximum", worst.normal, 1e-8);
              report.bound(what + ": τ, worst node", "of the maximum", worst.shear, 1e-8);
            };
            same("in a mirror", mirrored(settings));
            same("strike + 180°, the same plane", reversed);
          }};
}

/// μ from 0.52 to 0.20 over 20 mm: slip outruns the rock before the depletion is over.
Settings weakening(Settings settings) {
  settings.push_back({"/friction/dynamic_friction_coefficient", "0.2"});
  settings.push_back({"/friction/slip_weakening_distance", "20 mm"});
  settings.push_back({"/numerics/onset_tolerance", "1e-5"});
  settings.push_back({"/stages/0/steps", "100"});
  return settings;
}

/// Δp at the onset of the first event, MPa.
double onset_of(const SceneRun& run, VerifyReport& report, const std::string& where) {
  const auto& events = run.result.events;
  report.holds("one event, its evidence holds" + where,
               events.size() == 1 && events.front().evidence_holds);
  return events.empty() ? 0 : leading_change(events.front().pressures).value_or(0) / 1e6;
}

void study_onset(SceneRunner& runner, VerifyReport& report) {
  const std::array<double, 3> cells = {2.5, 1.25, 0.625};
  std::array<double, 3> onset{};
  double exact = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string where = ", " + short_number(cells[i]) + " m cells";
    const SceneRun run = runner.run(kSlipping, weakening(box_and_cells(18000, cells[i])));
    if (exact == 0) {
      const SlippingFault fault = slipping_fault_of(run);
      const auto share = [&](double element) {
        return boundary_element_onset(fault, {0.2, 0.02}, element);
      };
      exact = (2 * share(0.25) - share(0.5)) * fault.fault_pressure_change / 1e6;
    }
    onset[i] = onset_of(run, report, where);
    report.compare("onset" + where, "MPa", exact, onset[i], 0.01);
  }
  const double first = 2 * onset[1] - onset[0], second = 2 * onset[2] - onset[1];
  report.compare("onset, 2.5 and 1.25 m extrapolated", "MPa", exact, first, 0.005);
  report.compare("onset, 1.25 and 0.625 m extrapolated", "MPa", exact, second, 0.005);
  report.bound("difference of the extrapolated onsets", "relative", std::abs(first / second - 1),
               0.003);
  report.at_least("order of the onset in the cell size", 0.8,
                  observed_order(onset[1] - onset[0], onset[2] - onset[1]));
}

VerifyCase weakening_case() {
  return {"V5-weakening",
          "the displaced fault with slip weakening: onset of the event",
          {kSlipping},
          true,
          study_onset};
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
          slipping_case(),
          mirrored_case(),
          weakening_case(),
          frictionless_case()};
}

}  // namespace faultsim
