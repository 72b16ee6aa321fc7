#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "campaign/query/ranking.h"
#include "campaign/render/answer.h"

/// `faultsweep rank --certify N --tier T`: which cases come first at another tier.
namespace faultsweep {

/// Cases of a ranking that all may come first: those whose history did not end early, the cells
/// resolve them or not, the first one first.
std::vector<const RankedCase*> with_full_histories(const Ranking& ranking);

/// A case that was run at both tiers.
struct CertifiedCase {
  const RankedCase* before;  ///< at the campaign's tier.
  const RankedCase* after;   ///< null: without a full history at the other tier.
};

/// The first N cases of a ranking, run at another tier, and how surely they come before all that
/// were not run. No statement about chance: what a case that was not run would have to do, beside
/// what those did that were.
struct TierCertificate {
  std::string tier_before, tier_after;
  std::string by;
  ShownUnit unit;
  bool ascending = false;
  std::vector<CertifiedCase> cases;  ///< as they are ranked at the other tier; those without last.
  std::optional<double> next;        ///< score of the first that was not run; none: all were.
  long n_without = 0;                ///< not run, as their history ended early: anywhere.

  /// From tier to tier, over all that were run: least and most; NaN without one.
  std::pair<double, double> changes() const;
  /// How far one of them went towards the first place, ≥ 0.
  double largest_rise() const;
  /// How far one that was not run would have to rise to come before this one.
  std::optional<double> margin(const CertifiedCase& one) const;
  /// How many come before all others unless one of those rises by more than largest_rise().
  long n_certain() const;
};

/// @param positions_after  of the first cases of `before`, in the campaign that `after` ranks.
/// @pre both rankings have all their rows, and outlive the certificate. Throws InputError where
/// areas, potencies or moments per metre of strike would be compared with totals.
TierCertificate tier_certificate(const Ranking& before, const std::vector<long>& positions_after,
                                 const Ranking& after);

/// The first three, how many are certain; "first", each case with both scores, as a table.
Answer to_answer(const TierCertificate& certificate, const Ranking& before);

}  // namespace faultsweep
