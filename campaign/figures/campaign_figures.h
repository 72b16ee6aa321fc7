#pragma once

#include <array>
#include <string>

#include "campaign/store/store.h"
#include "simulator/case_figures/case_figures.h"
#include "simulator/figure/outcome_map.h"

/// Pictures of a campaign, as SVG.
namespace faultsweep {

struct MapRequest {
  std::string x = {}, y = {};  ///< parameters; "" = the first two, or those that are left.
};
/// Two parameters against what became of the cases, or the only one that there is; cases without a
/// result are left out. Throws InputError where there are no such parameters, or none.
std::string draw_outcome_map(const Store& store, const CampaignInfo& campaign,
                             const MapRequest& request);

/// How many cases there are of each kind, in the order of figure::CaseClass.
std::array<long, faultsim::figure::kCaseClasses> count_outcomes(const Store& store,
                                                                const CampaignInfo& campaign);

/// A case of a store with its scene and, where they were kept, its fields: owns what a CasePicture
/// refers to.
class StoredPicture {
 public:
  /// Throws InputError where the case has no result, or its scene cannot be read any more.
  StoredPicture(const Store& store, const CampaignInfo& campaign, const StoredCase& one);
  faultsim::CasePicture picture() const;

 private:
  std::string name_;
  faultsim::CaseResult result_;
  faultsim::Scene scene_;
  std::unique_ptr<const faultsim::FieldSource> fields_;
};

}  // namespace faultsweep
