#include "campaign/common/names.h"
#include "campaign/query/ranking.h"
#include "campaign/render/shown.h"

namespace faultsweep {

namespace {

/// "All 300 results", "12 of 300 results".
std::string so_many(long n, long all) {
  return n == all ? concat("All ", all, " results") : concat(n, " of ", all, " results");
}

}  // namespace

std::string approximation_note(const Store& store, const CampaignInfo& campaign) {
  const Store::Approximations found = store.approximations(campaign.id);
  std::string text;
  if (found.n_interpolated > 0) {
    text = concat(
        so_many(found.n_interpolated, found.n_results),
        " have an interpolated operator, off by at most ",
        format_number(found.error_of_stiffness, 2), " in H and ",
        format_number(found.error_of_slip, 2),
        " in slip without friction (relative errors, where measured)",
        found.error_of_chi_bar
            ? concat("; χ̄ of probing cases by at most ", format_number(*found.error_of_chi_bar, 2))
            : std::string(),
        found.n_interpolated < found.n_results ? "; the others have exact operators." : ".");
  }
  if (found.n_covered_in_part > 0) {
    text += concat(text.empty() ? "" : " ", so_many(found.n_covered_in_part, found.n_results),
                   " use a flow result that covers the compartments only in part: at least ",
                   format_number(100 * found.least_coverage, 3), " % of them.");
  }
  return text;
}

}  // namespace faultsweep
