#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "campaign/answers/why.h"
#include "campaign/render/render_json.h"
#include "campaign/report/text_table.h"
#include "simulator/common/units.h"

namespace faultsweep {

using faultsim::concat;
using nlohmann::json;

namespace {

constexpr double kYear = 31557600;     // s, 365.25 d
constexpr std::size_t kMostNamed = 8;  // cases in a sentence

const faultsim::StepResult* step_of(const faultsim::CaseResult& result, int step) {
  for (const faultsim::StepResult& one : result.steps)
    if (one.step == step) return &one;
  return nullptr;
}

/// "in primary_production, load step 4 (year 4)".
std::string when(const faultsim::CaseResult& result, int step) {
  const faultsim::StepResult* found = step_of(result, step);
  if (found == nullptr) return concat("at load step ", step);
  return concat("in ", found->stage, ", load step ", step, " (year ",
                format_number(found->time / kYear), ")");
}

/// "west at -80 bar (145 bar absolute)"; "" where no region touches the fault on that side.
std::string side(const std::string& region, const std::optional<double>& change,
                 const std::optional<double>& absolute) {
  if (!change) return "";
  return concat(region, " has changed by ", format_number(*change / kBar, 4), " bar",
                absolute ? concat(" (", format_number(*absolute / kBar, 4), " bar absolute)")
                         : std::string());
}

std::string pressures(const faultsim::SidePressures& p) {
  const std::string minus = side(p.region_minus, p.change_minus, p.absolute_minus);
  const std::string plus = side(p.region_plus, p.change_plus, p.absolute_plus);
  std::string text = minus + (minus.empty() || plus.empty() ? "" : ", ") + plus;
  if (std::isfinite(p.change_in_fault)) {
    text += concat(text.empty() ? "" : ", ", "the fluid in the fault by ",
                   format_number(p.change_in_fault / kBar, 4), " bar");
  }
  return text;
}

/// The load step of the stage in which a fault's χ̄ is largest, the first of equal ones.
int step_of_largest_chi(const Why& why, std::size_t fault) {
  int step = why.metrics.first_step;
  double largest = -1;
  for (const faultsim::StepResult& one : why.stored.result.steps) {
    const bool inside = one.step >= why.metrics.first_step && one.step <= why.metrics.last_step;
    if (!inside || fault >= one.faults.size() || !(one.faults[fault].chi_bar > largest)) continue;
    largest = one.faults[fault].chi_bar;
    step = one.step;
  }
  return step;
}

/// The stages in which a fault slides, by slip of their own: "primary_production, gas_storage".
std::string sliding_stages(const faultsim::CaseResult& result, std::size_t fault) {
  std::string stages;
  for (const faultsim::StageMetrics& stage : result.stages) {
    if (fault >= stage.faults.size() || !stage.faults[fault].activated) continue;
    stages += concat(stages.empty() ? "" : ", ", stage.stage);
  }
  return stages;
}

std::string fault_sentence(const Why& why, std::size_t f) {
  const faultsim::FaultStageMetrics& m = why.metrics.faults[f];
  const faultsim::CaseResult& result = why.stored.result;
  const std::string sure = m.activation_resolved ? "" : ", which depends on the mesh";
  if (!m.activated) {
    return concat(m.fault, m.slips ? " slips but does not slide" : " does not slide", sure,
                  ": its χ̄ comes to ", format_number(m.chi_bar, 3), ", ",
                  when(result, step_of_largest_chi(why, f)), ".\n");
  }
  std::string text = m.fault + " slides";
  if (m.activation) {
    text += concat(" first ", when(result, m.activation->step), ", at ",
                   format_number(m.activation->depth), " m depth", sure, ": ",
                   pressures(m.activation->pressures));
  }
  const std::string stages = sliding_stages(result, f);
  if (why.metrics.stage.empty() && !stages.empty()) text += "; by slip of its own in " + stages;
  return text + ".\n";
}

/// Faults in the order in which they slide, then those that do not by χ̄, largest first.
std::vector<std::size_t> order_of_faults(const Why& why) {
  std::vector<std::size_t> order;
  for (std::size_t f = 0; f < why.metrics.faults.size(); ++f) {
    const bool asked = why.ranking.request.fault.empty() ||
                       why.ranking.request.fault == why.metrics.faults[f].fault;
    if (asked) order.push_back(f);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const auto &ma = why.metrics.faults[a], &mb = why.metrics.faults[b];
    if (ma.activated != mb.activated) return ma.activated;
    if (ma.activation && mb.activation) return ma.activation->step < mb.activation->step;
    return ma.chi_bar > mb.chi_bar;
  });
  return order;
}

std::string what_happens(const Why& why) {
  std::string text;
  for (const std::size_t f : order_of_faults(why)) text += fault_sentence(why, f);
  const double margin = why.row.pressure_margin.value_or(NAN);
  if (why.metrics.stage.empty() && std::isfinite(margin)) {
    text += concat("By linear extrapolation χ̄ would be 1 after ", format_number(margin / kBar, 3),
                   " bar more.\n");
  }
  return text;
}

/// Unit of what is compared, with a space before it; of expressions SI, which has no name.
std::string unit_of(const Why& why) {
  for (const MetricInfo& metric : metric_catalogue()) {
    if (metric.name != why.compared && metric.synonym != why.compared) continue;
    const std::string unit = metric_unit(metric, why.row.plane_strain);
    return unit.empty() ? "" : " " + unit;
  }
  return why.global ? "" : " (SI)";
}

std::string named_cases(const std::vector<long>& positions) {
  std::string text;
  for (std::size_t k = 0; k < std::min(positions.size(), kMostNamed); ++k)
    text += concat(k == 0 ? "" : ", ", positions[k]);
  if (positions.size() > kMostNamed)
    text += concat(" and ", positions.size() - kMostNamed, " more");
  return text;
}

std::string place_text(const Why& why) {
  const Place& place = why.place;
  const char* kinds[] = {"complete histories",
                         "histories that depend on the mesh, which are ranked apart",
                         "histories that end early, which have no rank"};
  std::string text = concat("Place ", place.place, " of ", place.n_ranked, " ",
                            kinds[std::clamp(why.row.rank_class, 0, 2)], ": ", why.compared, " = ",
                            format_number(why.value), unit_of(why), ".\n");
  const bool has_one = place.ties.size() == 1;
  const std::string ties =
      concat(place.ties.size(), has_one ? " case (" : " cases (", named_cases(place.ties), ")");
  if (place.error) {
    text +=
        concat("The mesh makes an error of ", format_number(place.error->rms, 2), " (rms at ",
               place.error->tier, " against ", place.error->reference,
               "): ", place.ties.empty() ? "no other case is" : ties + (has_one ? " is" : " are"),
               " within √2 times that; among those the order says nothing.\n");
    return text;
  }
  if (!place.ties.empty())
    text += concat(ties, has_one ? " has" : " have", " the very same value.\n");
  text += concat("The error of the mesh in ", why.compared,
                 " was not measured for this campaign, so "
                 "closer places than its cells allow are not told apart here: faultsweep tradeoff "
                 "SPEC measures that of chi_bar and max_slip.\n");
  return text;
}

std::string local_text(const Why& why) {
  if (why.neighbours.empty()) {
    return "No case of the campaign differs from this one in one parameter alone.\n";
  }
  TextTable table({"parameter", "here", "there", "case", why.compared, "change", "slides"});
  for (const Neighbour& one : why.neighbours) {
    const faultsim::Measures& m =
        one.row.fault_metrics ? static_cast<const faultsim::Measures&>(*one.row.fault_metrics)
                              : one.row.metrics;
    table.add_row(
        {one.parameter, one.from, one.to, std::to_string(one.row.position),
         format_number(one.value), format_number(one.change, 3),
         concat(m.activated ? "yes" : "no", m.activation_resolved ? "" : ", unresolved")});
  }
  const Neighbour& most = why.neighbours.front();
  std::string text = table.text();
  if (std::abs(most.change) > 0) {
    text += concat("Most changes with ", most.parameter, ": from ", most.from, " to ", most.to,
                   ", ", why.compared, " goes from ", format_number(why.value), " to ",
                   format_number(most.value), unit_of(why), ".\n");
  } else {
    text += concat("None of these changes ", why.compared, ".\n");
  }
  return text;
}

std::string global_text(const Why& why) {
  if (!why.global) return concat("No global measure: ", why.no_global, "\n");
  const MetricSensitivity& metric = why.global->metrics.front();
  if (!(metric.standard_deviation > 0)) return why.compared + " is the same in all cases.\n";
  std::vector<std::size_t> order(metric.first_order.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return metric.first_order[a].value > metric.first_order[b].value;
  });
  TextTable table({"parameter", "share alone", "from", "to"});
  for (const std::size_t k : order) {
    const Estimate& e = metric.first_order[k];
    table.add_row({why.global->parameters[k], format_number(e.value, 2),
                   format_number(e.bounds.low, 2), format_number(e.bounds.high, 2)});
  }
  return concat(table.text(), "share of the variance of ", why.compared, " over ", metric.n,
                " cases that a parameter explains alone, with its interval of ",
                format_number(100 * why.global->request.confidence, 4), " %\n",
                why.global->sampling.remark.empty() ? "" : why.global->sampling.remark + "\n");
}

}  // namespace

