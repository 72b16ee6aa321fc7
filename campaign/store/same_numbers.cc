#include "campaign/store/same_numbers.h"

#include "campaign/common/json.h"
#include "campaign/store/records.h"
#include "simulator/result/result_fields.h"
#include "simulator/result/result_json.h"

namespace faultsweep {

namespace {

/// What the store keeps of a result.
json kept(const CaseResult& result) {
  json document = faultsim::result_to_json(bare(result));
  for (json& step : document["steps"]) {
    step.erase("coupled");
    // A step that did not end in equilibrium has no metrics in the store.
    if (faultsim::in_equilibrium(
            stored_word<faultsim::Outcome>(step["outcome"].get<std::string>(), "outcome")))
      continue;
    step.erase("faults");
    step.erase("creep");
  }
  return document;
}

void forget_later_fields(const json& stored, json& again) {
  if (stored.is_array()) {
    for (std::size_t k = 0; k < std::min(stored.size(), again.size()); ++k)
      forget_later_fields(stored[k], again[k]);
  } else if (stored.is_object() && again.is_object()) {
    for (const auto& [key, value] : stored.items()) {
      if ((value.is_null() || value == json::array()) && later_fields().contains(key))
        again[key] = value;
      forget_later_fields(value, again[key]);
    }
  }
}

}  // namespace

CaseResult bare(CaseResult result) {
  result.title.clear();
  result.operator_fingerprint.clear();
  result.warnings.clear();
  result.counts = {};
  result.seconds = 0;
  for (faultsim::StepResult& step : result.steps) {
    step.counts = {};
    step.observed.clear();
    step.seconds = 0;
  }
  return result;
}

const std::set<std::string>& later_fields() {
  static const std::set<std::string> keys = [] {
    std::set<std::string> later;
    const auto note = [&later](const faultsim::Field& field, const auto&) {
      if (field.since > 0) later.emplace(field.key);
    };
    const faultsim::StepResult step;
    faultsim::for_each_field(step, note);
    const faultsim::FaultOnset onset;
    faultsim::for_each_field(onset, note);
    const CaseResult result;
    faultsim::for_each_measure(result.whole, note);
    faultsim::for_each_field(result, note);
    return later;
  }();
  return keys;
}

std::string first_difference(const CaseResult& stored, const CaseResult& again) {
  const json before = kept(stored);
  json now = kept(again);
  forget_later_fields(before, now);
  const auto differ = [&](const char* key) { return before.at(key) != now.at(key); };
  if (differ("outcome") || differ("reason") || differ("failed_step")) return "the outcome";
  const json &steps = before.at("steps"), &steps_now = now.at("steps");
  if (steps.size() != steps_now.size()) return "the number of load steps";
  for (std::size_t k = 0; k < steps.size(); ++k) {
    if (steps[k] == steps_now[k]) continue;
    return faultsim::concat("load step ", stored.steps[k].step, " (", stored.steps[k].stage, ")");
  }
  if (differ("stages") || differ("whole")) return "the metrics of the stages";
  if (differ("events")) return "the slip events";
  if (differ("episodes") || differ("unexpected")) return "the episodes";
  if (differ("surface") || differ("field_coverage") || differ("field_assumed"))
    return "how exact it is";
  for (const char* key : {"pressure_margin_pa", "max_nucleation_ratio", "max_penetration_m",
                          "plane_strain", "weakening_resolved"}) {
    if (differ(key)) return "the metrics of the case";
  }
  return "";
}

}  // namespace faultsweep
