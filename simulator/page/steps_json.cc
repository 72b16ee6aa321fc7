#include "simulator/page/steps_json.h"

namespace faultsim {

nlohmann::json steps_json(const CasePicture& picture) {
  nlohmann::json steps = nlohmann::json::array();
  for (const StepLook& look : step_looks(picture)) {
    nlohmann::json notes = nlohmann::json::object();
    for (const auto& [name, note] : look.notes) notes[name] = note;
    steps.push_back({{"step", look.step},
                     {"time", look.time},
                     {"says", look.says},
                     {"colours", look.colours},
                     {"notes", notes}});
  }
  return steps;
}

}  // namespace faultsim
