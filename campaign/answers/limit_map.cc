#include <algorithm>
#include <map>

#include "campaign/answers/limit_words.h"
#include "campaign/common/names.h"
#include "campaign/spec/pointers.h"

namespace faultsweep {

namespace {

std::size_t place_of(const LimitTable& table, const std::string& name) {
  const auto found = std::ranges::find(table.parameters, name);
  if (found != table.parameters.end())
    return static_cast<std::size_t>(found - table.parameters.begin());
  std::string known = joined(table.parameters, ", ");
  throw InputError("--map", concat("there is no parameter '", name, "' in the design"),
                   concat("there are ", known));
}

/// Values of a parameter in the order of the configurations.
std::vector<std::string> values_of(const std::vector<const LimitRow*>& rows, std::size_t place) {
  std::vector<std::string> values;
  for (const LimitRow* row : rows) {
    const std::string& value = row->settings[place];
    if (!contains(values, value)) values.push_back(value);
  }
  return values;
}

/// By limit and fault, its brackets by the values of two parameters: down, across.
using LimitMaps = std::map<std::pair<std::size_t, std::string>,
                           std::map<std::pair<std::string, std::string>, std::string>>;

LimitMaps maps_of(const LimitTable& table, const std::vector<const LimitRow*>& rows,
                  std::size_t across, std::size_t down) {
  LimitMaps maps;
  for (const LimitRow* row : rows) {
    for (std::size_t l = 0; l < table.limits.size(); ++l) {
      if (!row->cells[l]) continue;
      const std::pair at(row->settings[down], row->settings[across]);
      if (!maps[{l, row->fault}].emplace(at, short_text(*row->cells[l])).second) {
        throw InputError("--map", "the design varies more than these two parameters",
                         "use --csv, or a design of two");
      }
    }
  }
  return maps;
}

}  // namespace

Answer map_answer(const LimitTable& table, const std::string& across, const std::string& down) {
  const std::size_t a = place_of(table, across), d = place_of(table, down);
  std::vector rows = mapped(table.rows, [&](const LimitRow& row) { return &row; });
  std::ranges::stable_sort(rows, [](const LimitRow* one, const LimitRow* other) {
    return one->configuration < other->configuration;
  });
  const std::vector<std::string> columns = values_of(rows, a), lines = values_of(rows, d);
  Answer answer = limits_for_files(table);
  for (const auto& [subject, brackets] : maps_of(table, rows, a, d)) {
    const LimitSearch& limit = table.limits[subject.first];
    AnswerTable shown{"map",
                      concat(limit.name, " of ", subject.second, ", [safe, unsafe]",
                             limit.unit.empty() ? "" : " in ", limit.unit, "; down: ", down,
                             ", across: ", across),
                      {{down, down, {}, 4, Need::always}}};
    for (const std::string& one : columns) shown.columns.push_back({one, one, {}, 4, Need::always});
    for (const std::string& line : lines) {
      std::vector<AnswerCell> cells = {line};
      for (const std::string& column : columns) {
        const auto found = brackets.find({line, column});
        cells.push_back(found == brackets.end() ? AnswerCell() : AnswerCell(found->second));
      }
      shown.rows.push_back(std::move(cells));
    }
    shown.notes.push_back(concat("all safe: safe in the whole range tried (", range_text(limit),
                                 "); all unsafe: unsafe already at ",
                                 value_text(limit.scan.front(), limit),
                                 "; *: safe again beyond the limit; ?: the cells do not resolve it "
                                 "there."));
    shown.in_files = false;
    answer.add(std::move(shown));
  }
  for (const LimitSearch& limit : table.limits) answer.note(question_text(limit));
  return answer;
}

}  // namespace faultsweep
