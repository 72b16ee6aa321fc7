#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "campaign/render/render.h"
#include "campaign/render/shown.h"

/// What holds of every answer, however it is rendered.
namespace faultsweep::testing {

/// Every finite number of every table stands in JSON as it is, in CSV with all digits, and on the
/// page, where its column is shown, as the cell's data.
inline void expect_the_same_numbers(const Answer& answer) {
  const auto json = render_json(answer);
  const std::string html = render_html(answer);
  for (const AnswerBlock& block : answer.blocks) {
    const auto* table = std::get_if<AnswerTable>(&block);
    if (table == nullptr) continue;
    const std::string csv = render_csv(*table);
    ASSERT_EQ(json.at(table->key).size(), table->rows.size());
    for (std::size_t r = 0; r < table->rows.size(); ++r) {
      ASSERT_LE(table->rows[r].size(), table->columns.size()) << table->key;
      for (std::size_t k = 0; k < table->rows[r].size(); ++k) {
        const auto* number = std::get_if<double>(&table->rows[r][k].value);
        if (number == nullptr || !std::isfinite(*number)) continue;
        const AnswerColumn& column = table->columns[k];
        const auto& row = json.at(table->key).at(r);
        EXPECT_EQ(column.group.empty() ? row.at(column.key) : row.at(column.group).at(column.key),
                  *number)
            << table->key << " " << column.key;
        EXPECT_NE(csv.find(exact_number(*number)), std::string::npos) << column.key;
        const bool is_left_out =
            column.need == Need::data || (table->is_sortable && column.need == Need::extra);
        const bool on_page =
            !is_left_out && (table->most_on_screen == 0 || r < table->most_on_screen);
        if (!on_page) continue;
        EXPECT_NE(html.find("data-value=\"" + exact_number(*number) + "\""), std::string::npos)
            << column.key;
      }
    }
  }
  for (const std::string& sentence : answer.headline)
    EXPECT_NE(json.at("headline").dump().find(sentence.substr(0, 10)), std::string::npos);
}

/// No line of the text is wider than the screen, and none of its tables is in pieces: the headings
/// of a table stand once.
inline void expect_to_fit(const Answer& answer) {
  for (const std::size_t width : {60, 80, 100, 200}) {
    std::stringstream lines(render_text(answer, width));
    for (std::string line; std::getline(lines, line);)
      EXPECT_LE(display_width(line), width) << line;
  }
}

}  // namespace faultsweep::testing
