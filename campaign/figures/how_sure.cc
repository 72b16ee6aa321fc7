#include "campaign/figures/how_sure.h"

#include <filesystem>

#include "campaign/answers/cell_errors.h"
#include "campaign/answers/tiers.h"
#include "campaign/common/names.h"
#include "campaign/query/ranking.h"
#include "campaign/tradeoff/stored_trade.h"

namespace faultsweep {

namespace {

void add_cell_errors(const Store& store, const CampaignInfo& campaign, Answer& answer) {
  const CellErrors errors = cell_errors(store, campaign);
  answer.note(errors.mesh);
  answer.note_if(errors.measured);
  if (!errors.measured.empty()) {
    answer.note(
        "The rms errors appear as ± in the ranking. They are those of the cases that were "
        "measured, not bounds; a case closer to a threshold than the largest of them "
        "counts as undecided.");
  } else {
    answer.note_if(errors.undecided);
  }
  for (const std::string& sentence : errors.elsewhere) answer.note(sentence);
}

/// What is said about them, below a sentence that says which they are.
void add_tiers(const Store& store, const TierPair& pair, double confidence, Answer& answer) {
  TierRequest request;
  request.confidence = confidence;
  try {
    Answer found = to_answer(compare_tiers(store, pair.low, pair.high, request));
    answer.note(concat("Answers at the tier of ", pair.high.name, " from all samples of ",
                       pair.low.name, " (faultsweep tiers):"));
    for (const std::string& sentence : found.headline) answer.note(sentence);
    append(answer.blocks, found.blocks);
  } catch (const InputError& error) {
    answer.note(concat(pair.low.name, " and ", pair.high.name, " are not compared: ",
                       error.problems().front().what, "; ", error.problems().front().cure, "."));
  }
}

/// "spec.json", of whoever submitted it.
std::string spec_name(const CampaignInfo& campaign) {
  return std::filesystem::path(campaign.source).filename().string();
}

}  // namespace

Answer how_sure(const Store& store, const CampaignInfo& campaign, double confidence) {
  Answer answer;
  add_cell_errors(store, campaign, answer);
  const std::optional<TierPair> tiers = tiers_beside(store, campaign);
  if (tiers) add_tiers(store, *tiers, confidence, answer);
  const std::optional<TradeRecord> trade = trade_of(store, campaign);
  if (trade) append(answer.blocks, to_answer(*trade).blocks);
  const std::string command = "faultsweep tradeoff " + spec_name(campaign);
  if (!trade && !tiers && store.error_bars(campaign.name).empty()) {
    answer.note(
        concat("What these cells, the tier and the other modelling choices cost in accuracy "
               "was not measured for this campaign: ",
               command, " measures and stores it."));
  } else if (error_bars_of(store, campaign).empty()) {
    answer.note(concat("Errors of these cases at their own mesh were not measured: ", command,
                       " --tiers measures them if that mesh is a tier's."));
  }
  answer.note_if(approximation_note(store, campaign));
  return answer;
}

}  // namespace faultsweep
