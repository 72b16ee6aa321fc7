#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "campaign/store/store.h"

namespace faultsweep {

/// What `faultsweep rank` was asked.
struct RankRequest {
  std::string by = {};     ///< metric or expression of numbers; "" = the campaign's own.
  std::string stage = {};  ///< "" = the whole history.
  std::string fault = {};  ///< "" = all faults of a case together.
  std::string where = {};  ///< condition; "" = all cases.
  bool ascending = false;  ///< smallest first.
  long top = 20;           ///< 0 = all.
};

/// A ranking: complete histories first, then those with unresolved events, whose size is the
/// mesh's, then unstable cases, then those that ended early otherwise.
struct Ranking {
  CampaignInfo campaign;
  RankRequest request;
  bool by_default = false;  ///< activated area, open area, M0, pressure margin, χ̄.
  Store::Kinds kinds;       ///< of the cases that are ranked.
  /// The campaign has cases of both kinds and its own order compares areas or moments: only those
  /// in total are ranked.
  bool plane_strain_apart = false;
  std::vector<RankedCase> rows;
  /// Measured by `faultsweep tradeoff` for this campaign at its tier; empty where it was not, or
  /// where the campaign has several tiers or meshes of its own.
  std::vector<ErrorBar> error_bars;
};

/// Asks the store. Throws InputError on a wrong expression, an unknown stage or fault, and where
/// `by` would put areas, potencies or moments per metre of strike and in total in one order. Where
/// the campaign's own order would, plane-strain cases are left out.
Ranking make_ranking(const Store& store, const CampaignInfo& campaign, RankRequest request);

std::string ranking_to_text(const Ranking& ranking);
/// SI throughout, units in key names.
nlohmann::json ranking_to_json(const Ranking& ranking);
/// The metrics that rank --by and --where know, with unit and meaning.
std::string metrics_to_text();
nlohmann::json metrics_to_json();

}  // namespace faultsweep
