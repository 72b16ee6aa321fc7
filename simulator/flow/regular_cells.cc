#include "simulator/flow/regular_cells.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "simulator/common/errors.h"
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

using Reach = std::array<double, 2>;

/// The cells of which all centres are the middles, empty where there are none that tile the line.
/// Borders are e_i = a_i + s_i d with e_(i+1) = 2 c_i - e_i, so s_i = 1, -1, 1, ...
std::vector<Reach> side_by_side(const std::vector<double>& centre) {
  constexpr double kLeast = 0.02;  // of the gap: a border is no nearer to a centre
  double low = -HUGE_VAL, high = HUGE_VAL, border = centre[0], sign = 1;
  std::vector<double> fixed{border}, wanted;
  for (std::size_t i = 0; i < centre.size(); ++i, sign = -sign) {
    border = 2 * centre[i] - border;
    fixed.push_back(border);
    if (i + 1 == centre.size()) break;
    const double gap = centre[i + 1] - centre[i];
    // centre_i < fixed - sign d < centre_(i+1)
    const double one = sign * (border - centre[i] - kLeast * gap),
                 other = sign * (border - centre[i + 1] + kLeast * gap);
    low = std::max(low, std::min(one, other));
    high = std::min(high, std::max(one, other));
    wanted.push_back(sign * (border - centre[i] - 0.5 * gap));
  }
  if (!(low < high)) return {};
  const auto middle = wanted.begin() + std::ssize(wanted) / 2;
  std::nth_element(wanted.begin(), middle, wanted.end());
  const double d = std::clamp(*middle, low, high);
  std::vector<Reach> reach;
  for (std::size_t i = 0; i < centre.size(); ++i) {
    const double s = i % 2 == 0 ? d : -d;
    reach.push_back({fixed[i] + s, fixed[i + 1] - s});
  }
  return reach;
}

/// Cells as wide as the smallest gap, empty where most are wider or some are no multiples of it.
std::vector<Reach> with_holes(const std::vector<double>& centre) {
  constexpr double kSame = 0.01;
  double size = HUGE_VAL;
  for (std::size_t i = 1; i < centre.size(); ++i) size = std::min(size, centre[i] - centre[i - 1]);
  std::size_t n_smallest = 0;
  for (std::size_t i = 1; i < centre.size(); ++i) {
    const double n = (centre[i] - centre[i - 1]) / size;
    if (std::abs(n - std::round(n)) > kSame) return {};
    if (std::round(n) == 1) ++n_smallest;
  }
  if (2 * n_smallest < centre.size()) return {};
  std::vector<Reach> reach;
  for (const double c : centre) reach.push_back({c - 0.5 * size, c + 0.5 * size});
  return reach;
}

std::vector<Reach> half_way(const std::vector<double>& centre) {
  std::vector<Reach> reach;
  const std::size_t last = centre.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    const double low = i > 0 ? centre[i] - centre[i - 1] : centre[1] - centre[0];
    const double high = i < last ? centre[i + 1] - centre[i] : low;
    reach.push_back({centre[i] - 0.5 * low, centre[i] + 0.5 * high});
  }
  return reach;
}

std::vector<Reach> uneven_line(const std::vector<double>& centre, double single) {
  if (centre.size() == 1) return {{centre[0] - 0.5 * single, centre[0] + 0.5 * single}};
  std::vector<Reach> reach = side_by_side(centre);
  if (reach.empty()) reach = with_holes(centre);
  return reach.empty() ? half_way(centre) : reach;
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

std::vector<Reach> uneven_cells(const std::vector<int>& line, const std::vector<double>& at) {
  std::map<int, std::vector<double>> centres;
  for (std::size_t i = 0; i < at.size(); ++i) centres[line[i]].push_back(at[i]);
  std::vector<double> gaps;
  for (auto& [number, of_line] : centres) {
    std::ranges::sort(of_line);
    drop_repeated(of_line);
    for (std::size_t i = 1; i < of_line.size(); ++i) gaps.push_back(of_line[i] - of_line[i - 1]);
  }
  FAULTSIM_DEMAND(!gaps.empty(), "single centres");
  const auto middle = gaps.begin() + std::ssize(gaps) / 2;
  std::nth_element(gaps.begin(), middle, gaps.end());
  std::map<int, std::vector<Reach>> reach;
  for (const auto& [number, of_line] : centres) reach[number] = uneven_line(of_line, *middle);
  std::vector<Reach> all;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const std::vector<double>& of_line = centres[line[i]];
    const auto place = std::ranges::lower_bound(of_line, at[i]) - of_line.begin();
    all.push_back(reach[line[i]][static_cast<std::size_t>(place)]);
  }
  return all;
}

std::vector<Reach> touching_cells(const std::vector<double>& centre) {
  const std::vector<Reach> reach = side_by_side(centre);
  return reach.empty() ? half_way(centre) : reach;
}

}  // namespace faultsim
