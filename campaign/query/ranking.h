#pragma once

#include <optional>
#include <string>

#include "campaign/query/place_columns.h"
#include "campaign/query/selection.h"
#include "campaign/render/answer.h"
#include "campaign/store/store.h"

namespace faultsweep {

/// What `faultsweep rank` was asked.
struct RankRequest {
  std::string by = {};     ///< metric or expression of numbers; "" = the campaign's own.
  std::string stage = {};  ///< "" = the whole history.
  std::string fault = {};  ///< "" = all faults of a case together.
  std::string where = {};  ///< condition; "" = all cases.
  bool ascending = false;  ///< smallest first.
  long top = 20;           ///< 0 = all.
  /// Rows left out before the first one, of a ranking in pages: all rows are counted.
  std::optional<long> skip = {};
};

/// How many cases slide, as far as the cells tell.
struct SlidingCounts {
  long n_cases = 0;       ///< with a result in the stage.
  long n_slide = 0;       ///< in their results, resolved or not.
  long n_unresolved = 0;  ///< of those that slide: it depends on the cells.
  long n_perhaps = 0;     ///< that do not slide, which depends on the cells too.
  void add(bool slides, bool is_resolved);
};

/// A ranking: complete histories first, then those with unresolved events, whose size is the
/// mesh's, then unstable cases, then those that ended early otherwise.
struct Ranking {
  CampaignInfo campaign;
  RankRequest request;
  std::string extensive = {};  ///< the first area, potency or moment that it goes by; "" = none.
  bool by_default = false;     ///< activated area, open area, M0, pressure margin, χ̄.
  Store::Kinds kinds;          ///< of the cases that are ranked.
  /// The campaign has cases of both kinds and its own order compares areas or moments: only those
  /// in total are ranked.
  bool plane_strain_apart = false;
  std::vector<RankedCase> rows;
  /// Where rows are skipped: how many rows there are in all, by RankedCase::rank_class.
  Store::ClassCounts n_rows = {};
  long n_all() const;  ///< sum of n_rows.
  /// Of all cases that the condition selects; none where the rows are not all of them and the
  /// campaign is so large that counting would take longer than ranking.
  std::optional<SlidingCounts> counts;
  RegionPressures pressures = RegionPressures::at_depth;
  std::string approximation;  ///< approximation_note of the campaign.
  ShownUnit by_unit;          ///< of the scores; plain for expressions, which are in SI.
  /// Measured by `faultsweep tradeoff` for this campaign at its tier; empty where it was not, or
  /// where the campaign has several tiers or meshes of its own.
  std::vector<ErrorBar> error_bars;
};

/// Asks the store. Throws InputError on a wrong expression, an unknown stage or fault, and where
/// `by` would put areas, potencies or moments per metre of strike and in total in one order. Where
/// the campaign's own order would, plane-strain cases are left out.
Ranking make_ranking(const Store& store, const CampaignInfo& campaign, const RankRequest& request);

/// How many cases reports and pages show in pictures: those ranked first in the campaign's own
/// order.
inline constexpr long kShownFirst = 3;
/// The ids of the cases that the campaign's own ranking has first, at most `n`. Throws as
/// make_ranking, of which this is the beginning without what is said beside it.
std::vector<std::int64_t> cases_ranked_first(const Store& store, const CampaignInfo& campaign,
                                             long n = kShownFirst);

/// How many results of a campaign have an interpolated operator or a flow result that covers the
/// compartments in part, with the worst measured errors: what answers over them say. "" = none.
std::string approximation_note(const Store& store, const CampaignInfo& campaign);

std::vector<std::string> tier_names();
/// The tier that all groups of a campaign have, without sizes of their own; "" = there is none.
std::string common_tier(const Store& store, const CampaignInfo& campaign);
/// What `faultsweep tradeoff` measured of the campaign's spec at the tier of its cases; nothing
/// where its scenes have several tiers or a mesh of their own.
std::vector<ErrorBar> error_bars_of(const Store& store, const CampaignInfo& campaign);
/// Within which conditions on results of a campaign are undecided: the largest errors that were
/// measured on its cases; without one of χ̄ the largest that their tier names, of its cells in plane
/// strain.
StatedErrors stated_errors_of(const Store& store, const CampaignInfo& campaign);
/// What a row is about: the case or, where one is ranked, the fault.
faultsim::StageMetrics metrics_of(const RankedCase& row);
const faultsim::Measures& measures_of(const RankedCase& row);
/// Neither whether it slides nor the size of its events depends on the cells.
bool is_resolved(const RankedCase& row);

}  // namespace faultsweep
