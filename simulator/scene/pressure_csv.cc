#include "simulator/scene/pressure_csv.h"

#include <sstream>

#include "simulator/common/errors.h"
#include "simulator/common/input_file.h"
#include "simulator/common/units.h"

namespace faultsim {
namespace {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r\"");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r\"") - first + 1);
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream stream(line);
  std::string cell;
  while (std::getline(stream, cell, ',')) cells.push_back(trimmed(cell));
  if (!line.empty() && line.back() == ',') cells.emplace_back();
  return cells;
}

constexpr const char* kHeaderCure =
    "the first line names columns and units: time [year], west [bar], east [bar]";

constexpr std::size_t kMostColumns = 1000;  // a scene has 200 regions at most

class CsvReader {
 public:
  explicit CsvReader(std::string given) : given_(std::move(given)) {}

  bool header(const std::string& line) {
    if (line.find(';') != std::string::npos && line.find(',') == std::string::npos) {
      return refuse("the columns are separated by semicolons",
                    "separate them by commas, with decimal points in the numbers");
    }
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() > kMostColumns) {
      return refuse(concat("has ", cells.size(), " columns"),
                    concat("write at most ", kMostColumns));
    }
    for (const std::string& cell : cells) {
      const auto open = cell.find('[');
      if (open == std::string::npos || cell.back() != ']') {
        return refuse("column \"" + cell + "\" has no unit in brackets", kHeaderCure);
      }
      names_.push_back(trimmed(cell.substr(0, open)));
      units_.push_back(trimmed(cell.substr(open + 1, cell.size() - open - 2)));
      const Dimension dimension = names_.size() == 1 ? Dimension::time : Dimension::pressure;
      if (!parse_quantity("1 " + units_.back(), dimension).ok) {
        return refuse(
            "column \"" + cell + "\" does not hold a " + (names_.size() == 1 ? "time" : "pressure"),
            kHeaderCure);
      }
      if (names_.size() > 1) result_.columns.push_back({names_.back(), {}, {}, 1, 0});
    }
    if (names_.size() < 2 || names_[0] != "time") {
      return refuse("the first column is not \"time\" with others after it", kHeaderCure);
    }
    return true;
  }

  bool row(const std::string& line) {
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() != names_.size()) {
      return refuse(concat("has ", cells.size(), " values for ", names_.size(), " columns"),
                    "write one value per column");
    }
    double time = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto parsed = parse_quantity(cells[i] + " " + units_[i],
                                         i == 0 ? Dimension::time : Dimension::pressure);
      if (!parsed.ok) {
        return refuse("\"" + cells[i] + "\" is not a number", "units stand in the header only");
      }
      if (i == 0) {
        time = parsed.value;
        continue;
      }
      PressureHistory& column = result_.columns[i - 1];
      if (time < 0 || (!column.time.empty() && time <= column.time.back())) {
        return refuse("time " + cells[0] + " does not come after the one before",
                      "write times from 0 on that increase");
      }
      if (time == 0 && parsed.value != 0) {
        return refuse("the change at time 0 is " + cells[i], "changes begin at 0");
      }
      column.time.push_back(time);
      column.pressure_change.push_back(parsed.value);
    }
    return true;
  }

  bool refuse(const std::string& what, const std::string& cure) {
    result_.what = given_ + (line_ > 0 ? concat(" line ", line_) : std::string()) + ": " + what;
    result_.cure = cure;
    return false;
  }
  bool has_header() const { return !names_.empty(); }
  bool has_rows() const { return has_header() && !result_.columns[0].time.empty(); }
  void set_line(int line) { line_ = line; }
  PressureCsv result() && { return std::move(result_); }

 private:
  std::string given_;
  int line_ = 0;
  std::vector<std::string> names_;
  std::vector<std::string> units_;
  PressureCsv result_;
};

}  // namespace

PressureCsv read_pressure_csv(const std::string& path, const std::string& given) {
  CsvReader reader(given);
  constexpr std::size_t kMostBytes = 16'000'000;  // 10^5 rows of ten columns
  const InputText file = read_input_file(path, kMostBytes);
  if (!file.what.empty()) {
    const bool relative = !given.empty() && given[0] != '/';
    reader.refuse(file.what,
                  relative ? file.cure + "; it is taken from the folder of the scene" : file.cure);
    return std::move(reader).result();
  }
  std::istringstream lines(file.text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (number == 1 && line.compare(0, 3, "\xEF\xBB\xBF") == 0)
      line.erase(0, 3);  // of spreadsheets
    const std::string text = trimmed(line);
    if (text.empty() || text[0] == '#') continue;
    reader.set_line(number);
    if (!(reader.has_header() ? reader.row(line) : reader.header(line))) {
      return std::move(reader).result();
    }
  }
  reader.set_line(0);
  if (!reader.has_rows()) reader.refuse("there are no values", kHeaderCure);
  return std::move(reader).result();
}

}  // namespace faultsim
