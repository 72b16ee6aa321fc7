#include <algorithm>
#include <cmath>

#include "campaign/answers/why.h"
#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/query/parameters.h"
#include "campaign/query/place_columns.h"
#include "campaign/render/shown.h"
#include "campaign/spec/metrics.h"

namespace faultsweep {

namespace {

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
                 const std::optional<double>& absolute, RegionPressures kind) {
  if (!change) return "";
  return concat(region, " has changed by ", format_number(*change / kBar, 4), " bar",
                kind == RegionPressures::means ? " on average" : "",
                absolute ? concat(" (", format_number(*absolute / kBar, 4), " bar absolute)")
                         : std::string());
}

std::string pressures(const faultsim::SidePressures& p, RegionPressures kind) {
  const std::string minus = side(p.region_minus, p.change_minus, p.absolute_minus, kind);
  const std::string plus = side(p.region_plus, p.change_plus, p.absolute_plus, kind);
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
                  when(result, step_of_largest_chi(why, f)), ".");
  }
  std::string text = m.fault + " slides";
  if (m.activation) {
    text += concat(" first ", when(result, m.activation->step), ", at ",
                   format_number(m.activation->depth), " m depth", sure, ": ",
                   pressures(m.activation->pressures, why.ranking.pressures));
  }
  const std::string stages = sliding_stages(result, f);
  if (why.metrics.stage.empty() && !stages.empty())
    text += "; counting slip within each stage, in " + stages;
  return text + ".";
}

/// Faults in the order in which they slide, then those that do not by χ̄, largest first.
std::vector<std::size_t> order_of_faults(const Why& why) {
  std::vector<std::size_t> order;
  for (std::size_t f = 0; f < why.metrics.faults.size(); ++f) {
    const bool asked = why.ranking.request.fault.empty() ||
                       why.ranking.request.fault == why.metrics.faults[f].fault;
    if (asked) order.push_back(f);
  }
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    const auto &ma = why.metrics.faults[a], &mb = why.metrics.faults[b];
    if (ma.activated != mb.activated) return ma.activated;
    if (ma.activation && mb.activation) return ma.activation->step < mb.activation->step;
    return ma.chi_bar > mb.chi_bar;
  });
  return order;
}

/// What every fault does, and how far it is from sliding.
std::vector<std::string> what_happens(const Why& why) {
  std::vector sentences =
      mapped(order_of_faults(why), [&](const std::size_t& f) { return fault_sentence(why, f); });
  const double margin = why.row.pressure_margin.value_or(NAN);
  if (why.metrics.stage.empty() && std::isfinite(margin)) {
    sentences.push_back(concat("By linear extrapolation, χ̄ would be 1 after ",
                               format_number(margin / kBar, 3), " bar more."));
  }
  return sentences;
}

/// Of what is compared.
ShownUnit unit_of(const Why& why) {
  if (why.ranking.by_default && why.compared == "chi_bar") return plain();
  return why.ranking.by_unit;
}

std::string named_cases(const std::vector<long>& positions) {
  std::string text;
  for (std::size_t k = 0; k < std::min(positions.size(), kMostNamed); ++k)
    text += concat(k == 0 ? "" : ", ", positions[k]);
  if (positions.size() > kMostNamed)
    text += concat(" and ", positions.size() - kMostNamed, " more");
  return text;
}

const char* kind_of(int rank_class) {
  constexpr const char* kKinds[] = {
      "complete histories", "histories that depend on the mesh, which are ranked separately",
      "histories that end early, which have no rank"};
  return kKinds[std::clamp(rank_class, 0, 2)];
}

/// "Case 17 of sweep (offset = 100 m) ranks 3 of 240 complete histories: chi_bar 0.83."
std::string place_sentence(const Why& why) {
  const auto& parameters = why.ranking.campaign.parameters;
  const std::string settings = settings_of(why.row.parameters, parameters, short_number);
  return concat("Case ", why.row.position, " of ", why.ranking.campaign.name,
                settings.empty() ? "" : concat(" (", settings, ")"), " ranks ", why.place.place,
                " of ", why.place.n_ranked, " ", kind_of(why.row.rank_class), ": ", why.compared,
                " = ", in_unit(why.value, unit_of(why)), ".");
}

/// How sure the place is.
std::string confidence_note(const Why& why) {
  const Place& place = why.place;
  const bool has_one = place.ties.size() == 1;
  const std::string ties =
      concat(place.ties.size(), has_one ? " case (" : " cases (", named_cases(place.ties), ")");
  if (place.error) {
    const bool named = place.error->n_cases == 0;
    return concat("The mesh makes an error of ", format_number(place.error->rms, 2),
                  named ? " (rms that the tier " : " (rms at ", place.error->tier,
                  named ? " names, against " : " against ", place.error->reference, "): ",
                  place.ties.empty() ? "no other case is" : ties + (has_one ? " is" : " are"),
                  " within √2 times that; the order among those means nothing.");
  }
  const std::string same =
      place.ties.empty() ? "" : concat(ties, has_one ? " has" : " have", " the very same value. ");
  return concat(same, "The error of the mesh in ", why.compared,
                " was not measured for this campaign, so cases closer than that are not "
                "told apart here: faultsweep tradeoff SPEC measures that of chi_bar and "
                "max_slip.");
}

