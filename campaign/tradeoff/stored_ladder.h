#pragma once

#include <map>
#include <string>
#include <vector>

#include "campaign/expansion/expansion.h"
#include "campaign/store/store.h"
#include "campaign/tradeoff/trade.h"

namespace faultsweep {

/// The campaign of a ladder as the store has it, by group and choice.
class StoredLadder {
 public:
  /// @param expansion  of the campaign. All three are kept by reference.
  StoredLadder(const Store& store, const CampaignInfo& campaign, const Expansion& expansion);

  /// Per choice; without a result where it was left out or failed.
  std::vector<TradeRun> runs(const TradeAxis& axis) const;
  /// Compares the sample at two tiers.
  /// @param bars  gets the errors of its metrics, without the name of the sampled campaign.
  RankingTrade rank(const std::string& tier, const std::string& reference,
                    std::vector<ErrorBar>& bars) const;

 private:
  using SecondsByFamily = std::map<std::string, double>;
  std::map<std::string, long> positions(const std::string& group) const;
  TradeRun run(long position) const;
  void add_cost(long position, const TradeRun& run, SecondsByFamily& operators,
                double& seconds) const;

  const Store& store_;
  const CampaignInfo& campaign_;
  const Expansion& expansion_;
  std::map<std::string, Store::FamilyProgress> families_;
  std::map<long, long> place_;  ///< of each position in the default order of all.
};

}  // namespace faultsweep
