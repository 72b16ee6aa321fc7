#include "tests/verification/closed_forms/verify_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace faultsim {

void VerifyReport::compare(const std::string& quantity, const std::string& unit, double expected,
                           double computed, double tolerance, double scale) {
  const double error = std::abs(computed - expected) / scale;
  rows.push_back({quantity, expected, computed, error, tolerance, unit, error <= tolerance});
}

void VerifyReport::compare(const std::string& quantity, const std::string& unit, double expected,
                           double computed, double tolerance) {
  compare(quantity, unit, expected, computed, tolerance, expected == 0 ? 1 : std::abs(expected));
}

void VerifyReport::bound(const std::string& quantity, const std::string& unit, double error,
                         double tolerance) {
  rows.push_back({quantity, 0, error, error, tolerance, unit, error <= tolerance});
}

void VerifyReport::at_least(const std::string& quantity, double least, double computed) {
  const double shortfall = std::isnan(computed) ? computed : std::max(0.0, least - computed);
  rows.push_back({quantity + " at least", least, computed, shortfall, 0, "", computed >= least});
}

void VerifyReport::holds(const std::string& statement, bool is_true) {
  rows.push_back({statement, 1, is_true ? 1.0 : 0.0, is_true ? 0.0 : 1.0, 0, "", is_true});
}

bool VerifyReport::passed() const {
  return failure.empty() && !rows.empty() &&
         std::all_of(rows.begin(), rows.end(), [](const VerifyRow& row) { return row.pass; });
}

double observed_order(double coarse_error, double fine_error) {
  return std::log2(coarse_error / fine_error);
}

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

namespace {

std::string number(double value, const char* format = "%.9g") {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// Columns, not bytes: continuation bytes of UTF-8 take no room.
std::size_t columns_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t columns) {
  const std::size_t used = columns_of(text);
  return used < columns ? text + std::string(columns - used, ' ') : text;
}

std::vector<std::string> cells_of(const VerifyRow& row) {
  const std::string unit = row.unit.empty() ? "" : " " + row.unit;
  return {row.quantity,
          number(row.expected) + unit,
          number(row.computed) + unit,
          number(row.error, "%.2e"),
          number(row.tolerance, "%.2g"),
          row.pass ? "pass" : "MISS"};
}

std::vector<std::vector<std::string>> table_of(const VerifyReport& report) {
  std::vector<std::vector<std::string>> table = {
      {"quantity", "expected", "computed", "error", "tolerance", "result"}};
  for (const VerifyRow& row : report.rows) table.push_back(cells_of(row));
  return table;
}

/// '|' would end a cell of a Markdown table.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '|') result += '\\';
    result += c;
  }
  return result;
}

}  // namespace

std::string report_to_text(const VerifyReport& report) {
  const auto table = table_of(report);
  std::vector<std::size_t> widths(table.front().size(), 0);
  for (const auto& row : table) {
    for (std::size_t i = 0; i < row.size(); ++i)
      widths[i] = std::max(widths[i], columns_of(row[i]));
  }
  std::string text = report.name + "  " + report.title + "\n";
  for (const auto& row : table) {
    text += "  ";
    for (std::size_t i = 0; i < row.size(); ++i) {
      text += i + 1 < row.size() ? padded(row[i], widths[i] + 2) : row[i];
    }
    text += "\n";
  }
  for (const std::string& remark : report.remarks) text += "  " + remark + "\n";
  if (!report.failure.empty()) text += "  FAILED: " + report.failure + "\n";
  return text;
}

std::string report_to_markdown(const VerifyReport& report) {
  std::string text = "### " + report.name + ": " + report.title + "\n\nInput:";
  for (const std::string& scene : report.scenes) {
    text += " [`" + scene + "`](examples/verification/" + scene + ")";
  }
  text += report.scenes.empty() ? " none (made in the program).\n\n" : ".\n\n";
  bool header = true;
  for (const auto& row : table_of(report)) {
    text += "|";
    for (const std::string& cell : row) text += " " + escaped(cell) + " |";
    text += "\n";
    if (header) text += "|---|---|---|---|---|---|\n";
    header = false;
  }
  for (const std::string& remark : report.remarks) text += "\n" + remark + "\n";
  if (!report.failure.empty()) text += "\n**FAILED:** " + report.failure + "\n";
  return text + "\n";
}

nlohmann::json report_to_json(const VerifyReport& report) {
  // A NaN would make invalid JSON; it becomes null, and its row is a miss anyway.
  const auto value = [](double x) {
    return std::isfinite(x) ? nlohmann::json(x) : nlohmann::json(nullptr);
  };
  nlohmann::json rows = nlohmann::json::array();
  for (const VerifyRow& row : report.rows) {
    rows.push_back({{"quantity", row.quantity},
                    {"expected", value(row.expected)},
                    {"computed", value(row.computed)},
                    {"error", value(row.error)},
                    {"tolerance", value(row.tolerance)},
                    {"unit", row.unit},
                    {"pass", row.pass}});
  }
  return {{"name", report.name},       {"title", report.title},
          {"scenes", report.scenes},   {"rows", rows},
          {"remarks", report.remarks}, {"failure", report.failure},
          {"passed", report.passed()}};
}

}  // namespace faultsim
