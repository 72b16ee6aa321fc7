#include "campaign/render/render.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "campaign/common/names.h"
#include "simulator/common/printable.h"

namespace faultsweep {

std::string exact_number(double value) {
  if (std::isnan(value)) return "nan";
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string csv_field(const std::string& text) {
  const bool is_comment = text.starts_with('#');  // in tables that are read again
  if (text.find_first_of(",\"\r\n") == std::string::npos && !is_comment) return text;
  std::string quoted = "\"";
  for (const char letter : text) quoted += letter == '"' ? "\"\"" : std::string(1, letter);
  return quoted + '"';
}

namespace {

/// "-5", "+1.5e3 bar".
bool is_quantity(const std::string& text) {
  double value = 0;
  const char* begin = text.data() + (text.front() == '+' ? 1 : 0);
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || rest == begin) return false;
  constexpr std::string_view kOfUnits =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789/ ";
  if (rest != end && *rest != ' ') return false;
  return std::string_view(rest, static_cast<std::size_t>(end - rest)).find_first_not_of(kOfUnits) ==
         std::string_view::npos;
}

std::string field_of(const AnswerValue& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "1" : "0";
  if (const auto* count = std::get_if<std::int64_t>(&value)) return std::to_string(*count);
  if (const auto* number = std::get_if<double>(&value))
    return std::isfinite(*number) ? exact_number(*number) : "";
  if (const auto* words = std::get_if<std::string>(&value)) return csv_name(*words);
  return "";
}

/// What a column has beside its values.
struct Beside {
  bool errors = false, notes = false;
};

Beside beside(const AnswerTable& table, std::size_t column) {
  Beside found;
  for (const auto& row : table.rows) {
    if (column >= row.size()) continue;
    found.errors = found.errors || std::isfinite(row[column].error);
    found.notes = found.notes || !row[column].note.empty();
  }
  return found;
}

}  // namespace

std::string csv_name(const std::string& text) {
  const bool is_formula = !text.empty() &&
                          std::string_view("=+-@").find(text.front()) != std::string_view::npos &&
                          !is_quantity(text);
  return csv_field((is_formula ? "'" : "") + faultsim::printable(text, faultsim::Keep::line_ends));
}

std::string render_csv(const AnswerTable& table) {
  std::vector<Beside> all;
  std::string text;
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    all.push_back(beside(table, k));
    const std::string name = csv_name(table.columns[k].key);
    text += (k == 0 ? "" : ",") + name;
    if (all[k].errors) text += "," + csv_name(table.columns[k].key + "_error");
    if (all[k].notes) text += "," + csv_name(table.columns[k].key + "_note");
  }
  text += '\n';
  for (const auto& row : table.rows) {
    for (std::size_t k = 0; k < table.columns.size(); ++k) {
      const AnswerCell cell = k < row.size() ? row[k] : AnswerCell{};
      text += (k == 0 ? "" : ",") + field_of(cell.value);
      if (all[k].errors) text += "," + field_of(cell.error);
      if (all[k].notes) text += "," + csv_name(cell.note);
    }
    text += '\n';
  }
  return text;
}

const AnswerTable& table_named(const Answer& answer, std::string_view key) {
  std::string names;
  for (const AnswerBlock& block : answer.blocks) {
    const auto* table = std::get_if<AnswerTable>(&block);
    if (table == nullptr || !table->in_files) continue;
    if (key.empty() || table->key == key) return *table;
    names += concat(names.empty() ? "" : ", ", table->key);
  }
  throw InputError("--csv", concat("there is no table '", key, "'"),
                   names.empty() ? "this answer has no table" : concat("there are: ", names));
}

}  // namespace faultsweep
