#include <algorithm>

#include "campaign/answers/limit_words.h"
#include "campaign/common/names.h"
#include "campaign/spec/pointers.h"

namespace faultsweep {

namespace {

namespace figure = faultsim::figure;

constexpr std::size_t kMostRows = 40;  // of a chart: some 800 px

/// What lies between two tried values that follow each other, of which both are known.
figure::RangeFill fill_between(const SearchPoint& a, const SearchPoint& b) {
  if (!a.resolved || !b.resolved) return figure::RangeFill::undecided;
  if (a.state != b.state) return figure::RangeFill::between;
  return a.state == PointState::safe ? figure::RangeFill::good : figure::RangeFill::bad;
}

/// From one end of what was tried to the other; alike pieces beside each other are one. What has a
/// value without a result in it is not known.
std::vector<figure::RangeBars::Range> ranges_of(const LimitFinding& finding,
                                                const LimitSearch& limit) {
  std::vector<figure::RangeBars::Range> ranges;
  const auto add = [&](double from, double to, figure::RangeFill fill) {
    if (from == to) return;
    if (!ranges.empty() && ranges.back().fill == fill) {
      ranges.back().to = to;
    } else {
      ranges.push_back({from, to, fill});
    }
  };
  double last = limit.scan.front();
  const SearchPoint* before = nullptr;
  for (const SearchPoint& one : finding.points) {
    const bool both = before != nullptr && before->state != PointState::unknown &&
                      one.state != PointState::unknown;
    add(last, one.value, both ? fill_between(*before, one) : figure::RangeFill::undecided);
    last = one.value;
    before = &one;
  }
  add(last, limit.scan.back(), figure::RangeFill::undecided);
  return ranges;
}

}  // namespace

std::optional<figure::RangeBars> limit_chart(const LimitTable& table, std::size_t place) {
  const LimitSearch& limit = table.limits.at(place);
  std::vector<std::string> names = table.parameters;
  names.emplace_back("fault");
  figure::RangeBars chart;
  std::size_t n_all = 0;
  for (const LimitRow& row : table.rows) {
    if (!row.cells[place] || ++n_all > kMostRows) continue;
    std::vector<std::string> words = row.settings;
    words.push_back(row.fault);
    chart.rows.push_back({joined(words, ", "),
                          ranges_of(row.cells[place]->finding, limit),
                          {},
                          short_text(*row.cells[place])});
  }
  if (n_all == 0) return std::nullopt;
  chart.title = concat("Values of ", limit.name, " that are safe: ", table.campaign.name);
  chart.label = concat(
      limit.name, limit.unit.empty() ? "" : ", ", limit.unit, " (rows: ", joined(names, ", "),
      n_all > kMostRows ? concat("; the first ", kMostRows, " of ", n_all) : "", ")");
  const auto [low, high] = std::minmax(limit.scan.front(), limit.scan.back());
  constexpr int kTicks = 6;
  if (high > low) chart.axis = figure::axis_between(chart.label, low, high, kTicks);
  chart.key = {"safe", "becomes unsafe within", concat("unsafe: ", limit.unsafe), "",
               "not known, or not resolved by the cells"};
  return chart;
}

}  // namespace faultsweep
