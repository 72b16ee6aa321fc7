#pragma once

#include <nlohmann/json.hpp>

#include "simulator/case_figures/case_figures.h"

namespace faultsim {

/// step_looks as a page's script reads them: of each load step {"step", "time", "says", "colours",
/// "notes"}, of painted sections "painted" and, the first, "scale". @pre the scene is a field.
nlohmann::json steps_json(const CasePicture& picture);

}  // namespace faultsim
