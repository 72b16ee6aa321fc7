#pragma once

#include <optional>
#include <string>

#include "simulator/case_figures/case_figures.h"

namespace faultsim::python {

/// A chart of a case as SVG, all said by words. Throws InputError for a chart, fault, step or field
/// that is not there.
std::string drawn_case(const CasePicture& picture, const std::string& chart,
                       const std::string& fault, std::optional<int> step, const std::string& show);

}  // namespace faultsim::python
