#include "campaign/answers/one_at_a_time.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "campaign/answers/sample.h"
#include "campaign/answers/sensitivity_parts.h"
#include "campaign/common/names.h"
#include "campaign/query/table_output.h"
#include "campaign/render/shown.h"

namespace faultsweep {

namespace figure = faultsim::figure;

namespace {

constexpr const char* kGroup = "group";  // the parameter of campaigns with several

/// What is read of a case.
struct CaseValues {
  Move move;
  bool is_complete = false;
  CaseParameters parameters;
};

CaseValues values_of(const CaseRow& row) {
  CaseValues values{{}, row.complete(), row.parameters};
  values.move.position = row.position;
  values.move.is_unresolved = row.rank_class && *row.rank_class == 1;
  for (const Cell& one : row.metrics)
    values.move.metrics.push_back(row.complete() ? number_of(one) : kNoNumber);
  return values;
}

/// The cases of each group in the order of its rows; one that several rows became stands in each.
std::vector<std::vector<long>> rows_of_groups(const Store& store, const CampaignInfo& campaign,
                                              const nlohmann::json& groups,
                                              const std::map<long, CaseValues>& cases) {
  std::vector<std::vector<long>> rows(groups.size());
  const std::vector<DesignRow> merged = store.design_rows(campaign.id);
  for (const DesignRow& one : merged)
    rows.at(static_cast<std::size_t>(one.design)).push_back(one.position);
  if (!merged.empty()) return rows;
  for (const auto& [position, values] : cases) {  // each row is a case of its own
    std::size_t group = 0;
    while (groups.size() > 1 && groups[group].at("name") != values.parameters.at(0).text) ++group;
    rows.at(group).push_back(position);
  }
  return rows;
}

/// The parameters that a group's design moves, as indices: not those derived from them.
std::set<int> moved_by(const nlohmann::json& group, const std::vector<std::string>& parameters) {
  std::set<int> indices;
  for (const nlohmann::json& one : group.at("parameters")) {
    const auto at = std::ranges::find(parameters, one.at("name").get<std::string>());
    if (at != parameters.end()) indices.insert(static_cast<int>(at - parameters.begin()));
  }
  return indices;
}

/// The places, in the other's parameters, of those in which it differs from the base case.
std::vector<std::size_t> differences(const CaseParameters& base, const CaseParameters& other,
                                     const std::set<int>& moved) {
  std::vector<std::size_t> found;
  for (std::size_t k = 0; k < other.size(); ++k) {
    if (!moved.contains(other[k].index)) continue;
    const auto same = std::ranges::find_if(base, [&](const CaseParameter& one) {
      return one.index == other[k].index && one.si == other[k].si &&
             (one.si || one.text == other[k].text);
    });
    if (same == base.end()) found.push_back(k);
  }
  return found;
}

Tornado tornado_of(const std::vector<long>& rows, const std::map<long, CaseValues>& cases,
                   const std::set<int>& moved) {
  const CaseValues& base = cases.at(rows.front());
  Tornado tornado{"", base.move, {}};
  for (const long position : rows) {
    const CaseValues& values = cases.at(position);
    const auto differing = differences(base.parameters, values.parameters, moved);
    if (differing.empty()) continue;  // the base case once more
    if (differing.size() > 1) {       // a case of another group, which this row became
      ++tornado.n_unplaced;
      continue;
    }
    const CaseParameter& parameter = values.parameters[differing.front()];
    Move move = values.move;
    move.parameter = static_cast<std::size_t>(parameter.index);
    move.value = parameter.text;
    tornado.n_without += values.is_complete ? 0 : 1;
    tornado.moves.push_back(std::move(move));
  }
  return tornado;
}

/// The least and greatest of a metric as one parameter moves, the base case among them; what
/// differs by rounding only does not move.
struct Swing {
  std::size_t parameter = 0;
  double low = 0, high = 0;                          ///< of the metric.
  const Move *at_low = nullptr, *at_high = nullptr;  ///< nullptr = the base case.
  long n = 0;                                        ///< moves that have a value.
  bool is_unresolved = false;                        ///< one of the two ends.
  double width() const { return high - low; }
};

/// The widest first.
std::vector<Swing> swings_of(const OneAtATime& found, const Tornado& tornado, std::size_t m) {
  const double base = tornado.base.metrics[m];
  std::vector<Swing> swings;
  for (std::size_t p = 0; p < found.parameters.size(); ++p) {
    Swing swing{p, base, base};
    for (const Move& one : tornado.moves) {
      const double value = one.metrics[m];
      if (one.parameter != p || !std::isfinite(value)) continue;
      ++swing.n;
      if (value < swing.low) swing.low = value, swing.at_low = &one;
      if (value > swing.high) swing.high = value, swing.at_high = &one;
    }
    if (is_rounding(found.outputs[m], swing.low, swing.high)) {
      swing.low = swing.high = base;
      swing.at_low = swing.at_high = nullptr;
    }
    for (const Move* end : {swing.at_low, swing.at_high})
      swing.is_unresolved = swing.is_unresolved || (end != nullptr && end->is_unresolved);
    if (swing.n > 0) swings.push_back(swing);
  }
  std::ranges::stable_sort(swings,
                           [](const Swing& a, const Swing& b) { return a.width() > b.width(); });
  return swings;
}

bool is_moved(const OneAtATime& found, const Tornado& tornado, std::size_t m) {
  if (!std::isfinite(tornado.base.metrics[m])) return false;
  const std::vector<Swing> swings = swings_of(found, tornado, m);
  return std::ranges::any_of(swings, [](const Swing& one) { return one.width() > 0; });
}

std::string place_of(const Move* at) { return at == nullptr ? "base" : at->value; }

constexpr int kSwingDigits = 3;

/// "F1.chi_bar", or with groups "F1.chi_bar about the reference".
std::string name_of(const OneAtATime& found, const Tornado& tornado, std::size_t m) {
  return concat(found.outputs[m].name, tornado.group.empty() ? "" : ", ", tornado.group);
}

/// "F1.chi_bar is 0.71 in the base case and changes most with offset: 0.52 (0 m) to 0.93 (120 m)."
std::string sentence_of(const OneAtATime& found, const Tornado& tornado, std::size_t m) {
  const ShownUnit unit = unit_of(found.outputs[m], found.plane_strain);
  const auto number = [&](double value) { return in_unit(value, unit, kSwingDigits); };
  const Swing most = swings_of(found, tornado, m).front();
  return concat(name_of(found, tornado, m), tornado.group.empty() ? " is " : ": ",
                number(tornado.base.metrics[m]), " in the base case; it changes most with ",
                found.parameters[most.parameter], ": ", number(most.low), " (",
                place_of(most.at_low), ") to ", number(most.high), " (", place_of(most.at_high),
                ").");
}

AnswerTable move_table(const OneAtATime& found) {
  AnswerTable table{"moves",
                    "",
                    {{"group", "group"},
                     {"metric", "metric"},
                     {"unit", "unit"},
                     {"parameter", "parameter"},
                     {"value", "value"},
                     {"case", "case"},
                     {"result", "result"},
                     {"change", "change"},
                     {"unresolved", "unresolved"}}};
  for (const Tornado& tornado : found.tornados) {
    for (std::size_t m = 0; m < found.outputs.size(); ++m) {
      const std::string unit = unit_of(found.outputs[m], found.plane_strain).si;
      const auto add = [&](const Move& one, const std::string& parameter) {
        table.rows.push_back({tornado.group, found.outputs[m].name, unit, parameter, one.value,
                              one.position, one.metrics[m],
                              one.metrics[m] - tornado.base.metrics[m], one.is_unresolved});
      };
      add(tornado.base, "");
      for (const Move& one : tornado.moves) add(one, found.parameters[one.parameter]);
    }
  }
  table.on_screen = false;
  return table;
}

AnswerTable swing_table(const OneAtATime& found, const Tornado& tornado, std::size_t m) {
  const ShownUnit unit = unit_of(found.outputs[m], found.plane_strain);
  AnswerTable table{
      "swings",
      concat(name_of(found, tornado, m), ": ", in_unit(tornado.base.metrics[m], unit, kSwingDigits),
             " in the base case"),
      {{"parameter", "parameter", {}, 4, Need::always},
       {"least", "least", unit, kSwingDigits, Need::always},
       {"least_at", "at", {}, 4, Need::always},
       {"most", "most", unit, kSwingDigits, Need::always},
       {"most_at", "at", {}, 4, Need::always},
       {"swing", "swing", unit, kSwingDigits, Need::always},
       {"values", "values"}}};
  for (const Swing& one : swings_of(found, tornado, m)) {
    const char* note = one.is_unresolved ? "unresolved" : "";
    table.rows.push_back({found.parameters[one.parameter], one.low, place_of(one.at_low), one.high,
                          place_of(one.at_high), AnswerCell(one.width(), kNoNumber, note), one.n});
  }
  table.in_files = false;
  return table;
}

figure::IntervalChart chart_of(const OneAtATime& found, const Tornado& tornado, std::size_t m) {
  const ShownUnit unit = unit_of(found.outputs[m], found.plane_strain);
  figure::IntervalChart chart;
  chart.title = concat("What one parameter changes of ", name_of(found, tornado, m));
  chart.remark = concat(found.campaign.name, "; dots: the base case; lines: over the values given");
  chart.label = found.outputs[m].name + (unit.name.empty() ? "" : ", " + unit.name);
  for (const Swing& one : swings_of(found, tornado, m)) {
    chart.rows.push_back(
        {found.parameters[one.parameter],
         {tornado.base.metrics[m] / unit.size, one.low / unit.size, one.high / unit.size},
         one.width() > 0 ? concat(place_of(one.at_low), " to ", place_of(one.at_high))
                         : std::string("no change")});
  }
  return chart;
}

/// "12 cases beside the base case, case 1; 2 without a history to its end".
std::string rows_text(const Tornado& tornado) {
  const auto n_unresolved =
      std::ranges::count_if(tornado.moves, [](const Move& one) { return one.is_unresolved; });
  std::string rows = concat(tornado.group, tornado.group.empty() ? "" : ": ", tornado.moves.size(),
                            " cases besides the base case, case ", tornado.base.position);
  if (tornado.n_without > 0) rows += concat("; ", tornado.n_without, " without a full history");
  if (n_unresolved > 0) {
    rows += concat("; ", n_unresolved,
                   " with an activation or event that the cells do not resolve, which count as "
                   "computed");
  }
  if (tornado.n_unplaced > 0) {
    rows += concat("; ", tornado.n_unplaced,
                   " left out, as they belong to another group and differ in more than one "
                   "parameter");
  }
  if (tornado.base.is_unresolved) rows += "; that of the base case is not resolved";
  return rows + ".";
}

void add_notes(const OneAtATime& found, Answer& answer) {
  answer.note(
      "One parameter at a time from one base case: the changes are exact for the values given. "
      "What several parameters do together, or from another base case, was not computed.");
  for (const Tornado& tornado : found.tornados) answer.note(rows_text(tornado));
  for (const std::string& group : found.without_base)
    answer.note(concat(group, ": its base case has no full history."));
  if (found.n_other_groups > 0)
    answer.note(concat("Groups of another design, not considered: ", found.n_other_groups, "."));
}

}  // namespace

std::optional<OneAtATime> compare_one_at_a_time(const Store& store, const CampaignInfo& campaign,
                                                const SensitivityRequest& request) {
  const auto groups = nlohmann::json::parse(store.spec_copies(campaign.id).resolved).at("groups");
  const auto is_one_at_a_time = [](const auto& one) { return one.at("kind") == "one-at-a-time"; };
  if (std::ranges::none_of(groups, is_one_at_a_time)) return std::nullopt;
  if (!request.cases.where.empty())
    throw InputError("sensitivity", "changes are measured from the base case", "leave out --where");
  const Selection selection =
      make_selection(store, campaign, request.cases.stage, request.cases.fault);
  OneAtATime found{campaign, request, {}, {}, {}, {}};
  found.outputs = asked_outputs(store, campaign, request, selection);
  found.plane_strain = kinds_of(store, campaign, selection, "").plane_strain;
  for (const StoredParameter& one : campaign.parameters) found.parameters.push_back(one.name);
  const bool has_groups = !found.parameters.empty() && found.parameters[0] == kGroup;
  std::map<long, CaseValues> cases;
  store.for_each_case(campaign.id, case_query(campaign, selection, "", found.outputs),
                      [&](const CaseRow& row) { cases.emplace(row.position, values_of(row)); });
  const auto rows = rows_of_groups(store, campaign, groups, cases);
  for (std::size_t g = 0; g < rows.size(); ++g) {
    if (!is_one_at_a_time(groups[g])) {
      ++found.n_other_groups;
      continue;
    }
    const std::string name = has_groups ? groups[g].at("name").get<std::string>() : "";
    if (rows[g].empty() || !cases.at(rows[g].front()).is_complete) {
      found.without_base.push_back(name);
      continue;
    }
    found.tornados.push_back(tornado_of(rows[g], cases, moved_by(groups[g], found.parameters)));
    found.tornados.back().group = name;
  }
  if (found.tornados.empty())
    refuse_unrun("sensitivity",
                 "the base case, from which changes are measured, has no full history", campaign);
  return found;
}

Answer to_answer(const OneAtATime& found) {
  Answer answer;
  std::string constant;
  std::size_t n_cases = 0;
  answer.add(move_table(found));
  std::vector<figure::IntervalChart> charts;
  for (const Tornado& tornado : found.tornados) {
    n_cases += 1 + tornado.moves.size();
    for (std::size_t m = 0; m < found.outputs.size(); ++m) {
      if (!is_moved(found, tornado, m)) {
        constant += (constant.empty() ? "" : "; ") + name_of(found, tornado, m);
        continue;
      }
      if (answer.headline.size() < kMostSentences)
        answer.headline.push_back(sentence_of(found, tornado, m));
      answer.add(swing_table(found, tornado, m));
      charts.push_back(chart_of(found, tornado, m));
    }
  }
  for (figure::IntervalChart& chart : charts)
    answer.blocks.emplace_back(AnswerChart(std::move(chart)));
  if (answer.headline.empty())
    answer.headline.emplace_back("No parameter alone changes any of these metrics.");
  answer.facts = {{"campaign", found.campaign.name}, {"kind", "one-at-a-time"}, {"cases", n_cases}};
  if (!constant.empty()) {
    answer.note(concat(
        "Changed by no parameter alone, or without a value in the base case: ", constant, "."));
  }
  add_notes(found, answer);
  return answer;
}

}  // namespace faultsweep
