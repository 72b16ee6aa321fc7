#pragma once

#include "campaign/nightly/baseline.h"
#include "campaign/nightly/nightly_suite.h"
#include "campaign/store/store.h"

namespace faultsweep {

/// Cases of a stored campaign, to be run again.
struct StoredSample {
  Submission submission;   ///< named "sample-CAMPAIGN".
  NightCampaign baseline;  ///< the stored results.
};
/// Throws StorageError or InputError when store or campaign are not there.
StoredSample take_sample(const SampleRequest& request);

/// The cases of a campaign as stored, with their results.
NightCampaign stored_night(const Store& store, const CampaignInfo& campaign);
NightCase night_case(const StoredCase& stored, const CampaignInfo& campaign);

}  // namespace faultsweep
