#pragma once

#include <string>

#include "campaign/answers/sample.h"
#include "campaign/query/verdict_columns.h"
#include "campaign/statistics/intervals.h"

/// How often something holds among rows of which some are undecided.
namespace faultsweep {

struct ShareCounts {
  long n = 0;            ///< rows.
  long n_yes = 0;        ///< for certain.
  long n_undecided = 0;  ///< by cells or the stated error, whatever came out.
  long n_holds = 0;      ///< as computed: n_yes and the undecided ones that came out so.
  long n_unknown = 0;    ///< without a history to its end.

  void add(Held held);
  long n_known() const { return n - n_unknown; }
  /// n_holds of the n_known; NaN where there are none.
  double estimate() const;
};

/// Of a random sample: Clopper and Pearson's lower bound of the share as if all that is open were
/// no, and their upper one as if it were yes. They cover the share that exact cells would give,
/// however what is undecided turns out, with at least `confidence`: each end is short of it with
/// half of the rest. Of other designs the two shares themselves: there is no sample, and no bound.
Interval bounds_of(const ShareCounts& counts, const Sampling& sampling, double confidence);
/// Half the distance between Clopper and Pearson's bounds of what was computed: the part of it that
/// the number of cases makes. NaN where there is no sample, or nothing is known.
double by_number(const ShareCounts& counts, const Sampling& sampling, double confidence);

/// "26,600 of 100,000 cases, 26.6 % (17.8 to 37.2 %: ± 0.3 by the number of cases, 19,400 undecided
/// by the cells, 12 without a full history)"; of what is no sample and not open "24 of 90
/// cases, 26.7
/// %"; "not known".
std::string share_sentence(const ShareCounts& counts, const Sampling& sampling, double confidence);
/// 100000 as "100,000".
std::string grouped(long count);

}  // namespace faultsweep
