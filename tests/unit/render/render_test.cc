// One value, four renderings: what each of them says the others say, whatever the width.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <regex>
#include <sstream>

#include "campaign/render/render.h"
#include "campaign/render/row_data.h"
#include "campaign/render/shown.h"
#include "simulator/common/errors.h"
#include "simulator/common/text.h"

namespace faultsweep {
namespace {

using faultsim::Dimension;
using nlohmann::ordered_json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

AnswerTable faults() {
  AnswerTable table{"faults",
                    "",
                    {{"fault", "fault", {}, 4, Need::always},
                     {"margin_pa", "margin", shown_unit(Dimension::pressure), 3},
                     {"moment_nm", "M0", shown_unit(Dimension::moment), 3, Need::extra},
                     {"share", "share", percent(), 3},
                     {"outcome", "outcome"}}};
  table.rows = {{"F1", 1.234e6, 4.5e13, 0.26637, "converged"},
                {"F2", -2.5e5, AnswerCell(), 1e-7, "converged"}};
  return table;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(RenderText, TellsOnceWhatDoesNotVary) {
  EXPECT_EQ(render_text(faults()),
            "In all 2 rows: outcome converged.\n"
            "fault  margin, bar  M0, N m  share, %\n"
            "F1            12.3  4.5e+13      26.6\n"
            "F2            -2.5            < 0.001\n");
}

TEST(RenderText, KeepsWhatDoesNotVaryWhereItIsAlwaysNeededOrThereIsOneRow) {
  AnswerTable table = faults();
  table.columns[4].need = Need::always;
  EXPECT_THAT(render_text(table), Not(HasSubstr("In all")));
  table = faults();
  table.rows.resize(1);
  EXPECT_THAT(render_text(table), Not(HasSubstr("In all")));
}

TEST(RenderText, LeavesOutByNeedOnNarrowScreensAndSaysSo) {
  const std::string text = render_text(faults(), 30);
  EXPECT_THAT(text, Not(HasSubstr("4.5e+13")));
  EXPECT_THAT(text, HasSubstr("Not shown on 30 columns: M0, N"));
  EXPECT_THAT(text, HasSubstr("12.3"));
}

TEST(RenderText, WritesParagraphsWhereNotEvenTheNeededFit) {
  AnswerTable table{"cases", "", {}};
  for (const char* name : {"offset", "friction_angle", "cohesion", "stiffness"})
    table.columns.push_back({name, name, {"m", 1, "m"}, 4, Need::always});
  table.rows = {{100.0, 2.0, 3.0, 4.0}, {50.0, 6.0, 7.0, 8.0}};
  const std::string text = render_text(table, 24);
  EXPECT_EQ(text,
            "offset 100 m;\n  friction_angle 2 m;\n  cohesion 3 m;\n  stiffness 4 m\n"
            "offset 50 m;\n  friction_angle 6 m;\n  cohesion 7 m;\n  stiffness 8 m\n");
}

TEST(RenderText, BreaksTextsThatAreTooLong) {
  AnswerTable table{"remarks", "", {{"case", "case"}, {"remark", "remark"}}};
  table.rows = {{1, "the safe end is not known and the unsafe end neither"}, {2, "narrow"}};
  EXPECT_EQ(render_text(table, 36),
            "case  remark\n"
            "   1  the safe end is not known and\n"
            "      the unsafe end neither\n"
            "   2  narrow\n");
}

TEST(RenderText, KeepsWordsInOnePieceUnlessTheyAreVeryLong) {
  AnswerTable table{"answers", "", {{"case", "case"}, {"answer", "answer"}}};
  table.rows = {{1, "F2 slides in cushion_gas_injection_2"}, {2, std::string(40, 'x')}};
  const auto lines = lines_of(render_text(table, 30));
  EXPECT_EQ(lines[1], "   1  F2 slides in");
  EXPECT_EQ(lines[2], "      cushion_gas_injection_2");
  EXPECT_EQ(lines[3], "   2  " + std::string(24, 'x'));
}

TEST(RenderText, HeadingsTakeSeveralLinesOnlyWhereTheyMust) {
  AnswerTable table{
      "t", "", {{"a", "sliding area", {"m²", 1, "m2"}}, {"b", "event M0", {"N m", 1, ""}}}};
  table.rows = {{1.0, 2.0}, {3.0, 4.0}};
  EXPECT_THAT(lines_of(render_text(table, 40))[0], HasSubstr("sliding area, m²  event M0, N m"));
  const auto lines = lines_of(render_text(table, 16));
  EXPECT_EQ(lines[0], "sliding  event");
  EXPECT_EQ(lines[1], "  area,    M0,");
  EXPECT_EQ(lines[2], "     m²    N m");
}

TEST(Shown, HasTheDigitsThatTheErrorAllows) {
  EXPECT_EQ(with_error(0.83172, 0.0213), "0.83 ± 0.02");
  EXPECT_EQ(with_error(0.83172, 0.0951), "0.8 ± 0.1");
  EXPECT_EQ(with_error(12.345, 3.2), "12 ± 3");
  EXPECT_EQ(with_error(12345.0, 320), "12300 ± 300");
  EXPECT_EQ(with_error(33.3, 10.4), "33 ± 10");
  EXPECT_EQ(with_error(-0.2, 23), "0 ± 20");
  EXPECT_EQ(with_error(4.2e8, 2.3e6), "4.2e+08 ± 2e+06");
  EXPECT_EQ(format_number(250, 2), "250");
  EXPECT_EQ(format_number(-12345, 2), "-12000");
  EXPECT_EQ(format_number(9.9996e6, 4), "1e+07");
  EXPECT_EQ(format_number(1.3e15), "1.3e+15");
  EXPECT_EQ(short_number("1234567.125 m"), "1234567 m");
  EXPECT_EQ(with_error(0.5, 0), "0.5 ± 0");
  EXPECT_EQ(with_error(-1e-9, 0.01), "-0.00 ± 0.01");
}

TEST(Shown, ASmallShareIsNotNothingAndALargeOneNotAll) {
  EXPECT_EQ(format_percent(0), "0");
  EXPECT_EQ(format_percent(1), "100");
  EXPECT_EQ(format_percent(2.11e-31), "< 0.001");
  EXPECT_EQ(format_percent(1 - 1e-9), "> 99.999");
  EXPECT_EQ(format_percent(0.99971), "99.971");
  EXPECT_EQ(format_percent(0.26637), "26.6");
}

TEST(RenderJson, HasRowsUnderTheirKeysAndUnitsOfColumns) {
  Answer answer{{"F1 slides."}};
  answer.facts["campaign"] = "sweep";
  AnswerTable table = faults();
  table.columns[4].group = "run";
  table.rows[0][2].error = 1e12;
  table.rows[1][3].note = "unresolved";
  answer.add(table).notes.push_back("as given");
  answer.note("more");
  const ordered_json document = render_json(answer);
  EXPECT_EQ(
      document.dump(),
      R"({"format":2,"headline":["F1 slides."],"campaign":"sweep","faults":[{"fault":"F1","margin_pa":1234000.0,)"
      R"("moment_nm":45000000000000.0,"moment_nm_error":1000000000000.0,"share":0.26637,"run":{"outcome":"converged"}},)"
      R"({"fault":"F2","margin_pa":-250000.0,"moment_nm":null,"share":1e-07,"share_note":"unresolved",)"
      R"("run":{"outcome":"converged"}}],"columns":{"faults":[{"key":"fault","heading":"fault","unit":""},)"
      R"({"key":"margin_pa","heading":"margin","unit":"Pa"},{"key":"moment_nm","heading":"M0","unit":"N m"},)"
      R"({"key":"share","heading":"share","unit":""},{"key":"outcome","heading":"outcome","unit":"","in":"run"}]},)"
      R"("notes":["as given","more"]})");
}

TEST(RenderCsv, OneTableByItsKey) {
  Answer answer{{}};
  answer.add(faults());
  AnswerTable other{"other", "", {{"name", "name"}, {"value", "value"}}};
  other.rows = {{"=1+1", AnswerCell(2.5, 0.1)}, {"a,b", AnswerCell()}};
  answer.add(other);
  EXPECT_EQ(render_csv(table_named(answer, "other")),
            "name,value,value_error\n'=1+1,2.5,0.1\n\"a,b\",,\n");
  EXPECT_EQ(&table_named(answer, ""), &std::get<AnswerTable>(answer.blocks[0]));
  try {
    table_named(answer, "others");
    ADD_FAILURE() << "there is no such table";
  } catch (const faultsim::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("faults, other"));
  }
}

TEST(RenderHtml, EscapesAndLimitsRows) {
  Answer answer{{"a < b"}};
  AnswerTable table = faults();
  table.rows[0][0] = "<script>";
  table.most_on_screen = 1;
  answer.add(table);
  const std::string html = render_html(answer);
  EXPECT_THAT(html, HasSubstr("<p class=\"answer\">a &lt; b</p>"));
  EXPECT_THAT(html, Not(HasSubstr("<script>")));
  EXPECT_THAT(html, HasSubstr("and 1 more rows"));
  EXPECT_THAT(html, HasSubstr("data-value=\"1234000\""));
}

std::string bytes_of_base64(const std::string& text) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  for (std::size_t i = 0; i + 3 < text.size(); i += 4) {
    unsigned word = 0;
    for (std::size_t k = 0; k < 4; ++k)
      word =
          word * 64 + (text[i + k] == '=' ? 0U : static_cast<unsigned>(letters.find(text[i + k])));
    for (const unsigned shift : {16U, 8U, 0U}) bytes += static_cast<char>(word >> shift & 255U);
  }
  return bytes;
}

/// What a page's script reads: the text of each row and column.
std::vector<std::vector<std::string>> read_rows(const nlohmann::json& data) {
  const auto n = data.at("rows").get<std::size_t>();
  std::vector<std::vector<std::string>> rows(n);
  for (const nlohmann::json& column : data.at("columns")) {
    const std::string bytes = bytes_of_base64(column.value("at", ""));
    const auto width = column.value("bytes", std::size_t{0});
    for (std::size_t r = 0; r < n; ++r) {
      std::uint64_t number = 0;
      for (std::size_t k = width; k-- > 0;)
        number = 256 * number + static_cast<unsigned char>(bytes.at(width * r + k));
      if (column.contains("decimals")) {
        const double power = std::pow(10.0, column["decimals"].get<int>());
        rows[r].push_back(faultsim::formatted("%.9g", static_cast<double>(number) / power));
      } else {
        const nlohmann::json& texts = column.at("texts");
        rows[r].push_back(texts.at(width > 0 ? number : texts.size() == 1 ? 0 : r));
      }
    }
  }
  return rows;
}

/// However many different texts a column has, and whatever they are.
TEST(RowData, HasEveryRowAsTheScreenHasIt) {
  AnswerTable table{"t",
                    "",
                    {{"one", "one"},
                     {"few", "few"},
                     {"many", "many"},
                     {"sampled", "sampled", {}, 6},
                     {"numbers", "numbers"},
                     {"signs", "signs", {}, 6},
                     {"errors", "errors"}}};
  const auto sampled = [](int k) { return 0.001 + std::fmod(k * 0.6180339887498949, 1.0) * 30; };
  for (int k = 0; k < 70000; ++k)
    table.rows.push_back({1.5, k % 7 == 0 ? AnswerCell() : AnswerCell(faultsim::concat("w", k % 7)),
                          k % 1031, sampled(k), 70000 - k, sampled(k) - 15,
                          AnswerCell(k / 3.0, 0.1)});
  table.rows.push_back({1.5, "w1", 7, 0.0, 0, 0.0});  // ends early
  const nlohmann::json data = nlohmann::json::parse(row_data(table, {0, 1, 2, 3, 4, 5, 6}));
  const auto& columns = data["columns"];
  EXPECT_FALSE(columns[0].contains("at")) << "one text for all";
  EXPECT_EQ(columns[1]["bytes"], 1);
  EXPECT_EQ(columns[2]["bytes"], 2);
  EXPECT_GT(columns[3]["decimals"], 4) << "as small ones have more";
  EXPECT_EQ(columns[4]["decimals"], 0);
  EXPECT_FALSE(columns[5].contains("decimals")) << "some are negative";
  EXPECT_FALSE(columns[6].contains("at")) << "nearly every row has its own, with its error";
  const auto rows = read_rows(data);
  ASSERT_EQ(rows.size(), table.rows.size());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t k = 0; k < table.columns.size(); ++k) {
      const AnswerCell cell = k < table.rows[r].size() ? table.rows[r][k] : AnswerCell();
      ASSERT_EQ(rows[r][k], shown_cell(cell, table.columns[k])) << r << " " << k;
    }
  }
}

