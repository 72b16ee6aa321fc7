#pragma once

#include <vector>

#include "campaign/render/answer.h"
#include "campaign/reports/case_report.h"

/// The tables of `faultsweep show`, of the stages and faults that were asked for. What is per metre
/// of strike, of plane strain, says so in unit and key.
namespace faultsweep {

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
