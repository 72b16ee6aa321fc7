#include "simulator/scene/pressure_csv.h"

#include <sstream>

#include "simulator/common/csv_text.h"
#include "simulator/common/dates.h"
#include "simulator/common/errors.h"
#include "simulator/common/input_file.h"
#include "simulator/common/units.h"

namespace faultsim {
namespace {

constexpr const char* kPressureHeaderCure =
    "the first line names columns and units: time [year], west [bar], east [bar]";

constexpr std::size_t kMostColumns = 1000;  // a scene has 200 regions at most

class CsvReader {
 public:
  CsvReader(std::string given, std::optional<double> start) : given_(std::move(given)) {
    result_.start = start;
  }

  bool header(const std::string& line) {
    if (line.find(';') != std::string::npos && line.find(',') == std::string::npos) {
      return refuse("the columns are separated by semicolons",
                    "separate them by commas, with decimal points in the numbers");
    }
    const std::vector<std::string> cells = csv_cells(line);
    if (cells.size() > kMostColumns) {
      return refuse(concat("has ", cells.size(), " columns"),
                    concat("write at most ", kMostColumns));
    }
    result_.has_dates = !cells.empty() && cells[0] == "date";
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (!(i == 0 && result_.has_dates) && !header_cell(cells[i], i)) return false;
    }
    if (result_.columns.empty() || (!result_.has_dates && first_name_ != "time")) {
      return refuse("the first column is not \"time\" or \"date\" with others after it",
                    kPressureHeaderCure);
    }
    return true;
  }

  bool row(const std::string& line) {
    const std::vector<std::string> cells = csv_cells(line);
    if (cells.size() != result_.columns.size() + 1) {
      return refuse(
          concat("has ", cells.size(), " values for ", result_.columns.size() + 1, " columns"),
          "write one value per column");
    }
    if (!(result_.has_dates ? date(cells[0]) : time(cells[0]))) return false;
    for (std::size_t i = 1; i < cells.size(); ++i) {
      const auto parsed = parse_quantity(cells[i] + " " + units_[i], Dimension::pressure);
      if (!parsed.ok) {
        return refuse("\"" + cells[i] + "\" is not a number", "units stand in the header only");
      }
      PressureColumn& column = result_.columns[i - 1];
      if (!column.is_absolute && result_.time.back() == 0 && parsed.value != 0) {
        return refuse("the change at time 0 is " + cells[i],
                      "changes begin at 0; name a column of pressures \"" + column.region + " [" +
                          units_[i] + "] absolute\"");
      }
      column.pressure.push_back(parsed.value);
    }
    return true;
  }

  bool refuse(const std::string& what, const std::string& cure) {
    result_.what = given_ + (line_ > 0 ? concat(" line ", line_) : std::string()) + ": " + what;
    result_.cure = cure;
    return false;
  }
  bool has_header() const { return !result_.columns.empty(); }
  bool has_rows() const { return !result_.time.empty(); }
  void set_line(int line) { line_ = line; }
  PressureCsv result() && { return std::move(result_); }

 private:
  /// "west [bar]", "east [MPa] absolute"; of the first column "time [year]".
  bool header_cell(const std::string& cell, std::size_t index) {
    const auto open = cell.rfind('[');
    const auto close = cell.rfind(']');
    if (open == std::string::npos || close == std::string::npos || close < open) {
      return refuse("column \"" + cell + "\" has no unit in brackets", kPressureHeaderCure);
    }
    const std::string name = trimmed(cell.substr(0, open));
    const std::string unit = trimmed(cell.substr(open + 1, close - open - 1));
    const std::string kind = trimmed(cell.substr(close + 1));
    const bool is_time = index == 0;
    units_.resize(index + 1);
    units_[index] = unit;
    if (!parse_quantity("1 " + unit, is_time ? Dimension::time : Dimension::pressure).ok) {
      return refuse("column \"" + cell + "\" does not hold a " + (is_time ? "time" : "pressure"),
                    kPressureHeaderCure);
    }
    if (!kind.empty() && (is_time || (kind != "absolute" && kind != "change"))) {
      return refuse("column \"" + cell + "\" ends with \"" + kind + "\"",
                    is_time ? "end it with the unit: time [year]"
                            : "end it with the unit, or write \"absolute\" after it");
    }
    if (is_time) {
      first_name_ = name;
      return true;
    }
    if (name.empty()) {
      return refuse(concat("column ", index + 1, " has no name"), "name its pressure region");
    }
    for (std::size_t k = 0; k < result_.columns.size(); ++k) {
      if (result_.columns[k].region != name) continue;
      return refuse(concat("columns ", k + 2, " and ", index + 1, " are both \"", name, "\""),
                    "keep one of the two");
    }
    result_.columns.push_back({name, kind == "absolute", {}});
    return true;
  }

  bool date(const std::string& cell) {
    const std::optional<double> seconds = parse_date(cell);
    if (!seconds) {
      return refuse("\"" + cell + "\" is not a date", "write dates as year-month-day: 1990-01-31");
    }
    if (!result_.start) result_.start = seconds;
    if (*seconds < *result_.start) {
      return refuse("the date " + cell + " is before time 0",
                    "begin the table at the scene's start_date, or move that");
    }
    return next_time(*seconds - *result_.start, "the date " + cell, "write dates that increase");
  }

  bool time(const std::string& cell) {
    const auto parsed = parse_quantity(cell + " " + units_[0], Dimension::time);
    if (!parsed.ok) {
      return refuse("\"" + cell + "\" is not a number", "units stand in the header only");
    }
    return next_time(parsed.value, "time " + cell, "write times from 0 on that increase");
  }

  bool next_time(double time, const std::string& name, const std::string& cure) {
    if (time < 0 || (!result_.time.empty() && time <= result_.time.back())) {
      return refuse(name + " does not come after the one before", cure);
    }
    result_.time.push_back(time);
    return true;
  }

  std::string given_;
  int line_ = 0;
  std::string first_name_;
  std::vector<std::string> units_;  ///< of all columns; "" of dates.
  PressureCsv result_;
};

}  // namespace

PressureCsv parse_pressure_csv(const std::string& text, const std::string& given,
                               std::optional<double> start) {
  CsvReader reader(given, start);
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (number == 1) remove_byte_order_mark(line);
    const std::string words = trimmed(line);
    if (words.empty() || words[0] == '#') continue;
    reader.set_line(number);
    if (!(reader.has_header() ? reader.row(line) : reader.header(line))) {
      return std::move(reader).result();
    }
  }
  reader.set_line(0);
  if (!reader.has_rows()) reader.refuse("there are no values", kPressureHeaderCure);
  return std::move(reader).result();
}

}  // namespace faultsim
