#include "campaign/rounds/staged_sample.h"

#include <algorithm>
#include <cmath>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/statistics/intervals.h"

namespace faultsweep {

namespace {

std::string percent(double probability) { return formatted("%.1f", 100 * probability); }

}  // namespace

Proposal StagedSampler::propose(const std::vector<RowAnswers>& answers,
                                const std::vector<ordered_json>& designs) const {
  long n_drawn = 0;  // with those that were excluded
  for (const ordered_json& design : designs) n_drawn += design.at("samples").get<long>();
  const auto n = static_cast<long>(answers.size());
  const long n_holds =
      std::ranges::count_if(answers, [](const RowAnswers& one) { return one.holds.at(0); });
  const long n_unknown =
      std::ranges::count_if(answers, [](const RowAnswers& one) { return !one.complete; });
  const Interval known = proportion_bounds(n_holds, n_unknown, n, wanted_.confidence);
  std::string text = concat(percent(known.low), " to ", percent(known.high), " % (confidence ",
                            percent(wanted_.confidence), " %): true in ", n_holds, " of ", n);
  if (n_unknown > 0) text += concat(", not known in ", n_unknown);
  if (known.high - known.low <= wanted_.width) return {nullptr, text};
  if (n_drawn >= wanted_.most) {
    return {nullptr, concat(text, "; wider than ", percent(wanted_.width), " %, but ", wanted_.most,
                            " samples are the most")};
  }
  // Between none and all there is at least one of each kind to come.
  const double p = (static_cast<double>(n_holds) + 1) / (static_cast<double>(n) + 2);
  const long missing = samples_for_half_width(p, 0.5 * wanted_.width, wanted_.confidence) - n;
  const long most = std::min(n_drawn, wanted_.most - n_drawn);
  const long n_more = std::min(most, std::max(n_drawn / 10 + 1, missing));
  ordered_json design = designs.front();
  design["first"] = design.value("first", 0L) + n_drawn;
  design["samples"] = n_more;
  return {std::move(design), concat(text, "; wider than ", percent(wanted_.width), " %")};
}

ordered_json StagedSampler::spec_of_round(ordered_json spec, const ordered_json& design) const {
  spec["design"] = design;
  spec.erase("rounds");
  return spec;
}

}  // namespace faultsweep
