// V2 and V3: uniform compaction, the Geertsma disc, the initial state and the onset of slip.
#include <algorithm>
#include <cmath>

#include "simulator/common/errors.h"
#include "simulator/common/units.h"
#include "tests/verification/closed_forms/elastic_solutions.h"
#include "tests/verification/closed_forms/friction_solutions.h"
#include "tests/verification/closed_forms/verify_cases.h"

namespace faultsim {
namespace {

constexpr double kExact = 1e-9;

void compare_compaction(SceneRunner& runner, const std::string& biot, VerifyReport& report) {
  const SceneRun run = runner.run("v2_compaction.json", {{"/materials/reservoir/biot", biot}});
  const Material& rock = material_named(run.scene, "reservoir");
  const double pressure_change = run.result.steps.back().pressure_change.at(0);
  const double thickness = run.scene.box.layers[2].top_depth - run.scene.box.layers[1].top_depth;
  const double shortening = rock.biot * pressure_change * thickness *
                            uniaxial_compressibility(rock.youngs_modulus, rock.poisson_ratio);
  report.compare("α " + biot + ": surface displacement", "m", shortening,
                 run.observed("surface.z", 1), kExact);
  const double change = -horizontal_stress_ratio(rock.poisson_ratio, rock.biot) * pressure_change;
  double worst_inside = change, worst_outside = 0;
  for (Eigen::Index k = 0; k < run.fields[0].traction.cols(); ++k) {
    const double depth = -run.geometry().nodes[static_cast<std::size_t>(k)].position.z();
    const double computed = run.fields[1].traction(0, k) - run.fields[0].traction(0, k);
    const double margin = 1e-6;
    if (depth > run.scene.box.layers[1].top_depth + margin &&
        depth < run.scene.box.layers[2].top_depth - margin) {
      if (std::abs(computed - change) > std::abs(worst_inside - change)) worst_inside = computed;
    } else if (depth < run.scene.box.layers[1].top_depth - margin ||
               depth > run.scene.box.layers[2].top_depth + margin) {
      worst_outside = std::max(worst_outside, std::abs(computed));
    }
  }
  report.compare("α " + biot + ": Δσ_h in the layer, worst node", "MPa", change / 1e6,
                 worst_inside / 1e6, kExact);
  report.bound("α " + biot + ": |Δσ_h| outside / inside", "relative",
               worst_outside / std::abs(change), kExact);
}

VerifyCase compaction_case() {
  return {"V2-compaction",
          "uniaxial compaction of a confined layer",
          {"v2_compaction.json"},
          false,
          [](SceneRunner& runner, VerifyReport& report) {
            compare_compaction(runner, "1.0", report);
            compare_compaction(runner, "0.6", report);
          }};
}

GeertsmaDisc disc_of(const SceneRun& run) {
  const Material& rock = run.scene.materials.front();
  const PressureRegion& region = run.scene.box.regions.front();
  return {rock.youngs_modulus, rock.poisson_ratio,
          rock.biot,           run.result.steps.back().pressure_change.at(0),
          region.thickness,    region.radius,
          -region.center[2]};
}

/// Largest error over the observed radii, of the centre's displacement.
double compare_subsidence(const SceneRun& run, const std::string& box, VerifyReport& report) {
  const GeertsmaDisc disc = disc_of(run);
  const double scale = std::abs(geertsma_centre_displacement(disc));
  double worst = 0;
  for (const ObservationPoint& point : run.scene.output.observation_points) {
    const std::string row = point.name + ".z";
    const double r = run.observed_position(row).head<2>().norm();
    const double exact = geertsma_surface_displacement(disc, r), computed = run.observed(row, 1);
    report.compare("u_z at r = " + short_number(r) + " m, " + box + " (error of the centre's)", "m",
                   exact, computed, 0.02, scale);
    worst = std::max(worst, std::abs(computed - exact) / scale);
  }
  return worst;
}

VerifyCase geertsma_case() {
  const char file[] = "v2_geertsma_disc.json";
  return {"V2-geertsma",
          "subsidence above a depleted disc, half space",
          {file},
          false,
          [=](SceneRunner& runner, VerifyReport& report) {
            const double small = compare_subsidence(runner.run(file), "half-size 10 D", report);
            const Settings doubled = {{"/geometry/from", R"(["0 m","0 m","-40 km"])"},
                                      {"/geometry/to", R"(["40 km","40 km","0 m"])"}};
            const double large =
                compare_subsidence(runner.run(file, doubled), "half-size 20 D", report);
            report.holds("error falls with box size", large < small);
          }};
}

VerifyCase initial_state_case() {
  const char file[] = "v3_initial_state.json";
  return {"V3-initial",
          "critical index of dipping faults before any load",
          {file},
          false,
          [=](SceneRunner& runner, VerifyReport& report) {
            for (const char* ratio : {"0.74", "0.40"}) {
              for (const int dip : {0, 5, 10, 15, 20, 25}) {
                const SceneRun run =
                    runner.run(file, {{"/initial_state/ratio_across", ratio},
                                      {"/faults/0/dip_from_vertical", concat(dip, " deg")}});
                const double expected =
                    initial_critical_index(run.scene.initial.ratio_across, dip * kDegree,
                                           run.scene.faults.front().friction.static_friction_angle);
                const Eigen::VectorXd& chi = run.fields.front().critical_index;
                Eigen::Index worst = 0;
                (chi.array() - expected).abs().maxCoeff(&worst);
                report.compare(concat("χ0, M ", ratio, ", dip ", dip, "°, worst node"), "",
                               expected, chi[worst], 1e-9, std::max(expected, 0.01));
              }
            }
          }};
}

UniformDepletion depletion_of(const Scene& scene) {
  const InitialState& initial = scene.initial;
  const double vertical = -(initial.vertical_stress + initial.initial_biot * initial.pressure);
  return {vertical,
          initial.ratio_across * vertical,
          scene.box.patches.front().dip_from_vertical,
          scene.faults.front().friction.static_friction_angle,
          scene.materials.front().biot,
          scene.faults.front().fault_biot,
          scene.materials.front().poisson_ratio};
}

/// Depletion at which the worst node reaches its limit: |t_T| + tan φ t'_N is linear in the
/// depletion, so two steps before the onset give its root.
double extrapolated_onset(const SceneRun& run, double friction_angle) {
  const std::size_t last = run.fields.size() - 1, before = last - 1;
  const auto pressure = [&](std::size_t step) {
    return -run.result.steps[step].pressure_change.at(0);
  };
  double onset = std::numeric_limits<double>::infinity();
  for (Eigen::Index k = 0; k < run.fields[last].traction.cols(); ++k) {
    const auto excess = [&](std::size_t step) {
      const auto traction = run.fields[step].traction.col(k);
      return traction.tail<2>().norm() + std::tan(friction_angle) * traction[0];
    };
    const double slope = (excess(last) - excess(before)) / (pressure(last) - pressure(before));
    onset = std::min(onset, pressure(last) - excess(last) / slope);
  }
  return onset;
}

VerifyCase onset_case() {
  const char file[] = "v3_onset.json";
  return {
      "V3-onset",
      "depletion at which a through-going fault starts to slip",
      {file},
      false,
      [=](SceneRunner& runner, VerifyReport& report) {
        const SceneRun run = runner.run(file);
        const UniformDepletion state = depletion_of(run.scene);
        const FaultLoad start = fault_load(state, 0);
        const auto node = run.fields.front().traction.cols() / 2;
        const auto traction = run.fields.front().traction.col(node);
        report.compare("N0", "MPa", start.normal / 1e6, -traction[0] / 1e6, kExact);
        report.compare("τ0", "MPa", start.shear / 1e6, traction.tail<2>().norm() / 1e6, kExact);
        report.compare("χ0", "", start.shear / start.normal / std::tan(state.friction_angle),
                       run.fields.front().critical_index[node], kExact);
        const double critical = critical_depletion(state);
        report.compare("critical depletion, extrapolated from stick", "MPa", critical / 1e6,
                       extrapolated_onset(run, state.friction_angle) / 1e6, kExact);
        // The same by bracketing: one step to just below, one to just above.
        for (const double factor : {1 - 1e-6, 1 + 1e-6}) {
          const SceneRun at =
              runner.run(file, {{"/stages/0/pressure_change", concat(-critical * factor, " Pa")},
                                {"/stages/0/steps", "4"}});
          const bool slips = at.fields.back().jump.cwiseAbs().maxCoeff() > 0;
          report.holds(concat(factor < 1 ? "sticks a millionth below" : "slips a millionth above"),
                       slips == (factor > 1));
        }
      }};
}

}  // namespace

std::vector<VerifyCase> depletion_cases() {
  return {compaction_case(), geertsma_case(), initial_state_case(), onset_case()};
}

}  // namespace faultsim
