#pragma once

#include <optional>
#include <string>
#include <vector>

#include "campaign/answers/local_slopes.h"
#include "campaign/answers/sensitivity.h"
#include "campaign/query/ranking.h"

/// Why a case stands where it does in a ranking: what happens first, what the parameters do to it
/// near the case and over the campaign, and how sure its place is.
namespace faultsweep {

/// A case that differs from the one asked about in one parameter only.
struct Neighbour {
  std::string parameter;
  std::string from, to;  ///< its value in the case, and in the neighbour, as given.
  RankedCase row;
  double value = 0;   ///< of what is compared (Why::compared), SI; NaN where it has none.
  double change = 0;  ///< of that, neighbour − case.
};

/// A case of a sample that is near the one asked about, in whatever parameters.
struct NearCase {
  RankedCase row;
  double distance = 0;           ///< distances_from of local_slopes.h.
  double value = 0, change = 0;  ///< as of Neighbour.
};

/// The place of a case among those that are ranked with it (its rank class).
struct Place {
  long place = 0, n_ranked = 0;  ///< from 1.
  /// Of what the ranking goes by, at the tier of the campaign: measured for it by `faultsweep
  /// tradeoff`, else of χ̄ what the tier names (n_cases 0); none = not known.
  std::optional<ErrorBar> error;
  /// Cases whose values are the same, or differ by no more than √2 times the rms error (that of a
  /// difference of two independent errors): their order says nothing. Without the case itself.
  std::vector<long> ties;
};

struct Why {
  Ranking ranking;  ///< all rows of the selection.
  StoredCase stored;
  RankedCase row;                  ///< of `ranking`.
  int names = -1;                  ///< index of the parameter that only names cases; -1 = none.
  faultsim::StageMetrics metrics;  ///< of the stage asked for, or the whole history.
  std::string compared;            ///< expression whose changes are listed.
  double value = 0;                ///< of that, SI.
  Place place;
  std::vector<Neighbour> neighbours;  ///< largest |change| first; per parameter the values next to
                                      ///< the case's, of words and variants all.
  /// Where there are no such neighbours, as in random samples: the nearest cases, nearest first,
  /// and the plane through the cases around it.
  std::vector<NearCase> nearest;
  LocalPlane plane;
  std::optional<Sensitivity> global;  ///< of `compared`.
  std::string no_global;              ///< why there is none.
};

/// Compared is what `request.by` or the campaign ranks by; of the default order the area that
/// slides, or χ̄ where nothing of the case slides.
/// Throws InputError as make_ranking, and where the case has no result or the condition leaves it
/// out. Cost: one ranking of the whole campaign and one sensitivity.
Why explain_rank(const Store& store, const CampaignInfo& campaign, const StoredCase& stored,
                 RankRequest request);

/// Its place, what happens and what matters most in sentences, then "faults", "local" or "nearest"
/// and "slopes", and "global" as tables.
Answer to_answer(const Why& why);

}  // namespace faultsweep
