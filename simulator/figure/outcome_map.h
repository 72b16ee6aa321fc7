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

/// Cases of a campaign over two of its parameters. Where no two lie over each other, each is a mark
/// of its class. Else they are counted in cells, one for each value of a parameter that has few, so
/// that none is hidden and the drawing's size has a bound: a cell has the colour of the share that
/// slides of those that are decided, is hatched in the share that is undecided, and says the share
/// where there is room. A line, the limit, separates cells in which nothing slides, nor may, from
/// the others, and the drawing says from how many decided cases on a cell counts (`limit_line`).
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
