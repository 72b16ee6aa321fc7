#include "campaign/answers/what_matters.h"

#include "campaign/answers/one_at_a_time.h"
#include "campaign/answers/screening.h"
#include "campaign/query/approximations.h"

namespace faultsweep {

Answer what_matters(const Store& store, const CampaignInfo& campaign,
                    const SensitivityRequest& request) {
  const auto with_approximation = [&](Answer answer) {
    answer.note_if(approximation_note(store.approximations(campaign.id)));
    return answer;
  };
  if (!request.by_step) {
    if (const auto found = screen(store, campaign, request))
      return with_approximation(to_answer(*found));
    if (const auto found = compare_one_at_a_time(store, campaign, request))
      return with_approximation(to_answer(*found));
  }
  return to_answer(analyse_sensitivity(store, campaign, request));
}

}  // namespace faultsweep
