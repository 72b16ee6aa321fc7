#pragma once

#include "simulator/case_figures/case_figures.h"
#include "simulator/page/html_page.h"

namespace faultsim {

/// A case on a page: of a field the section across it and χ̄ against time with one slider over the
/// load steps; where fields were kept profiles, the map and the stress path of the most critical
/// fault.
/// @param number  tells cases of one page apart.
void add_case_part(HtmlPage& page, const CasePicture& picture, long number);

}  // namespace faultsim