/// What looks like a number but is spelled otherwise stays a text.
TEST(RowData, KeepsTheSpellingOfNumbers) {
  AnswerTable table{"t", "", {{"a", "a"}}};
  for (int k = 0; k < 600; ++k) table.rows.push_back({faultsim::concat(k, k == 300 ? ".50" : "")});
  const auto rows = read_rows(nlohmann::json::parse(row_data(table, {0})));
  EXPECT_EQ(rows[300][0], "300.50");
  EXPECT_EQ(rows[299][0], "299");
}

TEST(RowData, IsOfTheColumnsThatAreAskedFor) {
  AnswerTable table{"t", "", {{"a", "a"}, {"b", "b"}, {"c", "c"}}};
  table.rows.push_back({1, 2, 3});
  EXPECT_THAT(read_rows(nlohmann::json::parse(row_data(table, {2, 0}))),
              ElementsAre(ElementsAre("3", "1")));
}

/// A text in the data cannot end the element.
TEST(RenderHtml, KeepsDataInTheirElement) {
  AnswerTable table{"t", "", {{"a", "a"}}};
  table.is_sortable = true;
  for (int k = 0; k < 101; ++k) table.rows.push_back({"</script><b>"});
  Answer answer;
  answer.add(table);
  const std::string html = render_html(answer);
  EXPECT_THAT(html, Not(HasSubstr("<b>")));
  EXPECT_EQ(html.find("</script>"), html.rfind("</script>"));
  EXPECT_THAT(html, HasSubstr("\\u003c/script>"));
}

