#include "simulator/app/what_if_reply.h"

#include <algorithm>

#include "simulator/page/steps_json.h"
#include "simulator/result/approximation.h"
#include "simulator/result/result_difference.h"
#include "simulator/result/result_sentences.h"

namespace faultsim {
namespace {

using nlohmann::json;

std::vector<std::string> sentences_of(const CaseResult& result) {
  std::vector<std::string> said = {sliding_sentence(result), unexpected_sentence(result),
                                   creep_sentence(result), approximation_sentence(result)};
  for (std::string& one : unresolved_sentences(result)) said.push_back(std::move(one));
  for (const std::string& warning : result.warnings) said.push_back(warning);
  std::erase(said, "");
  return said;
}

std::vector<std::string> differences_of(const ShownCase& original, const ShownCase& shown) {
  std::vector<std::string> said = difference_sentences(original.result, shown.result);
  if (original.scene.tier != shown.scene.tier)
    said.push_back(concat("Its tier is now ", shown.scene.tier, " and was ", original.scene.tier,
                          ": the cells differ."));
  return said;
}

CasePicture picture_of(const ShownCase& shown) {
  return {shown.result, shown.scene, &shown.fields, {}};
}

json drawn(const CasePicture& picture, const std::vector<CaseChartRequest>& wanted) {
  json charts = json::object();
  for (const CaseChartRequest& request : wanted) {
    const auto info = std::ranges::find(case_charts(), request.chart, &CaseChartInfo::chart);
    try {
      charts[info->name] = draw_case(picture, request);
    } catch (const InputError& error) {
      charts[info->name] = {{"problems", what_if_problems(error)}};
    }
  }
  return charts;
}

}  // namespace

json what_if_problems(const InputError& error) {
  json list = json::array();
  for (const Problem& problem : error.problems())
    list.push_back({{"place", problem.pointer}, {"cause", problem.what}, {"cure", problem.cure}});
  return list;
}

json what_if_reply(const ShownCase& shown, const ShownCase* original,
                   const std::vector<CaseChartRequest>& charts) {
  const CaseResult& result = shown.result;
  json reply = {{"outcome", to_string(result.outcome)},
                {"identity", result.identity},
                {"seconds", result.seconds},
                {"sentences", sentences_of(result)},
                {"scene", shown.document.value}};
  CasePicture picture = picture_of(shown);
  if (original == nullptr) {
    reply["charts"] = drawn(picture, charts);
  } else {
    const CasePicture before = picture_of(*original);
    picture.original = &before;
    reply["charts"] = drawn(picture, charts);
    reply["differences"] = differences_of(*original, shown);
  }
  const bool has_steps = !result.steps.empty() && !result.steps.front().faults.empty();
  if (has_steps) reply["critical_step"] = critical_moment(result).step;
  if (has_steps && shown.scene.geometry_kind == GeometryKind::field)
    reply["steps"] = steps_json(picture);
  return reply;
}

}  // namespace faultsim
