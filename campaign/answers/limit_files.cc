#include <algorithm>
#include <cmath>

#include "campaign/answers/limit_words.h"
#include "campaign/common/json.h"
#include "campaign/common/names.h"

namespace faultsweep {

namespace {

AnswerCell number_cell(const std::optional<SearchPoint>& point, const LimitSearch& limit) {
  return point ? AnswerCell(si_of(point->value, limit)) : AnswerCell();
}

/// "offset = 200 m, friction_angle = 20 deg".
std::string settings_text(const LimitTable& table, const LimitRow& row) {
  std::string text;
  for (std::size_t p = 0; p < table.parameters.size(); ++p)
    text += concat(text.empty() ? "" : ", ", table.parameters[p], " = ", row.settings[p]);
  return text;
}

/// The row whose limit comes first from the safe end; null where none has one.
const LimitRow* lowest_of(const LimitTable& table, std::size_t l) {
  const LimitRow* lowest = nullptr;
  double least = INFINITY;
  for (const LimitRow& row : table.rows) {
    const Crossing* crossing = row.cells[l] ? row.cells[l]->finding.limit() : nullptr;
    if (crossing == nullptr) continue;
    const double way = std::abs(crossing->before.value - table.limits[l].scan.front());
    if (!(way < least)) continue;
    least = way;
    lowest = &row;
  }
  return lowest;
}

/// "2 of 4 are safe in the whole range tried (...), 1 is unsafe already at ..."
std::string counts_text(const LimitTable& table, std::size_t l) {
  const LimitSearch& limit = table.limits[l];
  const auto count = [&](const auto& holds) {
    return std::ranges::count_if(table.rows, [&](const LimitRow& row) {
      return row.cells[l] && holds(row.cells[l]->finding);
    });
  };
  const long n = count([](const LimitFinding&) { return true; });
  std::string text;
  const auto add = [&](LimitVerdict verdict, const std::string& what) {
    const long some = count([&](const LimitFinding& f) { return f.verdict == verdict; });
    if (some == 0) return;
    text += concat(text.empty() ? concat(some, " of ", n) : concat(", ", some),
                   some == 1 ? " is " : " are ", what);
  };
  add(LimitVerdict::safe_throughout,
      concat("safe in the whole range tried (", range_text(limit), ")"));
  add(LimitVerdict::unsafe_throughout,
      concat("unsafe already at ", value_text(limit.scan.front(), limit)));
  add(LimitVerdict::limit, "safe up to a limit");
  add(LimitVerdict::non_monotone, "non-monotone");
  add(LimitVerdict::unknown, "not known");
  return text;
}

/// "surely safe at -75 bar, surely unsafe at -60 bar".
std::string sure_sentence(const LimitCell& cell, const LimitSearch& limit) {
  const auto &safe = cell.finding.surely_safe, &unsafe = cell.finding.surely_unsafe;
  return concat("surely safe ",
                safe ? concat("at ", value_text(safe->value, limit)) : std::string("nowhere"),
                ", surely unsafe ",
                unsafe ? concat("at ", value_text(unsafe->value, limit)) : std::string("nowhere"));
}

std::string sentence_of(const LimitTable& table, std::size_t l) {
  const LimitSearch& limit = table.limits[l];
  const LimitRow* lowest = lowest_of(table, l);
  std::string text = concat(limit.name, ": ", counts_text(table, l), ".");
  if (lowest == nullptr) return text;
  const LimitCell& cell = *lowest->cells[l];
  const Crossing& crossing = *cell.finding.limit();
  const std::string settings = settings_text(table, *lowest);
  text += concat(" The first limit, starting from ", value_text(limit.scan.front(), limit),
                 ", is that of ", lowest->fault, settings.empty() ? "" : concat(" at ", settings),
                 ": safe at ", value_text(crossing.before.value, limit), ", unsafe at ",
                 value_text(crossing.after.value, limit));
  return text + (is_resolved(cell) ? "." : concat("; ", sure_sentence(cell, limit), "."));
}

/// The columns of limit_table behind those of the parameters.
constexpr const char* kLimitKeys[] = {"fault",         "limit",
                                      "unit",          "verdict",
                                      "says",          "safe",
                                      "unsafe",        "safe_text",
                                      "unsafe_text",   "safe_case",
                                      "unsafe_case",   "narrow",
                                      "resolved",      "surely_safe",
                                      "surely_unsafe", "region",
                                      "datum_m",       "absolute_pa",
                                      "points",        "unknown_points",
                                      "band",          "band_may_be_wider",
                                      "remark"};

/// One for each of kLimitKeys.
std::vector<AnswerCell> cells_of(const LimitTable& table, const LimitRow& row, std::size_t l) {
  const LimitCell& cell = *row.cells[l];
  const LimitSearch& limit = table.limits[l];
  const Crossing* c = cell.finding.limit();
  const AnswerCell none;
  return {row.fault,
          limit.name,
          faultsim::si_unit(limit.dimension),
          to_string(cell.finding.verdict),
          limit_text(cell, limit),
          c != nullptr ? AnswerCell(si_of(c->before.value, limit)) : none,
          c != nullptr ? AnswerCell(si_of(c->after.value, limit)) : none,
          c != nullptr ? AnswerCell(value_text(c->before.value, limit)) : none,
          c != nullptr ? AnswerCell(value_text(c->after.value, limit)) : none,
          c != nullptr ? case_cell(c->before.position) : none,
          c != nullptr ? case_cell(c->after.position) : none,
          c != nullptr ? AnswerCell(c->narrow) : none,
          is_resolved(cell),
          number_cell(cell.finding.surely_safe, limit),
          number_cell(cell.finding.surely_unsafe, limit),
          cell.datum ? AnswerCell(cell.datum->region) : none,
          cell.datum ? AnswerCell(cell.datum->depth) : none,
          cell.datum ? AnswerCell(cell.datum->absolute) : none,
          cell.finding.points.size(),
          cell.finding.n_unknown,
          row.width ? AnswerCell(si_of(*row.width, table.limits.front())) : none,
          row.is_open,
          remark_of(cell)};
}

AnswerTable limit_table(const LimitTable& table) {
  AnswerTable all{"limits", "", {{"row", "row"}}};
  for (const std::string& name : table.parameters)
    all.columns.push_back({name, name, {}, 4, Need::wanted, "parameters"});
  for (const char* key : kLimitKeys) all.columns.push_back({key, key});
  for (const LimitRow& row : table.rows) {
    for (std::size_t l = 0; l < table.limits.size(); ++l) {
      if (!row.cells[l]) continue;
      std::vector<AnswerCell> cells = {row.configuration};
      cells.insert(cells.end(), row.settings.begin(), row.settings.end());
      append(cells, cells_of(table, row, l));
      all.rows.push_back(std::move(cells));
    }
  }
  all.on_screen = false;
  return all;
}

/// Every change between safe and unsafe, in the direction of its search.
AnswerTable crossing_table(const LimitTable& table) {
  AnswerTable all{"crossings", "", {}};
  for (const char* key :
       {"row", "fault", "limit", "unit", "before", "after", "before_case", "after_case",
        "before_resolved", "after_resolved", "safe_first", "narrow", "unknown"})
    all.columns.push_back({key, key});
  for (const LimitRow& row : table.rows) {
    for (std::size_t l = 0; l < table.limits.size(); ++l) {
      if (!row.cells[l]) continue;
      const LimitSearch& limit = table.limits[l];
      for (const Crossing& one : row.cells[l]->finding.crossings) {
        all.rows.push_back({row.configuration, row.fault, limit.name,
                            faultsim::si_unit(limit.dimension), si_of(one.before.value, limit),
                            si_of(one.after.value, limit), case_cell(one.before.position),
                            case_cell(one.after.position), one.before.resolved, one.after.resolved,
                            one.is_limit(), one.narrow, one.n_unknown});
      }
    }
  }
  all.on_screen = false;
  return all;
}

ordered_json searches_to_json(const LimitTable& table) {
  ordered_json searches = ordered_json::array();
  for (const LimitSearch& one : table.limits) {
    searches.push_back({{"parameter", one.name},
                        {"faults", one.faults},
                        {"stage", one.stage},
                        {"unsafe", one.unsafe},
                        {"unit", one.unit},
                        {"tolerance", one.tolerance},
                        {"scan", one.scan}});
  }
  return searches;
}

}  // namespace

Answer limits_for_files(const LimitTable& table) {
  Answer answer;
  for (std::size_t l = 0; l < std::min(table.limits.size(), kMostSentences); ++l)
    answer.headline.push_back(sentence_of(table, l));
  if (!table.is_finished) answer.headline.emplace_back("The search has not ended: faultsweep run.");
  answer.facts = {{"campaign", table.campaign.name},
                  {"finished", table.is_finished},
                  {"searches", searches_to_json(table)}};
  answer.add(limit_table(table));
  answer.add(crossing_table(table));
  return answer;
}

}  // namespace faultsweep
