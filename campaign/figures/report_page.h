#pragma once

#include <string>

#include "campaign/store/store.h"

namespace faultsweep {

/// `faultsweep report`: a campaign as one HTML page that needs nothing else: no network, and
/// without JavaScript all is there but filters, sorting and the slider. Pictures are SVG in the
/// page; what grows with the number of cases is counted in squares or cut off (the ranking at
/// kMostRanked rows, which the page says), so that 10^5 cases stay far below 8 MB.
struct ReportRequest {
  std::string program;       ///< with version and commit, for the provenance.
  double confidence = 0.95;  ///< of all intervals.
  long top = 3;              ///< cases that are drawn.
};
inline constexpr long kMostRanked = 1000;

std::string report_page(const Store& store, const CampaignInfo& campaign,
                        const ReportRequest& request);

}  // namespace faultsweep
