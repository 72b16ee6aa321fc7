#pragma once

#include <string>
#include <vector>

#include "campaign/store/store.h"
#include "simulator/scene/scene.h"

namespace faultsweep {

/// What the cells of a campaign's cases are off by, in sentences: the sheet of a fault and the page
/// of a campaign say the same.
struct CellErrors {
  std::string mesh;      ///< of the base scene, and the errors that its tier names where it is one.
  std::string measured;  ///< on cases of the campaign at their tier (rms and largest); "" = never.
  /// How near to its limit a condition on χ̄ is undecided; "" = no error of χ̄ is known.
  std::string undecided = {};
  std::vector<std::string> elsewhere;  ///< measured on them at other tiers.
};
/// @param base  of the campaign.
CellErrors cell_errors(const Store& store, const CampaignInfo& campaign,
                       const faultsim::Scene& base);
/// Reads the base scene of the first case. Throws InputError where it cannot be read.
CellErrors cell_errors(const Store& store, const CampaignInfo& campaign);

}  // namespace faultsweep
