#pragma once

#include <string>

#include "campaign/render/answer.h"

namespace faultsweep {

/// A part of a page: paragraphs of class "answer" for the headline, then the blocks; cells read as
/// on the screen and carry the exact number in SI as data-value. No scripts, no styles.
std::string render_html(const Answer& answer);

/// The answer's first chart as SVG; "" where it has none.
std::string first_chart(const Answer& answer);

}  // namespace faultsweep
