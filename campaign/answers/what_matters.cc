#include "campaign/answers/what_matters.h"

#include "campaign/answers/one_at_a_time.h"
#include "campaign/answers/screening.h"

namespace faultsweep {

Answer what_matters(const Store& store, const CampaignInfo& campaign,
                    const SensitivityRequest& request) {
  if (const auto found = screen(store, campaign, request)) return to_answer(*found);
  if (const auto found = compare_one_at_a_time(store, campaign, request)) return to_answer(*found);
  return to_answer(analyse_sensitivity(store, campaign, request));
}

}  // namespace faultsweep
