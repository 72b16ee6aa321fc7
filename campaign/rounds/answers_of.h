#pragma once

#include "campaign/rounds/proposer.h"
#include "campaign/store/store.h"

/// Inside of the module, and for reports on it: what became of a campaign's rounds.
namespace faultsweep {

/// A campaign that goes on in rounds, as the store has it.
struct StoredRounds {
  std::string source;  ///< of its base scene.
  nlohmann::ordered_json
      spec;  ///< as given, on the stored base scene, whatever became of the files.
  std::vector<RoundRecord> rounds;
  std::vector<nlohmann::ordered_json> designs;  ///< of the rounds, that of the spec first.
};
/// Nothing where the campaign has one round only.
std::optional<StoredRounds> stored_rounds(const Store& store, const CampaignInfo& campaign);
/// The spec, read again.
CampaignSpec parse_spec(const StoredRounds& stored);

/// What became of the rows of all rounds, in their order.
/// Of limits the rows of each round are made anew, as rows may share cases in every way.
std::vector<RowAnswers> answers_of(const Store& store, const CampaignInfo& campaign,
                                   const StoredRounds& stored, const Proposer& proposer,
                                   bool has_limits);

}  // namespace faultsweep
