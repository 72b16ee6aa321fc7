#pragma once

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "simulator/common/units.h"
#include "simulator/figure/bar_chart.h"
#include "simulator/figure/history_chart.h"
#include "simulator/figure/log_chart.h"
#include "simulator/figure/outcome_map.h"
#include "simulator/figure/range_bars.h"

/// An answer as one value. Commands compute it; screen, JSON, CSV and page are renderings of it
/// (render.h), so that what one of them says the others say.
namespace faultsweep {

/// How the numbers of a column are shown; JSON and CSV have them in SI.
struct ShownUnit {
  std::string name;  ///< "bar"; "" = a plain number.
  double size = 1;   ///< in SI: 1e5.
  std::string si;    ///< "Pa".
};
/// The one that users meet: pressures in bar, times in years, else SI.
/// @param per_metre  of strike, as areas, potencies and moments of plane strain are.
ShownUnit shown_unit(faultsim::Dimension dimension, bool per_metre = false);
inline ShownUnit plain() { return {}; }
inline constexpr double kBar = 1e5;              ///< Pa.
inline constexpr double kYear = 365.25 * 86400;  ///< s.
inline ShownUnit metres() { return {"m", 1, "m"}; }
inline ShownUnit seconds() { return {"s", 1, "s"}; }
inline ShownUnit bars() { return {"bar", kBar, "Pa"}; }
inline ShownUnit gigabytes() { return {"GB", 1e9, "B"}; }
/// Shares of 0 to 1, shown in percent.
inline ShownUnit percent() { return {"%", 0.01, ""}; }

/// Nothing, a flag, a count, a number in SI, or words.
using AnswerValue = std::variant<std::monostate, bool, std::int64_t, double, std::string>;

struct AnswerCell {
  AnswerValue value = {};
  double error = std::numeric_limits<double>::quiet_NaN();  ///< ±, SI; NaN = not known.
  std::string note = {};                                    ///< words behind it: "unresolved".

  AnswerCell() = default;
  AnswerCell(AnswerValue v, double plus_minus = std::numeric_limits<double>::quiet_NaN(),
             std::string words = {})
      : value(std::move(v)), error(plus_minus), note(std::move(words)) {}
  template <typename T>
  AnswerCell(const std::optional<T>& maybe) {
    if (maybe) *this = AnswerCell(*maybe);
  }
  AnswerCell(const char* words) : value(std::string(words)) {}
  AnswerCell(std::string words) : value(std::move(words)) {}
  AnswerCell(double number) : value(number) {}
  AnswerCell(bool flag) : value(flag) {}
  AnswerCell(int count) : value(std::int64_t{count}) {}
  AnswerCell(long count) : value(std::int64_t{count}) {}
  AnswerCell(std::size_t count) : value(static_cast<std::int64_t>(count)) {}
};

/// Nothing for "".
inline AnswerCell words_or_nothing(const std::string& words) {
  return words.empty() ? AnswerCell() : AnswerCell(words);
}

/// The number of a case; nothing for 0.
inline AnswerCell case_cell(long position) {
  return position > 0 ? AnswerCell(position) : AnswerCell();
}

/// Further columns, or cells of a row, behind those that there are.
template <typename T>
void append(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// Which columns a screen does without when it is too narrow for all.
enum class Need {
  always,  ///< never left out, nor told as a sentence where all rows have the same.
  wanted,  ///< left out after all that are `extra`.
  extra,
  data,  ///< in JSON and CSV only.
};

struct AnswerColumn {
  std::string key;      ///< of JSON and CSV, the SI unit at its end: "moment_nm".
  std::string heading;  ///< of screen and page, without unit: "M0".
  ShownUnit unit = {};
  int digits = 4;  ///< significant ones on screen and page, where no error says how many.
  Need need = Need::wanted;
  std::string group = {};  ///< the object of a JSON row in which the key stands; "" = the row.
  std::string ranks = {};  ///< what `rank --by` calls it; "" = nothing can be ranked by it.
};

/// Rows of cells, one for each column; a row may end early where nothing follows.
struct AnswerTable {
  std::string key;    ///< of the array in JSON: "shares".
  std::string title;  ///< a line above it; "" = none.
  std::vector<AnswerColumn> columns;
  std::vector<std::vector<AnswerCell>> rows = {};
  std::vector<std::string> notes = {};  ///< sentences below it.
  std::size_t most_on_screen = 0;       ///< rows that text and page show; 0 = all.
  bool on_screen = true;                ///< text and page have it.
  bool is_sortable = false;  ///< long: a page sorts and filters it, without `extra` columns.
  bool in_files = true;      ///< JSON and CSV have it; else its numbers stand in another table.
};

/// A paragraph of its own.
struct AnswerNote {
  std::string text;
};

/// On pages only: its numbers stand in a table.
using AnswerChart = std::variant<faultsim::figure::BarChart, faultsim::figure::IntervalChart,
                                 faultsim::figure::HistoryChart, faultsim::figure::OutcomeMap,
                                 faultsim::figure::RangeBars, faultsim::figure::LogChart>;

using AnswerBlock = std::variant<AnswerTable, AnswerNote, AnswerChart>;

/// Of a headline that goes along a list.
inline constexpr std::size_t kMostSentences = 3;

struct Answer {
  std::vector<std::string> headline;  ///< the answer in sentences, the most important first.
  std::vector<AnswerBlock> blocks = {};
  /// Further keys of JSON: what was asked, counts, what has a format of its own. In JSON only.
  nlohmann::ordered_json facts = nlohmann::ordered_json::object();

  AnswerTable& add(AnswerTable table);
  void note(std::string text) { blocks.emplace_back(AnswerNote{std::move(text)}); }
  /// Nothing for "".
  void note_if(const std::string& text) {
    if (!text.empty()) note(text);
  }
};

}  // namespace faultsweep
