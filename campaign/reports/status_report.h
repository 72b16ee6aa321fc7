#pragma once

#include <optional>
#include <string>
#include <vector>

#include "campaign/render/answer.h"
#include "campaign/store/store.h"

namespace faultsweep {

/// How a campaign stands, for `faultsweep status`.
struct StatusReport {
  CampaignInfo campaign;
  std::optional<OwnerInfo> manager;  ///< the living manager, if it runs this campaign.
  bool manager_died = false;         ///< there is an owner, but it is gone.
  std::vector<FailureCount> failures;
  std::vector<Store::FamilyProgress> families;
  std::vector<RoundRecord> rounds;
  std::vector<EventRecord> events;  ///< newest first.
  std::vector<std::string> others;  ///< names of the store's other campaigns.
};

StatusReport make_status(const Store& store, const std::string& campaign);
/// Counts in a sentence, then workers, failures, families, rounds and the last events as tables.
Answer to_answer(const StatusReport& status);

/// `faultsweep status --all`: table `campaigns`, those of the store with their counts, newest
/// first.
Answer campaigns_answer(const Store& store);

}  // namespace faultsweep
