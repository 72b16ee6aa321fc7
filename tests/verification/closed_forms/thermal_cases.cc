// V12: rock that is cooled, as a confined layer and as a disc in a half space.
#include <algorithm>
#include <cmath>

#include "tests/verification/closed_forms/elastic_solutions.h"
#include "tests/verification/closed_forms/verify_cases.h"

namespace faultsim {
namespace {

constexpr double kExpansion = 1e-5, kCooling = -30;  // 1/K, K

/// A scene of V2 that is cooled instead of depleted.
Settings cooled(const std::string& material) {
  return {{"/stages/0/pressure_change", "0 MPa"},
          {"/stages/0/temperature_change", "-30 K"},
          {"/materials/" + material + "/thermal_expansion", "1e-5 1/K"}};
}

VerifyCase layer_case() {
  const char file[] = "v2_compaction.json";
  return {"V12-layer",
          "a confined layer that is cooled",
          {file},
          false,
          [=](SceneRunner& runner, VerifyReport& report) {
            const SceneRun run = runner.run(file, cooled("reservoir"));
            const Material& rock = material_named(run.scene, "reservoir");
            const double nu = rock.poisson_ratio, strain = kExpansion * kCooling;
            const std::vector<Layer>& layers = run.scene.box.layers;
            const double thickness = layers[2].top_depth - layers[1].top_depth;
            report.compare("displacement of the surface", "m",
                           strain * thickness * (1 + nu) / (1 - nu), run.observed("surface.z", 1),
                           1e-9);
            const double change = -rock.youngs_modulus * strain / (1 - nu);
            double worst = change;
            for (Eigen::Index k = 0; k < run.fields[0].traction.cols(); ++k) {
              const double depth = -run.geometry().nodes[static_cast<std::size_t>(k)].position.z();
              const double margin = 1e-6;
              if (depth < layers[1].top_depth + margin || depth > layers[2].top_depth - margin)
                continue;
              const double computed = run.fields[1].traction(0, k) - run.fields[0].traction(0, k);
              if (std::abs(computed - change) > std::abs(worst - change)) worst = computed;
            }
            report.compare("Δσ_h in the layer, worst node", "MPa", change / 1e6, worst / 1e6, 1e-9);
          }};
}

VerifyCase disc_case() {
  const char file[] = "v2_geertsma_disc.json";
  return {"V12-disc",
          "subsidence above a cold disc, half space",
          {file},
          false,
          [=](SceneRunner& runner, VerifyReport& report) {
            const SceneRun run = runner.run(file, cooled("rock"));
            const Material& rock = run.scene.materials.front();
            const PressureRegion& region = run.scene.box.regions.front();
            // Geertsma's disc with α Δp replaced by 3 K α_T ΔT.
            const double stress =
                rock.youngs_modulus / (1 - 2 * rock.poisson_ratio) * kExpansion * kCooling;
            const GeertsmaDisc disc{
                rock.youngs_modulus, rock.poisson_ratio, 1, stress, region.thickness,
                region.radius,       -region.center[2]};
            const double scale = std::abs(geertsma_centre_displacement(disc));
            for (const ObservationPoint& point : run.scene.output.observation_points) {
              const std::string row = point.name + ".z";
              const double r = run.observed_position(row).head<2>().norm();
              report.compare("u_z at r = " + short_number(r) + " m (error of the centre's)", "m",
                             geertsma_surface_displacement(disc, r), run.observed(row, 1), 0.02,
                             scale);
            }
          }};
}

}  // namespace

std::vector<VerifyCase> thermal_cases() { return {layer_case(), disc_case()}; }

}  // namespace faultsim