/// An answer of random tables.
Answer random_answer(std::mt19937& random) {
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  const ShownUnit units[] = {plain(), percent(), shown_unit(Dimension::pressure),
                             shown_unit(Dimension::time), shown_unit(Dimension::area, true)};
  Answer answer{{"a sentence"}};
  for (int t = 0; t < 1 + below(3); ++t) {
    AnswerTable table{"t" + std::to_string(t), below(2) == 0 ? "title" : "", {}};
    const int n_columns = 1 + below(9);
    for (int c = 0; c < n_columns; ++c)
      table.columns.push_back({"c" + std::to_string(c), "heading " + std::to_string(c),
                               units[below(5)], 4, static_cast<Need>(below(3)),
                               below(4) == 0 ? "group" : ""});
    for (int r = 0; r < below(6); ++r) {
      std::vector<AnswerCell> row;
      for (int c = 0; c < n_columns; ++c) {
        const double value = (below(2000) - 1000) * std::pow(10.0, below(9) - 4);
        switch (below(6)) {
          case 0:
            row.emplace_back();
            break;
          case 1:
            row.emplace_back(static_cast<long>(below(100000)));
            break;
          case 2:
            row.emplace_back(value, std::abs(value) * 0.013);
            break;
          case 3:
            row.emplace_back(std::string("words of ") + std::to_string(below(10)));
            break;
          default:
            row.emplace_back(value);
        }
      }
      table.rows.push_back(std::move(row));
    }
    answer.add(std::move(table));
  }
  return answer;
}

