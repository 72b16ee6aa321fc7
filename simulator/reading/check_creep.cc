#include <cmath>
#include <string>

#include "simulator/initial_state/initial_state.h"
#include "simulator/initial_state/on_fault.h"
#include "simulator/reading/scene_reader.h"

/// What a scene says about creep must have something to act on. A viscosity that was refused reads
/// as NaN, which counts as one: its mistake is not reported twice.
namespace faultsim {
namespace {

const char* const kAddViscosity =
    "add for example \"viscosity\": \"1e17 Pa s\" to the material of the salt, or remove this line";

void check_switch(SceneReader& reader, const Scene& scene) {
  if (scene.numerics.creep != Switch::on || has_viscous_material(scene)) return;
  reader.problem("/numerics/creep", "nothing in the model is made of a material with a viscosity",
                 kAddViscosity);
}

void check_initial_state(SceneReader& reader, const Scene& scene) {
  if (scene.initial.viscous_layers != ViscousLayers::lithostatic) return;
  const std::string at = "/initial_state/viscous_layers";
  if (scene.initial.tensor) {
    reader.problem(at, "the uniform \"tensor\" is the stress of viscous layers too",
                   "remove one of the two");
  } else if (!has_viscous_layer(scene)) {
    reader.problem(at, "no layer is made of a material with a viscosity", kAddViscosity);
  }
}

/// Bounds the loop over the steps of creep within a load step.
void check_time_step(SceneReader& reader, const Scene& scene) {
  const std::string at = "/numerics/creep_time_step";
  if (!reader.has(at)) return;
  if (reader.has("/numerics/creep_refinements")) {
    reader.problem("/numerics/creep_refinements", "has no effect alongside \"creep_time_step\"",
                   "remove one of the two");
  }
  if (!reader.sound("/stages")) return;
  double longest = 0;
  for (const Stage& stage : scene.stages) {
    longest = std::fmax(longest, stage.duration / stage.n_steps);
  }
  constexpr double kMost = 10000;
  const double n_steps = longest / scene.numerics.creep_time_step;
  if (!(n_steps > kMost)) return;
  reader.problem(at,
                 concat("a load step of ", in_unit(longest, Dimension::time, "year"),
                        " would take more than 10000 steps of creep"),
                 "write at least " + in_unit(std::ceil(longest / kMost), Dimension::time, "s"));
}

}  // namespace

void check_creep(SceneReader& reader, const Scene& scene) {
  check_time_step(reader, scene);
  for (const char* part : {"/geometry", "/materials"}) {
    if (!reader.has(part) || !reader.sound(part)) return;
  }
  if (!is_body_known(reader, scene)) return;  // nor what it is made of
  check_switch(reader, scene);
  check_initial_state(reader, scene);
}

void find_openings(Scene& scene) {
  scene.opens_at_start = false;
  if (scene.numerics.creep != Switch::automatic || !has_viscous_material(scene)) return;
  for (std::size_t fault = 0; fault < scene.faults.size(); ++fault)
    scene.opens_at_start = scene.opens_at_start || initial_opening(scene, fault) > 0;
}

}  // namespace faultsim
