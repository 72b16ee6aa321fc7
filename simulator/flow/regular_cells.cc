#include "simulator/flow/regular_cells.h"

#include <algorithm>
#include <utility>

#include "simulator/common/ranges.h"
#include "simulator/common/text.h"

namespace faultsim {
namespace {

using Centre = std::pair<int, double>;  ///< line, place on it.

std::string metres(double length) { return formatted("%.10g m", length); }

std::string gap_text(const Centre& from, const Centre& to) {
  return "from " + metres(from.second) + " to " + metres(to.second);
}

/// The first of the two centres with the smallest and with the largest gap between neighbours of a
/// line; both the end where no line has two.
struct Gaps {
  std::size_t smallest, largest;
};
Gaps gaps_of(const std::vector<Centre>& centres) {
  Gaps gaps{centres.size(), centres.size()};
  const auto gap = [&](std::size_t i) { return centres[i + 1].second - centres[i].second; };
  for (std::size_t i = 0; i + 1 < centres.size(); ++i) {
    if (centres[i].first != centres[i + 1].first) continue;
    if (gaps.smallest == centres.size()) gaps = {i, i};
    if (gap(i) < gap(gaps.smallest)) gaps.smallest = i;
    if (gap(i) > gap(gaps.largest)) gaps.largest = i;
  }
  return gaps;
}

}  // namespace

CellReach regular_cells(const std::vector<int>& line, const std::vector<double>& at) {
  constexpr double kSame = 1.01;  // centres are written to some digits
  std::vector<Centre> centres;
  for (std::size_t i = 0; i < at.size(); ++i) centres.emplace_back(line[i], at[i]);
  std::ranges::sort(centres);
  drop_repeated(centres);
  const Gaps gaps = gaps_of(centres);
  if (gaps.smallest == centres.size())
    return {{}, "has a single value, " + metres(at.front()) + ", and no neighbour beside it", 0};
  const auto gap = [&](std::size_t i) { return centres[i + 1].second - centres[i].second; };
  const double spacing = gap(gaps.smallest);
  if (gap(gaps.largest) > kSame * spacing) {
    const Centre& odd = centres[gaps.largest + 1];
    std::size_t cell = 0;
    while (Centre(line[cell], at[cell]) != odd) ++cell;
    return {{},
            "goes " + gap_text(centres[gaps.largest], odd) + ", and elsewhere " +
                gap_text(centres[gaps.smallest], centres[gaps.smallest + 1]),
            cell};
  }
  CellReach cells;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Centre own(line[i], at[i]);
    const auto place = std::ranges::lower_bound(centres, own) - centres.begin();
    const auto k = static_cast<std::size_t>(place);
    const bool has_low = k > 0 && centres[k - 1].first == own.first;
    const bool has_high = k + 1 < centres.size() && centres[k + 1].first == own.first;
    const double high = has_high ? 0.5 * gap(k) : has_low ? 0.5 * gap(k - 1) : 0.5 * spacing;
    const double low = has_low ? 0.5 * gap(k - 1) : high;
    cells.reach.push_back({own.second - low, own.second + high});
  }
  return cells;
}

}  // namespace faultsim