std::string why_to_text(const Why& why) {
  const auto parameters = parameters_from_json(why.ranking.campaign.parameters);
  std::string settings;
  for (const std::string& one : settings_of(why.row.parameters, parameters))
    settings += concat(settings.empty() ? "" : ", ", one);
  return concat("case ", why.row.position, " of ", why.ranking.campaign.name, ": ", settings,
                "\n\nWhat happens", why.metrics.stage.empty() ? "" : " in " + why.metrics.stage,
                "\n", what_happens(why), "\nIts place\n", place_text(why),
                "\nOne parameter moved, near this case\n", local_text(why),
                "\nOver the whole campaign\n", global_text(why));
}

namespace {

json finite(double value) { return std::isfinite(value) ? json(value) : json(); }
json optional_json(const std::optional<double>& value) { return value ? json(*value) : json(); }

json faults_to_json(const Why& why) {
  json faults = json::array();
  for (const std::size_t f : order_of_faults(why)) {
    const faultsim::FaultStageMetrics& m = why.metrics.faults[f];
    json one = {{"fault", m.fault},
                {"slides", m.activated},
                {"activation_resolved", m.activation_resolved},
                {"chi_bar", m.chi_bar},
                {"step_of_largest_chi_bar", step_of_largest_chi(why, f)},
                {"activation", nullptr}};
    if (m.activation) {
      const faultsim::SidePressures& p = m.activation->pressures;
      const faultsim::StepResult* step = step_of(why.stored.result, m.activation->step);
      one["activation"] = {{"step", m.activation->step},
                           {"stage", step != nullptr ? json(step->stage) : json()},
                           {"time_s", step != nullptr ? json(step->time) : json()},
                           {"depth_m", m.activation->depth},
                           {"region_minus", p.region_minus},
                           {"change_minus_pa", optional_json(p.change_minus)},
                           {"absolute_minus_pa", optional_json(p.absolute_minus)},
                           {"region_plus", p.region_plus},
                           {"change_plus_pa", optional_json(p.change_plus)},
                           {"absolute_plus_pa", optional_json(p.absolute_plus)},
                           {"change_in_fault_pa", finite(p.change_in_fault)}};
    }
    faults.push_back(std::move(one));
  }
  return faults;
}

}  // namespace

json why_to_json(const Why& why) {
  const auto parameters = parameters_from_json(why.ranking.campaign.parameters);
  json local = json::array();
  for (const Neighbour& one : why.neighbours) {
    local.push_back({{"parameter", one.parameter},
                     {"from", one.from},
                     {"to", one.to},
                     {"case", one.row.position},
                     {"value", finite(one.value)},
                     {"change", finite(one.change)}});
  }
  const Place& place = why.place;
  return {{"campaign", why.ranking.campaign.name},
          {"case", why.row.position},
          {"parameters", values_to_json(why.row.parameters, parameters)},
          {"stage", why.ranking.request.stage},
          {"fault", why.ranking.request.fault},
          {"outcome", why.row.outcome},
          {"compared", why.compared},
          {"value", finite(why.value)},
          {"faults", faults_to_json(why)},
          {"place",
           {{"place", place.place},
            {"of", place.n_ranked},
            {"rank_class", why.row.rank_class},
            {"ties", place.ties},
            {"mesh_error_rms", place.error ? json(place.error->rms) : json()}}},
          {"local", std::move(local)},
          {"global", why.global ? json(render_json(to_answer(*why.global))) : json()},
          {"no_global", why.no_global}};
}

}  // namespace faultsweep
