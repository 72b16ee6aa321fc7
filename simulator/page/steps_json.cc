#include "simulator/page/steps_json.h"

namespace faultsim {

nlohmann::json steps_json(const CasePicture& picture) {
  nlohmann::json steps = nlohmann::json::array();
  for (const StepLook& look : step_looks(picture)) {
    nlohmann::json notes = nlohmann::json::object();
    for (const auto& [name, note] : look.notes) notes[name] = note;
    nlohmann::json step = {{"step", look.step},
                           {"time", look.time},
                           {"says", look.says},
                           {"chi", look.chi},
                           {"notes", notes}};
    for (const auto& [name, parts] : look.painted) step["painted"][name] = parts;
    if (!look.chi_colours.empty()) step["chi_colours"] = look.chi_colours;
    if (look.scale)
      step["scale"] = {{"colours", look.scale->colours}, {"texts", look.scale->texts}};
    steps.push_back(std::move(step));
  }
  return steps;
}

}  // namespace faultsim
