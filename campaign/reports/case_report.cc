#include "campaign/reports/case_report.h"

#include <algorithm>
#include <cmath>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/expansion/expansion.h"
#include "campaign/query/parameters.h"
#include "campaign/query/ranking.h"
#include "campaign/query/selection.h"
#include "campaign/render/shown.h"
#include "simulator/common/printable.h"
#include "simulator/reading/read_scene.h"
#include "simulator/result/approximation.h"
#include "simulator/result/result_json.h"
#include "simulator/result/result_sentences.h"

namespace faultsweep {

namespace {

void check_request(const CaseResult& result, const ShowRequest& request) {
  if (!request.fault.empty()) require_name("--fault", "fault", request.fault, result.fault_names);
  if (request.stage.empty()) return;
  std::vector stages = mapped(result.stages, &StageMetrics::stage);
  require_name("--stage", "stage", request.stage, stages);
}

ordered_json fields_json(const CampaignInfo& campaign, const StoredCase& one) {
  if (one.fields == FieldsState::none) return nullptr;
  const bool gone = one.fields == FieldsState::kept && !fields_are_there(one.fields_folder);
  return {{"steps", to_string(steps_of(campaign.keep_fields))},
          {"state", gone ? "gone" : to_string(one.fields)},
          {"folder", one.fields_folder.string()}};
}

/// Which case, and what became of it.
std::string outcome_sentence(const ShownCase& shown) {
  const StoredCase& one = shown.stored;
  std::string text = concat("Case ", one.position, " of ", shown.campaign.name);
  if (one.has_result) {
    const CaseResult& result = one.result;
    return concat(text, ": ", to_string(result.outcome),
                  result.reason.empty() ? "" : ", " + result.reason, "; ", result.steps.size(),
                  " load steps, ", result.counts.newton_iterations, " Newton iterations.");
  }
  text += concat(", ", one.state, ", has no result");
  if (!one.runs.empty()) {
    const StoredRun& last = one.runs.back();
    text += concat(": ", last.status, last.reason.empty() ? "" : ": " + last.reason);
  }
  return text + ".";
}

/// Why M0 of the stages does not add up to that of the whole; "" where it does.
std::string moment_note(const CaseResult& result) {
  double sum = 0;
  for (const StageMetrics& stage : result.stages) sum += stage.moment;
  const double whole = result.whole.moment;
  constexpr double kSeen = 5e-4;  // of either: less is not seen in three digits
  if (std::abs(sum - whole) <= kSeen * std::max(sum, whole)) return "";
  return concat("M0 of a stage is summed over its steps, in all stages ", format_number(sum, 3),
                " N m; that of the whole history is from the slip at its end, ",
                format_number(whole, 3), " N m: slip that reverses counts only in the former.");
}

/// The last words of the simulator in runs that failed.
std::string last_words(const StoredCase& one) {
  std::string text;
  for (const StoredRun& run : one.runs) {
    if (run.log_tail.empty()) continue;
    text += concat(text.empty() ? "" : "\n", "last words of the simulator in attempt ", run.attempt,
                   ":");
    std::string line = "\n    | ";
    for (const char letter : faultsim::printable(run.log_tail, faultsim::Keep::line_ends)) {
      if (letter != '\n') {
        line += letter;
        continue;
      }
      text += line;
      line = "\n    | ";
    }
    if (line != "\n    | ") text += line;
  }
  return text;
}

ordered_json facts_of(const ShownCase& shown) {
  const StoredCase& one = shown.stored;
  const auto& parameters = shown.campaign.parameters;
  ordered_json settings = ordered_json::object();
  for (const CaseParameter& value : one.parameters)
    settings[parameters.at(static_cast<std::size_t>(value.index)).name] = value_to_json(value);
  return {{"campaign", shown.campaign.name},
          {"case", one.position},
          {"identity", one.identity},
          {"family", one.family},
          {"state", one.state},
          {"parameters", std::move(settings)},
          {"changes", json::parse(one.changes, nullptr, false)},
          {"fields", fields_json(shown.campaign, one)},
          {"result", one.has_result ? faultsim::result_to_json(one.result) : json()}};
}

}  // namespace

std::string kept_fields_text(KeepFields keep) {
  static_assert(kShownFirst == 3);
  if (keep == KeepFields::none) return "";
  if (keep == KeepFields::shown) return "fault fields of the three cases ranked first are kept";
  return concat("fault fields are kept (", to_string(keep), ")");
}

std::string fields_sentence(const CampaignInfo& campaign, const StoredCase& stored) {
  switch (stored.fields) {
    case FieldsState::none:
      return "";
    case FieldsState::wanted:
      return concat("fault fields: not yet; `faultsweep run ", campaign.name, "` writes them");
    case FieldsState::failed:
      return concat("fault fields: not written, see the last attempt; `faultsweep retry ",
                    campaign.name, " --case ", stored.position, "` tries again");
    case FieldsState::kept:
      break;
  }
  if (!fields_are_there(stored.fields_folder)) {
    return concat(
        "fault fields: gone from ", stored.fields_folder.string(), "; `faultsweep run ",
        campaign.name, "` writes them again",
        campaign.keep_fields == KeepFields::shown ? " if the case is still ranked first" : "");
  }
  return concat("fault fields (",
                campaign.keep_fields == KeepFields::all ? "all load steps"
                                                        : "initial state and ends of stages",
                "): ", (stored.fields_folder / "faults.xmf").string(), " for ParaView, faults.h5");
}

ShownCase shown_case(const Store& store, const CampaignInfo& campaign, const StoredCase& stored,
                     const ShowRequest& request) {
  const BaseScene base = store.base_scene(stored.scene);
  ShownCase shown{campaign, stored, request,
                  region_pressures(has_flow_field(base.document + stored.changes),
                                   stored.result.numerics_version)};
  std::vector<Problem> problems;
  const faultsim::Scene scene = faultsim::read_scene(
      {base.source, scene_from_changes(base.document, stored.changes), {}}, problems);
  if (problems.empty()) shown.initial = faultsim::initial_regions(scene);
  return shown;
}

Answer to_answer(const ShownCase& shown) {
  const StoredCase& one = shown.stored;
  const CaseResult& result = one.result;
  Answer answer{{outcome_sentence(shown)}};
  if (one.has_result) {
    check_request(result, shown.request);
    answer.headline.push_back(faultsim::sliding_sentence(result));
    const std::string again = faultsim::unexpected_sentence(result);
    if (!again.empty()) answer.headline.push_back(again);
    for (std::string& text : faultsim::unresolved_sentences(result))
      answer.headline.push_back(std::move(text));
  }
  answer.facts = facts_of(shown);
  answer.note(concat("identity ", one.identity, ", family ", one.family));
  for (const std::string& note : {fields_sentence(shown.campaign, one), last_words(one)})
    answer.note_if(note);
  answer.add(settings_table(shown));
  answer.add(runs_table(one));
  if (one.has_result) {
    answer.note_if(faultsim::approximation_sentence(result));
    for (const std::string& warning : result.warnings) answer.note("warning: " + warning);
    answer.note_if(faultsim::creep_sentence(result));
    AnswerTable& stages = answer.add(stages_table(shown));
    const std::string moments = moment_note(result);
    if (!moments.empty()) stages.notes.push_back(moments);
    for (AnswerTable table :
         {faults_table(shown), events_table(shown), episodes_table(shown), histories_table(shown)})
      answer.add(std::move(table));
  }
  answer.add(initial_table(shown.initial));
  return answer;
}

}  // namespace faultsweep
