#pragma once

#include <string>
#include <vector>

#include "campaign/query/place_columns.h"
#include "campaign/render/answer.h"
#include "campaign/store/store.h"
#include "simulator/initial_state/initial_state.h"

/// `faultsweep show CASE`: one case of a campaign, with its result.
namespace faultsweep {

/// What of a case `faultsweep show` was asked for.
struct ShowRequest {
  std::string stage = {};  ///< "" = all and the whole history.
  std::string fault = {};  ///< "" = all.
};

struct ShownCase {
  CampaignInfo campaign;
  StoredCase stored;
  ShowRequest request = {};
  RegionPressures pressures = RegionPressures::at_depth;
  /// Per pressure region, from its scene; none where a store from before scenes had their tables
  /// names a file that is gone.
  std::vector<faultsim::InitialRegion> initial = {};
};
ShownCase shown_case(const Store& store, const CampaignInfo& campaign, const StoredCase& stored,
                     const ShowRequest& request);

/// What became of it in sentences; then as tables "settings" (its parameters), "runs", "stages",
/// "faults" (what each does in each stage), "slip_events", "episodes", "histories" (a row per fault
/// and load step) and "initial_state". "result" of JSON is that of `faultsim run`, all of it.
/// Throws InputError on a stage or fault that its result does not have.
Answer to_answer(const ShownCase& shown);

/// Which fault fields a campaign keeps: "fault fields of the three cases ranked first are kept"; ""
/// = none.
std::string kept_fields_text(KeepFields keep);
/// Where the fault fields of a case are, or why not; "" where none were asked for.
std::string fields_sentence(const CampaignInfo& campaign, const StoredCase& stored);

/// `faultsweep explain CASE`: whether `faultsweep run` will compute it, and why.
Answer explanation(const Store& store, const CampaignInfo& campaign, const StoredCase& one);

// Inside of the module: the tables of `show`, of the stages and faults that were asked for. What is
// per metre of strike, of plane strain, says so in unit and key.

/// Its parameters as given.
AnswerTable settings_table(const ShownCase& shown);
AnswerTable runs_table(const StoredCase& stored);
/// @pre of these: the case has a result.
AnswerTable stages_table(const ShownCase& shown);
AnswerTable faults_table(const ShownCase& shown);
AnswerTable events_table(const ShownCase& shown);
AnswerTable episodes_table(const ShownCase& shown);
/// A row per fault and load step.
AnswerTable histories_table(const ShownCase& shown);

AnswerTable initial_table(const std::vector<faultsim::InitialRegion>& regions);

}  // namespace faultsweep