/// The cells of the CSV text by line and column; no quotes are in these tables.
std::vector<std::vector<std::string>> csv_of(const AnswerTable& table) {
  std::vector<std::vector<std::string>> rows;
  for (const std::string& line : lines_of(render_csv(table))) {
    rows.emplace_back();
    std::istringstream stream(line + ",");
    for (std::string field; std::getline(stream, field, ',');) rows.back().push_back(field);
  }
  return rows;
}

TEST(Renderings, OfRandomAnswersHaveTheSameNumbers) {
  std::mt19937 random(7);
  long n_compared = 0;
  for (int k = 0; k < 200; ++k) {
    const Answer answer = random_answer(random);
    const ordered_json document = render_json(answer);
    const std::string html = render_html(answer), wide = render_text(answer, 10000);
    for (const AnswerBlock& block : answer.blocks) {
      const auto& table = std::get<AnswerTable>(block);
      const auto csv = csv_of(table);
      ASSERT_EQ(csv.size(), table.rows.size() + 1);
      for (std::size_t r = 0; r < table.rows.size(); ++r) {
        for (const AnswerColumn& column : table.columns) {
          const ordered_json& row = document[table.key][r];
          const ordered_json& value =
              column.group.empty() ? row[column.key] : row["group"][column.key];
          const auto place = std::find(csv[0].begin(), csv[0].end(), column.key) - csv[0].begin();
          const std::string& field = csv[r + 1][static_cast<std::size_t>(place)];
          if (value.is_null()) {
            EXPECT_EQ(field, "");
            continue;
          }
          if (!value.is_number()) {
            EXPECT_EQ(field, value.get<std::string>());
            continue;
          }
          // CSV has every digit; the page has it beside what it shows.
          EXPECT_EQ(std::stod(field), value.get<double>());
          EXPECT_THAT(html, HasSubstr("data-value=\"" + field + "\""));
          ++n_compared;
        }
      }
    }
    for (const std::size_t width : {40u, 60u, 80u, 100u, 200u}) {
      for (const std::string& line : lines_of(render_text(answer, width)))
        EXPECT_LE(display_width(line), width) << line;
    }
  }
  EXPECT_GT(n_compared, 2000);
}