AnswerTable faults_table(const Why& why) {
  AnswerTable table{"faults",
                    "",
                    {{"fault", "fault", {}, 4, Need::always},
                     {"slides", "slides", {}, 4, Need::always},
                     {"activation_resolved", "resolved", {}, 4, Need::always},
                     {"chi_bar", "χ̄", {}, 3, Need::always},
                     {"step_of_largest_chi_bar", "its step", {}, 4, Need::wanted},
                     {"stage", "slides first in", {}, 4, Need::wanted, "activation"},
                     {"time_s", "at", shown_unit(Dimension::time), 4, Need::wanted, "activation"}}};
  append(table.columns, onset_columns(why.ranking.pressures, "activation", Need::extra));
  for (const std::size_t f : order_of_faults(why)) {
    const faultsim::FaultStageMetrics& m = why.metrics.faults[f];
    const faultsim::StepResult* step =
        m.activation ? step_of(why.stored.result, m.activation->step) : nullptr;
    table.rows.push_back({m.fault, m.activated, m.activation_resolved, m.chi_bar,
                          step_of_largest_chi(why, f),
                          step != nullptr ? AnswerCell(step->stage) : AnswerCell(),
                          step != nullptr ? AnswerCell(step->time) : AnswerCell()});
    add_onset(m.activation ? &*m.activation : nullptr, table.rows.back());
  }
  table.notes = {pressure_note(why.ranking.pressures)};
  return table;
}

/// What every table of other cases says of them.
std::vector<AnswerColumn> compared_columns(const Why& why) {
  const ShownUnit unit = unit_of(why);
  return {{"value", why.compared, unit, 4, Need::always},
          {"change", "change", unit, 3, Need::always},
          {"slides", "slides", {}, 4, Need::wanted},
          {"resolved", "resolved", {}, 4, Need::wanted}};
}

void add_compared(const RankedCase& row, double value, double change,
                  std::vector<AnswerCell>& cells) {
  append(cells, {value, change, measures_of(row).activated, is_resolved(row)});
}

AnswerTable local_table(const Why& why) {
  AnswerTable table{"local",
                    "One parameter moved:",
                    {{"parameter", "parameter", {}, 4, Need::always},
                     {"from", "here", {}, 4, Need::always},
                     {"to", "there", {}, 4, Need::always},
                     {"case", "case", {}, 4, Need::always}}};
  append(table.columns, compared_columns(why));
  for (const Neighbour& one : why.neighbours) {
    table.rows.push_back({one.parameter, one.from, one.to, one.row.position});
    add_compared(one.row, one.value, one.change, table.rows.back());
  }
  return table;
}

AnswerTable nearest_table(const Why& why) {
  std::vector rows = mapped(why.nearest, [&](const NearCase& one) { return &one.row.parameters; });
  const ParameterColumns parameters(why.ranking.campaign.parameters, rows);
  AnswerTable table{
      "nearest",
      "The nearest cases, as none differs in one parameter alone:",
      {{"case", "case", {}, 4, Need::always}, {"distance", "distance", {}, 3, Need::always}}};
  append(table.columns, compared_columns(why));
  append(table.columns, parameters.columns());
  for (const NearCase& one : why.nearest) {
    std::vector<AnswerCell> cells = {one.row.position, one.distance};
    add_compared(one.row, one.value, one.change, cells);
    parameters.add_cells(one.row.parameters, cells);
    table.rows.push_back(std::move(cells));
  }
  table.notes = {
      "distance: root of the sum of squares of each parameter's difference over its standard "
      "deviation in the campaign, or 1 where words differ"};
  return table;
}

/// The largest first.
std::vector<Slope> sorted_slopes(const Why& why) {
  std::vector<Slope> slopes = why.plane.slopes;
  std::ranges::stable_sort(slopes, [](const Slope& a, const Slope& b) {
    return std::abs(a.per_deviation) > std::abs(b.per_deviation);
  });
  return slopes;
}

AnswerTable slopes_table(const Why& why) {
  const auto& parameters = why.ranking.campaign.parameters;
  AnswerTable table{
      "slopes",
      "What each parameter does near this case:",
      {{"parameter", "parameter", {}, 4, Need::always},
       {"per_deviation", why.compared + " per standard deviation", unit_of(why), 3, Need::always},
       {"standard_deviation", "standard deviation, SI", {}, 3, Need::wanted},
       {"unit", "unit", {}, 4, Need::wanted},
       {"slope", "slope, SI", {}, 3, Need::data}}};
  for (const Slope& one : sorted_slopes(why)) {
    table.rows.push_back({parameters[one.column].name,
                          {one.per_deviation, one.error},
                          one.deviation,
                          faultsim::si_unit(parameters[one.column].dimension),
                          {one.per_deviation / one.deviation, one.error / one.deviation}});
  }
  table.notes = {concat("by a plane through the ", why.plane.n_cases,
                        " nearest cases with the same words, up to ",
                        format_number(why.plane.radius, 2),
                        " standard deviations away, nearer ones weighted more; ± is the standard "
                        "error from their scatter about it (",
                        in_unit(why.plane.scatter, unit_of(why)),
                        "). A slope is that of this neighbourhood, not of the case alone.")};
  return table;
}

