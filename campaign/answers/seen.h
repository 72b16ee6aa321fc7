#pragma once

#include <optional>
#include <string>
#include <vector>

#include "campaign/answers/shares.h"
#include "campaign/query/selection.h"
#include "campaign/statistics/weighted.h"
#include "campaign/store/store.h"

/// What was seen in the field, as statements of which each case of a campaign says how likely they
/// are. A statement is one of
///
///   F2 slid before 8 yr +- 0.5 yr
///   F2 did not slide before 8 yr +- 0.5 yr
///   event of Mw 3 +- 0.2 on F2 between -120 bar and -80 bar +- 5 bar
///   no event of Mw 3 +- 0.2 on F2
///   max_slip = 20 mm +- 5 mm            any metric of `rank --list-metrics`, of a fault or stage
///   too F2.slides in gas_storage, wrong 0.1 any condition, and how likely the report of it is
///   wrong
///
/// Errors are standard deviations of normal ones; a statement without one is taken to be exact.
/// "before" counts from the start of the history, "Mw 3" is 3 or larger, and pressures are changes
/// since the start, on the side of the fault that changed more. Names of faults may stand in
/// quotes, as in expressions.
namespace faultsweep {

struct SeenStatement {
  enum class Kind { slid, event, metric, condition };
  std::string text;
  Kind kind = Kind::condition;
  bool denied = false;             ///< "did not slide", "no event".
  std::int64_t fault = 0;          ///< id, of slid and event.
  double value = 0;                ///< time (s), magnitude, metric (SI); of a condition unused.
  double error = 0;                ///< of that; of a condition how likely it is wrong. 0 = exact.
  std::optional<double> from, to;  ///< Pa, ascending: where the event was.
  double range_error = 0;          ///< Pa, of each of them.
  SqlFragment column = {};         ///< of a metric.
  std::string condition = {};
  bool is_exact() const { return error == 0 && range_error == 0; }
};

/// Throws InputError that lists every statement which cannot be read, with the forms there are, or
/// has more than 2000 bytes.
std::vector<SeenStatement> read_seen(const std::vector<std::string>& statements,
                                     const CampaignInfo& campaign, const Selection& selection);

/// What a case did, as far as statements ask for it.
struct CaseHistory {
  std::vector<CaseOnsets::Onset> onsets;  ///< of the whole history.
  std::vector<SeenEvent> events;
  std::vector<std::int64_t> unresolved;  ///< faults of which it is open whether they slide.
  bool events_resolved = true;           ///< the sizes of its events do not depend on the cells.
};

/// P(statement | case), in [0, 1]; of a metric relative to that of a case which has the value. With
/// Φ the normal distribution function, T when the fault begins to slide (∞ = never), M and p those
/// of an event:
///
///   slid before t ± σ     Φ((t − T) / σ)
///   event of M0 ± σ       1 − Π over events of (1 − Φ((M − M0) / σ) (Φ((to − p)/s) − Φ((from −
///   p)/s))) y = d ± σ             exp(−½ ((y − d) / σ)²); 0 where the case has no value condition,
///   wrong w    1 − w where it is true, w where not
///
/// what is denied is 1 less that.
/// @param value  of a metric; of a condition 1 where it is true. Unused of slid and event.
/// @pre each event of the statement's fault has a magnitude.
double likelihood(const SeenStatement& statement, const CaseHistory& history, double value);

/// Between what it lies with what the cells of a full history leave open: a fault began to slide
/// somewhere within its load step, and what is not resolved may be either.
/// @param held  of a condition.
/// @pre as likelihood.
WeightRange likelihood_by_cells(const SeenStatement& statement, const CaseHistory& history,
                                double value, Held held);

/// Between what P(statement | case) lies of a case whose history ends early: what it did up to
/// there is known, and anything may follow.
/// @pre as likelihood.
WeightRange likelihood_range(const SeenStatement& statement, const CaseHistory& history);

}  // namespace faultsweep