/// Numbers of a text, in order.
std::vector<double> numbers_in(const std::string& text) {
  static const std::regex kNumber(R"([-+]?[0-9]+(\.[0-9]+)?(e[-+]?[0-9]+)?)");
  std::vector<double> found;
  for (std::sregex_iterator it(text.begin(), text.end(), kNumber), end; it != end; ++it)
    found.push_back(std::stod(it->str()));
  return found;
}

TEST(Renderings, ShowNumbersOfJsonInTheUnitOfTheColumn) {
  std::mt19937 random(3);
  for (int k = 0; k < 300; ++k) {
    const double si =
        std::ldexp(static_cast<double>(random() % 100000), static_cast<int>(random() % 20) - 10);
    const std::vector<std::pair<ShownUnit, double>> known = {
        {shown_unit(Dimension::pressure), 1e5},
        {shown_unit(Dimension::time), 365.25 * 86400},
        {plain(), 1}};
    for (const auto& [unit, size] : known) {
      AnswerTable table{"t", "", {{"a", "a", unit, 5}}};
      table.rows = {{si}};
      Answer answer{{}};
      answer.add(table);
      const double in_json = render_json(answer)["t"][0]["a"];
      const auto lines = lines_of(render_text(answer));
      const double on_screen = numbers_in(lines.back()).at(0);
      EXPECT_NEAR(on_screen * size, in_json, 0.6e-4 * std::abs(in_json)) << lines.back();
    }
  }
}

}  // namespace
}  // namespace faultsweep