AnswerTable global_table(const Why& why) {
  AnswerTable table{"global",
                    "",
                    {{"parameter", "parameter", {}, 4, Need::always},
                     {"first_order", "share alone", {}, 2, Need::always},
                     {"low", "from", {}, 2, Need::always},
                     {"high", "to", {}, 2, Need::always}}};
  if (!why.global) return table;
  const MetricSensitivity& metric = why.global->metrics.front();
  for (std::size_t k = 0; k < metric.first_order.size(); ++k) {
    const Estimate& e = metric.first_order[k];
    table.rows.push_back({why.global->parameters[k], e.value, e.bounds.low, e.bounds.high});
  }
  std::ranges::stable_sort(table.rows, [](const auto& a, const auto& b) {
    return std::get<double>(a[1].value) > std::get<double>(b[1].value);
  });
  table.title = "Over the whole campaign:";
  table.notes = {concat("share of the variance of ", why.compared, " over ", metric.n,
                        " cases that a parameter explains alone, with its interval of ",
                        confidence_text(why.global->request.confidence))};
  if (!why.global->sampling.remark.empty()) table.notes.push_back(why.global->sampling.remark);
  return table;
}

/// What changes it most near the case; "" where nothing says so.
std::string most_sentence(const Why& why) {
  if (!why.neighbours.empty()) {
    const Neighbour& most = why.neighbours.front();
    if (!(std::abs(most.change) > 0))
      return concat("No parameter changes ", why.compared, " on its own.");
    return concat("The largest change is with ", most.parameter, ": from ", short_number(most.from),
                  " to ", short_number(most.to), ", ", why.compared, " goes from ",
                  in_unit(why.value, unit_of(why)), " to ", in_unit(most.value, unit_of(why)), ".");
  }
  if (why.plane.slopes.empty()) return "";
  constexpr double kSure = 2;  // standard errors
  const Slope most = sorted_slopes(why).front();
  const std::string name = why.ranking.campaign.parameters[most.column].name;
  const double size = unit_of(why).size;
  const std::string unit = unit_of(why).name;
  if (std::abs(most.per_deviation) < kSure * most.error)
    return concat("Near this case, no parameter certainly changes ", why.compared, ".");
  return concat("Near this case, ", why.compared, " changes most with ", name, ": by ",
                with_error(most.per_deviation / size, most.error / size), unit.empty() ? "" : " ",
                unit, " for each of its standard deviations.");
}

nlohmann::ordered_json facts_of(const Why& why) {
  const auto& parameters = why.ranking.campaign.parameters;
  nlohmann::ordered_json settings = nlohmann::ordered_json::object();
  for (const CaseParameter& one : why.row.parameters)
    settings[parameters.at(static_cast<std::size_t>(one.index)).name] = value_to_json(one);
  const Place& place = why.place;
  return {{"campaign", why.ranking.campaign.name},
          {"case", why.row.position},
          {"parameters", std::move(settings)},
          {"stage", why.ranking.request.stage},
          {"fault", why.ranking.request.fault},
          {"outcome", why.row.outcome},
          {"resolved", is_resolved(why.row)},
          {"compared", why.compared},
          {"value", std::isfinite(why.value) ? json(why.value) : json()},
          {"place",
           {{"place", place.place},
            {"of", place.n_ranked},
            {"rank_class", why.row.rank_class},
            {"ties", place.ties},
            {"mesh_error_rms", place.error ? json(place.error->rms) : json()},
            {"mesh_error_of", place.error ? json(place.error->reference) : json()}}},
          {"no_slopes", why.plane.reason},
          {"no_global", why.no_global}};
}

}  // namespace

Answer to_answer(const Why& why) {
  const std::vector<std::string> happens = what_happens(why);
  Answer answer{{place_sentence(why)}};
  if (!happens.empty()) answer.headline.push_back(happens.front());
  const std::string most = most_sentence(why);
  if (!most.empty()) answer.headline.push_back(most);
  answer.facts = facts_of(why);
  for (std::size_t k = 1; k < happens.size(); ++k) answer.note(happens[k]);
  answer.note(confidence_note(why));
  answer.note_if(why.ranking.approximation);
  for (AnswerTable table : {faults_table(why), local_table(why), nearest_table(why),
                            slopes_table(why), global_table(why)}) {
    if (table.rows.empty()) {  // its key stands in JSON all the same
      table.title.clear();
      table.notes.clear();
    }
    answer.add(std::move(table));
  }
  if (why.neighbours.empty() && !why.plane.reason.empty())
    answer.note(concat("No local slopes: ", why.plane.reason, "."));
  if (!why.global) answer.note(concat("No global measure: ", why.no_global));
  return answer;
}

}  // namespace faultsweep
