#include "simulator/common/table_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "simulator/common/printable.h"
#include "simulator/common/ranges.h"

namespace faultsim {
namespace {

constexpr std::size_t kMostProblems = 20;  // of a kind, spelled out
constexpr std::size_t kMostColumns = 10000;
constexpr const char* kNumberCure =
    "write a decimal number, with its unit in the header, and leave out rows without a value";

bool is_blank(char c) { return c == ' ' || c == '\t'; }

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// The first character that is none, as printable() spells it; tabs are blanks. "" = all are sound.
std::string first_odd(std::string_view line) {
  const auto odd = [](char c) { return c < ' ' || c > '~'; };  // above ASCII as well
  if (std::ranges::none_of(line, odd)) return "";
  std::string text(line);
  std::ranges::replace(text, '\t', ' ');
  return first_unprintable(text);
}

bool has_decimal_comma(std::string_view cell) {
  std::string text(cell);
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) return false;
  text[comma] = '.';
  return parse_number(text).has_value();
}

/// The cell in quotes that begins at line[at], without them; at: behind the closing one. None where
/// it does not close.
std::optional<std::string> quoted_cell(std::string_view line, std::size_t& at) {
  std::string cell;
  for (++at; at < line.size(); ++at) {
    if (line[at] == '"' && line.substr(at + 1, 1) != "\"") {
      ++at;
      return cell;
    }
    if (line[at] == '"') ++at;  // the first of two
    cell += line[at];
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size() || error == std::errc::invalid_argument) return std::nullopt;
  // Both 1e999 and 1e-999 are out of range; the smallest numbers are right all the same.
  if (error == std::errc::result_out_of_range)
    value = std::strtod(std::string(text).c_str(), nullptr);
  if (!std::isfinite(value)) return std::nullopt;
  return value;
}

std::string table_quote(std::string_view text) {
  constexpr std::size_t kMostLetters = 60;
  return '"' + printable(shortened(text, kMostLetters)) + '"';
}

TableColumn table_column(std::string_view cell) {
  const std::string_view text = without_blanks(cell);
  const std::size_t open = text.rfind('['), close = text.rfind(']');
  TableColumn column{std::string(text), std::string(text), std::nullopt, ""};
  if (open == std::string_view::npos || close == std::string_view::npos || close < open)
    return column;
  column.name = without_blanks(text.substr(0, open));
  column.unit = without_blanks(text.substr(open + 1, close - open - 1));
  column.words = without_blanks(text.substr(close + 1));
  return column;
}

std::string_view next_table_line(std::string_view& rest) {
  // Letters stand above both: nearly all bytes cost one comparison.
  const auto* end = std::ranges::find_if(rest, [](char c) {
    return static_cast<unsigned char>(c) <= '\r' && (c == '\n' || c == '\r');
  });
  const std::string_view line(rest.begin(), static_cast<std::size_t>(end - rest.begin()));
  rest.remove_prefix(line.size());
  if (rest.substr(0, 2) == "\r\n") rest.remove_prefix(1);
  if (!rest.empty()) rest.remove_prefix(1);
  return line;
}

char table_separator(std::string_view header) {
  bool quoted = false;
  std::string found;
  for (const char c : header) {
    quoted = quoted != (c == '"');
    if (!quoted && (c == ';' || c == ',' || c == '\t')) found += c;
  }
  for (const char c : {';', ',', '\t'}) {
    if (found.find(c) != std::string::npos) return c;
  }
  return ',';
}

bool is_idle_table_line(std::string_view line) {
  line = without_blanks(line);
  return line.empty() || line.front() == '#';
}

TableReader::TableReader(std::string_view text, std::string source)
    : rest_(text), source_(std::move(source)) {
  if (rest_.substr(0, 3) == "\xEF\xBB\xBF") rest_.remove_prefix(3);
  std::string_view line;
  if (!next_line(line)) return;
  separator_ = table_separator(line);
  if (!split(line)) return;
  if (cells_.size() > kMostColumns) {
    refuse(concat("has ", cells_.size(), " columns"), concat("write at most ", kMostColumns));
    return;
  }
  for (const std::string_view cell : cells_) columns_.push_back(table_column(cell));
  units_.resize(columns_.size());
}

/// The next line with something on it.
bool TableReader::next_line(std::string_view& line) {
  while (!rest_.empty()) {
    line = next_table_line(rest_);
    ++line_;
    if (!is_idle_table_line(line)) return true;
  }
  return false;
}

bool TableReader::next_row() {
  if (columns_.empty()) return false;
  for (std::string_view line; next_line(line);) {
    has_rows_ = true;
    if (!split(line)) continue;
    if (cells_.size() == columns_.size()) return true;
    refuse(concat("has ", counted(cells_.size(), "value", "values"), " for ",
                  counted(columns_.size(), "column", "columns")),
           "write one value per column, separated as in the header, with decimal points");
  }
  return false;
}

/// The cells of a line; false after a refusal.
bool TableReader::split(std::string_view line) {
  cells_.clear();
  unquoted_.clear();
  if (const std::string odd = first_odd(line); !odd.empty()) {
    refuse("contains \"" + odd + "\", which is not a text character",
           "remove it, or save the table as text in UTF-8");
    return false;
  }
  if (line.find('"') != std::string_view::npos) return split_quoted(line);
  for (;;) {
    const std::size_t end = line.find(separator_);
    cells_.push_back(without_blanks(line.substr(0, end)));
    if (end == std::string_view::npos) return true;
    line.remove_prefix(end + 1);
  }
}

bool TableReader::split_quoted(std::string_view line) {
  const char* cure =
      "put a cell that contains quotes in quotes, and double each of them: \"5\"\" pipe\"";
  const auto skip_blanks = [&](std::size_t at) {
    while (at < line.size() && is_blank(line[at]) && line[at] != separator_) ++at;
    return at;
  };
  for (std::size_t at = 0;; ++at) {  // behind a separator
    at = skip_blanks(at);
    if (at < line.size() && line[at] == '"') {
      std::optional<std::string> cell = quoted_cell(line, at);
      if (!cell) return refuse("has a quote that does not close on its line", cure), false;
      cells_.push_back(without_blanks(unquoted_.emplace_back(std::move(*cell))));
      at = skip_blanks(at);
    } else {
      const std::size_t end = std::min(line.find(separator_, at), line.size());
      cells_.push_back(without_blanks(line.substr(at, end - at)));
      at = cells_.back().find('"') == std::string_view::npos ? end : at;
    }
    if (at == line.size()) return true;
    if (line[at] != separator_) return refuse("has a quote within a cell", cure), false;
  }
}

std::optional<TableReader::Unit> TableReader::unit_of(const std::string& unit,
                                                      Dimension dimension) {
  if (dimension == Dimension::temperature) {  // of degrees that do not begin at nothing
    constexpr double kKelvin = 273.15, kFahrenheit = 459.67, kRankine = 5.0 / 9;
    if (unit == "degC") return Unit{1, kKelvin, {}};
    if (unit == "degF") return Unit{kRankine, kFahrenheit * kRankine, {}};
  }
  const ParsedQuantity one = parse_quantity("1 " + unit, dimension);
  if (!one.ok) return std::nullopt;
  return Unit{one.value, 0, {}};
}

bool TableReader::set_unit(std::size_t column, Dimension dimension, const ValueRange& range,
                           const std::string& cure, const std::vector<std::string>& words) {
  const TableColumn& heading = columns_[column];
  const std::string name = concat("column ", column + 1, " ", table_quote(heading.text));
  const std::optional<Unit> unit =
      heading.unit ? unit_of(*heading.unit, dimension) : std::optional<Unit>();
  const bool sound_words = heading.words.empty() || contains(words, heading.words);
  if (!heading.unit) {
    refuse(name + " has no unit in brackets", cure);
  } else if (!unit) {
    const bool is_temperature = dimension == Dimension::temperature;  // not a difference here
    refuse(name + " does not hold " + (is_temperature ? "a temperature" : info_of(dimension).noun),
           cure);
  } else if (!sound_words) {
    refuse(name + " ends with " + table_quote(heading.words) + " after its unit", cure);
  } else {
    units_[column] = *unit;
    units_[column].range = range;
  }
  return unit && sound_words;
}

TableNumber TableReader::check_number(std::size_t column) const {
  const std::string_view cell = cells_[column];
  const std::optional<double> number = parse_number(cell);
  if (!number) {
    const std::string place = concat(column + 1, " ", table_quote(columns_[column].name));
    if (cell.empty()) return {0, "column " + place + " is empty", kNumberCure};
    if (has_decimal_comma(cell))
      return {0, table_quote(cell) + " in column " + place + " has a decimal comma",
              "write decimal points: 1.5"};
    return {0, table_quote(cell) + " in column " + place + " is not a number", kNumberCure};
  }
  const Unit& unit = units_[column];
  if (!unit.range) return {*number, "", ""};
  constexpr double kSlack = 1e-9;  // 360 deg may come out one bit off
  const double si = unit.size * *number + unit.zero;
  if (si >= unit.range->low - kSlack * std::abs(unit.range->low) &&
      si <= unit.range->high + kSlack * std::abs(unit.range->high))
    return {*number, "", ""};
  return {0,
          concat(table_quote(cell), " in column ", column + 1, " ",
                 table_quote(columns_[column].text), " is not within ", unit.range->text),
          concat("write values of ", unit.range->text, ", in the unit of the header")};
}

std::optional<double> TableReader::number(std::size_t column) {
  const TableNumber read = check_number(column);
  if (read.what.empty()) return read.value;
  refuse(read.what, read.cure);
  return std::nullopt;
}

std::optional<double> TableReader::value(std::size_t column) {
  const std::optional<double> read = number(column);
  if (!read) return std::nullopt;
  return units_[column].size * *read + units_[column].zero;
}

void TableReader::refuse_at(int line, const std::string& what, const std::string& cure) {
  if (++counts_[cure] <= kMostProblems) problems_.push_back({"", line, what, cure});
}

bool TableReader::has_header(const std::string& cure) {
  if (columns_.empty() && is_sound()) refuse_at(0, "there are no values", cure);
  return !columns_.empty();
}

void TableReader::require_rows(const std::string& cure) {
  if (!has_rows_ && is_sound()) refuse_at(0, "there are no values", cure);
  require_sound();
}

void TableReader::require_sound() const {
  if (problems_.empty()) return;
  std::vector<Problem> problems = problems_;
  for (const auto& [cure, n] : counts_) {
    if (n > kMostProblems)
      problems.push_back(
          {"", 0, concat(n - kMostProblems, " more are wrong in the same way"), cure});
  }
  throw InputError(source_, std::move(problems));
}

}  // namespace faultsim
