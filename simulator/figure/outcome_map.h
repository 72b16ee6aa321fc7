#pragma once

#include <array>
#include <string>
#include <vector>

#include "simulator/common/words.h"
#include "simulator/figure/axis.h"
#include "simulator/figure/svg.h"

namespace faultsim::figure {

/// What became of a case, from good to bad; each has a shape and a colour of its own.
/// Undecided: the cells do not resolve whether a fault slides, or its event.
enum class CaseClass { holds, undecided, slides, event, ended_early };
inline constexpr int kCaseClasses = 5;
constexpr auto words(CaseClass) {
  return std::array{"no fault slides", "undecided by the cells", "slides, no event", "slip event",
                    "ended early"};
}

/// Cases of a campaign over two of its parameters. Up to kMostDots cases are dots; more are counted
/// in squares coloured by the share that slides of those that are decided, so that the drawing's
/// size has a bound; a stroke crosses squares of which most are not.
struct OutcomeMap {
  std::string title, remark;
  std::string x_label, y_label;  ///< with units.
  std::vector<double> x, y;
  std::vector<CaseClass> kind;
  std::vector<std::string> x_words = {}, y_words = {};  ///< of parameters that are words: names of
                                                        ///< 0, 1, …; empty = numbers.
};
inline constexpr std::size_t kMostDots = 3000;
std::string draw(const OutcomeMap& map);

}  // namespace faultsim::figure
