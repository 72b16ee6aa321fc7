#include <algorithm>

#include "campaign/answers/limit_words.h"
#include "campaign/common/names.h"

namespace faultsweep {

namespace {

/// "≥ 110 bar": of a band, in the unit of the first limit.
AnswerCell band_cell(const LimitTable& table, const LimitRow& row) {
  if (!row.width) return {};
  return concat(row.is_open ? "≥ " : "", value_text(*row.width, table.limits.front()));
}

std::vector<AnswerColumn> screen_columns(const LimitTable& table) {
  std::vector<AnswerColumn> columns = {{"rank", "rank", {}, 4, Need::always}};
  for (const std::string& name : table.parameters)
    columns.push_back({name, name, {}, 4, Need::always});
  columns.push_back({"fault", "fault", {}, 4, Need::always});
  columns.push_back({"band", "band"});
  for (const LimitSearch& limit : table.limits) {
    const std::string name = table.limits.size() > 1 ? limit.name + " " : "";
    columns.push_back({"limit", name + "[safe, unsafe]", {}, 4, Need::always});
    columns.push_back({"surely", name + "surely"});
    columns.push_back({"datum", name + "safe at the datum", shown_unit(Dimension::pressure), 5});
    columns.push_back({"cases", name + "cases"});
    columns.push_back({"remark", name + "remark"});
  }
  return columns;
}

void add_limit(const LimitRow& row, std::size_t l, const LimitSearch& limit,
               std::vector<AnswerCell>& cells) {
  if (!row.cells[l]) {
    cells.resize(cells.size() + 5);
    return;
  }
  const LimitCell& cell = *row.cells[l];
  const Crossing* c = cell.finding.limit();
  cells.emplace_back(limit_text(cell, limit));
  cells.emplace_back(sure_text(cell, limit));
  cells.push_back(cell.datum ? AnswerCell(cell.datum->absolute) : AnswerCell());
  cells.push_back(c != nullptr ? AnswerCell(concat(c->before.position, "|", c->after.position))
                               : AnswerCell());
  cells.emplace_back(remark_of(cell));
}

/// For a screen: a row per configuration and fault, the narrowest band first.
AnswerTable screen_table(const LimitTable& table, long top) {
  AnswerTable all{"limits", "", screen_columns(table)};
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    const LimitRow& row = table.rows[k];
    std::vector<AnswerCell> cells = {row.width ? AnswerCell(k + 1) : AnswerCell()};
    cells.insert(cells.end(), row.settings.begin(), row.settings.end());
    append(cells, {row.fault, band_cell(table, row)});
    for (std::size_t l = 0; l < table.limits.size(); ++l) add_limit(row, l, table.limits[l], cells);
    all.rows.push_back(std::move(cells));
  }
  all.most_on_screen = static_cast<std::size_t>(top);
  all.in_files = false;
  return all;
}

bool all_resolved(const LimitTable& table) {
  return std::ranges::all_of(table.rows, [](const LimitRow& row) {
    return std::ranges::all_of(row.cells,
                               [](const auto& cell) { return !cell || is_resolved(*cell); });
  });
}

}  // namespace

Answer to_answer(const LimitTable& table, long top) {
  Answer answer = limits_for_files(table);
  for (std::size_t l = 0; l < table.limits.size(); ++l)
    if (auto chart = limit_chart(table, l))
      answer.blocks.emplace_back(AnswerChart(std::move(*chart)));
  answer.add(screen_table(table, top));
  for (const LimitSearch& limit : table.limits) answer.note(question_text(limit));
  answer.note(concat(counted(table.rows.size(), "row", "rows"),
                     ", narrowest band first. [safe, unsafe]: the last value that is safe and the "
                     "first that is not, both computed, in the cases given (faultsweep show); "
                     "nothing was computed between tried values with the same answer."));
  if (!all_resolved(table)) {
    answer.note(
        "The cells or their error leave open in places whether it happens: [safe, unsafe] is the "
        "result on "
        "these cells; `surely` gives the surely safe and the surely unsafe value, between which it "
        "is undecided. Both are values that were tried; smaller cells bring them closer together.");
  }
  return answer;
}

}  // namespace faultsweep
