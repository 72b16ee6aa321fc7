#include "campaign/rounds/staged_sample.h"

#include <algorithm>
#include <cmath>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/statistics/intervals.h"

namespace faultsweep {

namespace {

std::string percent(double probability) { return formatted("%.1f", 100 * probability); }

struct SampleCounts {
  long n = 0;            ///< samples.
  long n_yes = 0;        ///< however what is undecided turns out.
  long n_holds = 0;      ///< as computed.
  long n_undecided = 0;  ///< by cells or stated errors.
  long n_unknown = 0;    ///< failed, or ended early.

  long n_known() const { return n - n_unknown; }
  bool is_open() const { return n_undecided + n_unknown > 0; }
};

SampleCounts count_of(const std::vector<RowAnswers>& answers) {
  SampleCounts counts;
  for (const RowAnswers& one : answers) {
    const Held held = one.held.at(0);
    ++counts.n;
    counts.n_yes += held == Held::yes ? 1 : 0;
    counts.n_holds += held == Held::yes || held == Held::undecided_yes ? 1 : 0;
    counts.n_undecided += held == Held::undecided_yes || held == Held::undecided_no ? 1 : 0;
    counts.n_unknown += held == Held::unknown ? 1 : 0;
  }
  return counts;
}

/// "41.8 to 76.1 % (confidence 95.0 %): true in 61 of 100, undecided in 15, not known in 3; ± 9.9 %
/// by the number of cases".
std::string sentence(const SampleCounts& counts, double confidence, double width_by_number) {
  const Interval all =
      proportion_bounds(counts.n_yes, counts.n_undecided + counts.n_unknown, counts.n, confidence);
  std::string text = concat(percent(all.low), " to ", percent(all.high), " % (confidence ",
                            percent(confidence), " %): true in ", counts.n_holds, " of ", counts.n);
  if (counts.n_undecided > 0) text += concat(", undecided in ", counts.n_undecided);
  if (counts.n_unknown > 0) text += concat(", not known in ", counts.n_unknown);
  return counts.is_open() && counts.n_known() > 0
             ? concat(text, "; ± ", percent(0.5 * width_by_number), " % by the number of cases")
             : text;
}

}  // namespace

Proposal StagedSampler::propose(const std::vector<RowAnswers>& answers,
                                const std::vector<ordered_json>& designs) const {
  long n_drawn = 0;  // with those that were excluded
  for (const ordered_json& design : designs) n_drawn += design.at("samples").get<long>();
  const SampleCounts counts = count_of(answers);
  const Interval bounds = proportion_bounds(counts.n_holds, counts.n_known(), wanted_.confidence);
  const double width = bounds.high - bounds.low;
  const std::string text = sentence(counts, wanted_.confidence, width);
  const std::string wide = concat("; ", counts.is_open() ? "that alone is " : "", "wider than ",
                                  percent(wanted_.width), " %");
  if (counts.n_known() == 0) return {nullptr, text + "; no case has a full history"};
  if (width <= wanted_.width) {
    return {nullptr, counts.is_open() ? text +
                                            "; the rest is due to cases that are not decided, "
                                            "and further ones would not change that"
                                      : text};
  }
  if (n_drawn >= wanted_.most)
    return {nullptr, concat(text, wide, ", but ", wanted_.most, " samples are the most")};
  // Between none and all there is at least one of each kind to come.
  const double p =
      (static_cast<double>(counts.n_holds) + 1) / (static_cast<double>(counts.n_known()) + 2);
  const long missing =
      samples_for_half_width(p, 0.5 * wanted_.width, wanted_.confidence) - counts.n_known();
  const long most = std::min(n_drawn, wanted_.most - n_drawn);
  const long n_more = std::min(most, std::max(n_drawn / 10 + 1, missing));
  ordered_json design = designs.front();
  design["first"] = design.value("first", 0L) + n_drawn;
  design["samples"] = n_more;
  return {std::move(design), text + wide};
}

ordered_json StagedSampler::spec_of_round(ordered_json spec, const ordered_json& design) const {
  spec["design"] = design;
  spec.erase("rounds");
  return spec;
}

}  // namespace faultsweep
