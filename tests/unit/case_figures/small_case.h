#pragma once

#include <string>

#include "simulator/case_figures/case_figures.h"
#include "simulator/common/errors.h"
#include "simulator/documents/json_document.h"
#include "simulator/reading/read_scene.h"

namespace faultsim {

/// Two blocks, west and east of x = 0, between three upright faults; the east lies 150 m deeper.
inline Scene field_scene() {
  Scene scene =
      read_scene(read_json_file(FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend.json"));
  scene.field.blocks[1].offset = 150;
  return scene;
}

/// Three steps in two stages on three faults; χ̄ of F2 is 1 in steps 1 and 2, its area grows.
inline CaseResult small_result() {
  CaseResult result;
  result.title = "a <small> case";
  result.outcome = Outcome::converged;
  result.plane_strain = true;
  result.fault_names = {"F1", "F2", "F3"};
  result.region_names = {"west", "east"};
  constexpr double kFiveYears = 5 * 365.25 * 86400;
  for (int k = 0; k < 3; ++k) {
    StepResult step;
    step.step = k;
    step.stage = k == 0 ? "initial" : k == 1 ? "primary_production" : "gas_storage";
    step.time = k * kFiveYears;
    step.outcome = Outcome::converged;
    step.pressure_change = {-k * 1e7, -k * 5e6};
    step.faults.resize(3);
    step.faults[0].chi_bar = 0.3 * k;
    step.faults[1].chi_bar = k == 0 ? 0.2 : 1 + (k == 1 ? 1e-9 : 0);
    step.faults[1].area_chi_080 = 100.0 * k;
    result.steps.push_back(step);
  }
  return result;
}

inline std::string message_of(const CasePicture& picture, const CaseChartRequest& request) {
  try {
    draw_case(picture, request);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace faultsim
