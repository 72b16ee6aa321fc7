#pragma once

#include <nlohmann/json.hpp>

#include "simulator/case_figures/case_figures.h"

namespace faultsim {

/// step_looks as a page's script reads them: of each load step {"step", "time", "says", "chi",
/// "notes"}, of painted sections "painted"; the first has "chi_colours" and, of painted sections,
/// "scale". @pre the scene is a field.
nlohmann::json steps_json(const CasePicture& picture);

}  // namespace faultsim
