#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "simulator/contact/search_record.h"

namespace faultsim {

/// What was tried at a part of a load step, for the screen: a heading with the verdict, and per
/// search a row for each iteration (docs/trace.md).
std::string trace_text(int step, const SubStepTrace& trace);
/// The same as an object; a residual that was not formed is null.
nlohmann::json trace_to_json(int step, const SubStepTrace& trace);

}  // namespace faultsim
