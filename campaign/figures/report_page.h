#pragma once

#include <string>

#include "campaign/query/ranking.h"

namespace faultsweep {

/// `faultsweep report`: a campaign as one HTML page that needs nothing else: no network, and
/// without JavaScript all is there but filters, sorting and the slider. Pictures are SVG in the
/// page; what grows with the number of cases is counted in cells, or is the data of the ranking, of
/// which the script shows some rows at a time: 10^5 cases stay below 8 MB.
struct ReportRequest {
  std::string program;       ///< with version and commit, for the provenance.
  double confidence = 0.95;  ///< of all intervals.
  long top = kShownFirst;    ///< cases that are drawn.
};

std::string report_page(const Store& store, const CampaignInfo& campaign,
                        const ReportRequest& request);

}  // namespace faultsweep
