#include "campaign/answers/shares.h"

#include <limits>

#include "campaign/common/names.h"
#include "campaign/render/shown.h"

namespace faultsweep {

void ShareCounts::add(Held held) {
  ++n;
  n_yes += held == Held::yes ? 1 : 0;
  n_holds += held == Held::yes || held == Held::undecided_yes ? 1 : 0;
  n_undecided += held == Held::undecided_no || held == Held::undecided_yes ? 1 : 0;
  n_unknown += held == Held::unknown ? 1 : 0;
}

double ShareCounts::estimate() const {
  return n_known() == 0 ? std::numeric_limits<double>::quiet_NaN()
                        : static_cast<double>(n_holds) / static_cast<double>(n_known());
}

Interval bounds_of(const ShareCounts& counts, const Sampling& sampling, double confidence) {
  const long n_open = counts.n_undecided + counts.n_unknown;
  if (sampling.is_random) return proportion_bounds(counts.n_yes, n_open, counts.n, confidence);
  const auto n = static_cast<double>(counts.n);
  return {static_cast<double>(counts.n_yes) / n, static_cast<double>(counts.n_yes + n_open) / n};
}

double by_number(const ShareCounts& counts, const Sampling& sampling, double confidence) {
  if (!sampling.is_random || counts.n_known() == 0) return std::numeric_limits<double>::quiet_NaN();
  const Interval bounds = proportion_bounds(counts.n_holds, counts.n_known(), confidence);
  return 0.5 * (bounds.high - bounds.low);
}

std::string grouped(long count) {
  std::string text = std::to_string(count);
  for (auto at = static_cast<long>(text.size()) - 3; at > (count < 0 ? 1 : 0); at -= 3)
    text.insert(static_cast<std::size_t>(at), ",");
  return text;
}

std::string share_sentence(const ShareCounts& counts, const Sampling& sampling, double confidence) {
  if (counts.n_known() == 0) return "not known";
  const Interval bounds = bounds_of(counts, sampling, confidence);
  const bool is_open = counts.n_undecided + counts.n_unknown > 0;
  const std::string range =
      concat(format_percent(bounds.low), " to ", format_percent(bounds.high), " %");
  std::string why;
  const auto add = [&](const std::string& part) { why += (why.empty() ? ": " : ", ") + part; };
  if (sampling.is_random && is_open)
    add(concat("± ", format_percent(by_number(counts, sampling, confidence), 2),
               " by the number of cases"));
  if (counts.n_undecided > 0) add(grouped(counts.n_undecided) + " undecided by the cells");
  if (counts.n_unknown > 0) add(grouped(counts.n_unknown) + " without a full history");
  return concat(grouped(counts.n_holds), " of ", grouped(counts.n_known()), " cases, ",
                format_percent(counts.estimate()), " %",
                sampling.is_random || is_open ? concat(" (", range, why, ")") : "");
}

}  // namespace faultsweep
