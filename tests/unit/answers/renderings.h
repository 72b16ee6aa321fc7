#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "campaign/render/render.h"
#include "campaign/render/shown.h"
#include "tests/unit/reports/renderings.h"

/// What holds of the four renderings of any answer.
namespace faultsweep::testing {

/// The fields of a line of CSV.
inline std::vector<std::string> csv_fields(const std::string& line) {
  std::vector<std::string> fields(1);
  bool is_quoted = false;
  for (const char letter : line) {
    if (letter == '"') {
      is_quoted = !is_quoted;
    } else if (letter == ',' && !is_quoted) {
      fields.emplace_back();
    } else {
      fields.back() += letter;
    }
  }
  return fields;
}

inline std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The number of a cell in SI, NaN for none.
inline double number_in(const AnswerCell& cell) {
  if (const auto* count = std::get_if<std::int64_t>(&cell.value))
    return static_cast<double>(*count);
  const auto* number = std::get_if<double>(&cell.value);
  return number != nullptr ? *number : std::nan("");
}

/// Numbers of a table for files, to the bit, in JSON and CSV.
inline void expect_in_files(const AnswerTable& table, const nlohmann::ordered_json& document) {
  const std::vector<std::string> lines = lines_of(render_csv(table));
  ASSERT_EQ(lines.size(), table.rows.size() + 1) << table.key;
  const std::vector<std::string> keys = csv_fields(lines[0]);
  const auto& rows = document.at(table.key);
  ASSERT_EQ(rows.size(), table.rows.size()) << table.key;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const std::vector<std::string> fields = csv_fields(lines[r + 1]);
    for (std::size_t k = 0; k < table.rows[r].size(); ++k) {
      const AnswerColumn& column = table.columns[k];
      const double number = number_in(table.rows[r][k]);
      if (!std::isfinite(number)) continue;
      const auto& row = column.group.empty() ? rows[r] : rows[r].at(column.group);
      EXPECT_EQ(row.at(column.key).get<double>(), number) << column.key;
      const auto place = std::find(keys.begin(), keys.end(), column.key) - keys.begin();
      EXPECT_EQ(std::stod(fields.at(static_cast<std::size_t>(place))), number) << column.key;
    }
  }
}

/// The cells of a table for people stand as they are shown on the screen and on the page, there
/// with the number in SI beside them.
inline void expect_on_screen(const AnswerTable& table, const std::string& text,
                             const std::string& html) {
  const std::size_t n = table.most_on_screen == 0
                            ? table.rows.size()
                            : std::min(table.rows.size(), table.most_on_screen);
  for (std::size_t r = 0; r < n; ++r) {
    for (std::size_t k = 0; k < table.rows[r].size(); ++k) {
      if (table.columns[k].need == Need::data) continue;
      const std::string shown = shown_cell(table.rows[r][k], table.columns[k]);
      EXPECT_THAT(text, ::testing::HasSubstr(shown)) << table.columns[k].heading;
      const double number = number_in(table.rows[r][k]);
      if (std::isfinite(number) && table.rows[r][k].note.empty()) {
        EXPECT_THAT(html, ::testing::HasSubstr("data-value=\"" + exact_number(number) + "\">"))
            << table.columns[k].heading;
      }
    }
  }
}

/// All four say the same.
inline void expect_same_renderings(const Answer& answer) {
  constexpr std::size_t kWide = 100000;
  const std::string text = render_text(answer, kWide), html = render_html(answer);
  const nlohmann::ordered_json document = render_json(answer);
  for (const AnswerBlock& block : answer.blocks) {
    const auto* table = std::get_if<AnswerTable>(&block);
    if (table == nullptr) continue;
    if (table->in_files) expect_in_files(*table, document);
    if (table->on_screen) expect_on_screen(*table, text, html);
  }
  for (const std::string& sentence : answer.headline)
    EXPECT_THAT(text, ::testing::HasSubstr(sentence));
  EXPECT_EQ(document.at("headline").size(), answer.headline.size());
  expect_to_fit(answer);
}

}  // namespace faultsweep::testing
