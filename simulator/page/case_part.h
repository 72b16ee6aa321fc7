#pragma once

#include "simulator/case_figures/case_figures.h"
#include "simulator/page/html_page.h"

namespace faultsim {

/// A case on a page step by step: of a field the section across it and χ̄ against time with one
/// slider over the load steps, of a box χ̄ against time.
/// @param number  tells cases of one page apart.
void add_case_steps(HtmlPage& page, const CasePicture& picture, long number);

/// The same and, where fields were kept, profiles, the map and the stress path of the most critical
/// fault.
void add_case_part(HtmlPage& page, const CasePicture& picture, long number);

}  // namespace faultsim
