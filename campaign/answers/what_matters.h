#pragma once

#include "campaign/answers/sensitivity.h"
#include "campaign/render/answer.h"

namespace faultsweep {

/// Which parameters matter, by what the campaign's design can say: shares of variance of a sample
/// or grid (sensitivity.h), elementary effects of a morris design (screening.h), of one-at-a-time
/// what each parameter changes (one_at_a_time.h). By step: of samples and grids. Throws InputError
/// as these do.
Answer what_matters(const Store& store, const CampaignInfo& campaign,
                    const SensitivityRequest& request);

}  // namespace faultsweep
