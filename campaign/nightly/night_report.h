#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "campaign/nightly/agreement.h"
#include "campaign/nightly/baseline.h"
#include "campaign/store/records.h"

namespace faultsweep {

/// What the cases of tonight are to a baseline, campaign by campaign: verdicts, rankings, cases
/// that are missing in either. Cases without a result are `missing`, with or without baseline.
std::vector<NightCaseRecord> judge_campaign(const NightCampaign* baseline,
                                            const NightCampaign& tonight, bool same_environment,
                                            const Tolerances& tolerances);

/// What the nights before say about this one, of the same suite and environment; they gate nothing.
/// Numbers: the digest of a case is not that of the night before. Time: a case took longer than the
/// longest of at least 3 of the last 7 nights by a quarter and a tenth of a second.
std::vector<std::string> night_advice(const NightRecord& tonight,
                                      const std::vector<NightRecord>& earlier);

/// @param remarks  sentences about environment and baseline, printed first.
/// @param width    columns of the screen.
std::string night_to_text(const NightRecord& night, const std::vector<std::string>& remarks,
                          const std::vector<std::string>& advice, std::size_t width);
nlohmann::json night_to_json(const NightRecord& night, const std::vector<std::string>& remarks,
                             const std::vector<std::string>& advice);
/// A line per night; how many cases changed their numbers since the night before.
std::string history_to_text(const std::vector<NightRecord>& nights, std::size_t width);
nlohmann::json history_to_json(const std::vector<NightRecord>& nights);

}  // namespace faultsweep
