#include "campaign/render/render.h"

#include <cmath>

#include "campaign/common/json.h"
#include "simulator/common/errors.h"

namespace faultsweep {

namespace {

ordered_json number(double value) { return std::isfinite(value) ? ordered_json(value) : nullptr; }

ordered_json value_of(const AnswerValue& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag;
  if (const auto* count = std::get_if<std::int64_t>(&value)) return *count;
  if (const auto* one = std::get_if<double>(&value)) return number(*one);
  if (const auto* words = std::get_if<std::string>(&value)) return *words;
  return nullptr;
}

ordered_json row_of(const AnswerTable& table, const std::vector<AnswerCell>& cells) {
  ordered_json row = ordered_json::object();
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    const AnswerColumn& column = table.columns[k];
    const AnswerCell cell = k < cells.size() ? cells[k] : AnswerCell{};
    ordered_json& object = column.group.empty() ? row : row[column.group];
    object[column.key] = value_of(cell.value);
    if (std::isfinite(cell.error)) object[column.key + "_error"] = cell.error;
    if (!cell.note.empty()) object[column.key + "_note"] = cell.note;
  }
  return row;
}

ordered_json rows_of(const AnswerTable& table) {
  ordered_json rows = ordered_json::array();
  for (const auto& cells : table.rows) rows.push_back(row_of(table, cells));
  return rows;
}

void add_table(ordered_json& document, ordered_json& columns, const AnswerTable& table) {
  FAULTSIM_DEMAND(!document.contains(table.key), "two tables are called ", table.key);
  ordered_json described = ordered_json::array();
  for (const AnswerColumn& one : table.columns) {
    described.push_back({{"key", one.key}, {"heading", one.heading}, {"unit", one.unit.si}});
    if (!one.group.empty()) described.back()["in"] = one.group;
  }
  document[table.key] = rows_of(table);
  columns[table.key] = std::move(described);
}

}  // namespace

nlohmann::json json_rows(const AnswerTable& table) { return rows_of(table); }

ordered_json render_json(const Answer& answer) {
  ordered_json document = {{"format", kAnswerFormat}, {"headline", answer.headline}};
  document.update(answer.facts);
  ordered_json columns = ordered_json::object(), notes = ordered_json::array();
  for (const AnswerBlock& block : answer.blocks) {
    if (const auto* table = std::get_if<AnswerTable>(&block)) {
      if (table->in_files) add_table(document, columns, *table);
      for (const std::string& note : table->notes) notes.push_back(note);
    } else if (const auto* note = std::get_if<AnswerNote>(&block)) {
      notes.push_back(note->text);
    }
  }
  document["columns"] = std::move(columns);
  document["notes"] = std::move(notes);
  return document;
}

}  // namespace faultsweep
