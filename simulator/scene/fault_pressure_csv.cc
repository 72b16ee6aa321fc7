#include "simulator/scene/fault_pressure_csv.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>
#include <utility>
#include <vector>

#include "simulator/common/csv_text.h"
#include "simulator/common/dates.h"
#include "simulator/common/errors.h"
#include "simulator/common/units.h"
#include "simulator/flow/report_choice.h"

namespace faultsim {
namespace {

constexpr const char* kTableHeaderCure =
    "head the columns depth [m] (or along_dip [m]), perhaps along_strike [m], then the times: "
    "0 year [bar], 1 year [bar]";

/// "1 year [bar]": what stands before the brackets and within.
struct Heading {
  std::string name, unit;
};

class TableReader {
 public:
  TableReader(std::string given, std::optional<double> start)
      : given_(std::move(given)), start_(start) {}

  FaultPressureCsv read(const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    for (line_ = 1; result_.what.empty() && std::getline(lines, line); ++line_) {
      if (line_ == 1) remove_byte_order_mark(line);
      const std::string words = trimmed(line);
      if (words.empty() || words[0] == '#') continue;
      if (factors_.empty()) {
        header(csv_cells(line));
      } else {
        row(csv_cells(line));
      }
    }
    line_ = 0;
    if (result_.what.empty() && rows_.empty()) refuse("there are no values", kTableHeaderCure);
    if (result_.what.empty()) arrange();
    return std::move(result_);
  }

 private:
  void refuse(const std::string& what, const std::string& cure) {
    if (!result_.what.empty()) return;
    result_.what = given_ + (line_ > 0 ? concat(" line ", line_) : std::string()) + ": " + what;
    result_.cure = cure;
  }

  /// A heading with its unit, whose size in SI is kept; an empty name after a refusal.
  Heading heading(const std::string& text, Dimension dimension) {
    const auto open = text.rfind('['), close = text.rfind(']');
    const bool whole = open != std::string::npos && close != std::string::npos && open < close;
    const std::string unit = whole ? trimmed(text.substr(open + 1, close - open - 1)) : "";
    const ParsedQuantity one = parse_quantity("1 " + unit, dimension);
    factors_.push_back(one.value);
    if (!whole || !one.ok) {
      refuse("column \"" + text + "\" does not hold " + info_of(dimension).noun + " with its unit",
             kTableHeaderCure);
      return {};
    }
    return {trimmed(text.substr(0, open)), unit};
  }

  void header(const std::vector<std::string>& cells) {
    const Heading place = heading(cells[0], Dimension::length);
    if (place.name == "along_dip") {
      table().place = FaultPressureTable::Place::along_dip;
    } else if (place.name != "depth") {
      return refuse("the first column is \"" + place.name + "\"", kTableHeaderCure);
    }
    has_strike_ = cells.size() > 1 && cells[1].rfind("along_strike", 0) == 0;
    if (has_strike_) heading(cells[1], Dimension::length);
    for (std::size_t i = first_time(); i < cells.size(); ++i) {
      time(heading(cells[i], Dimension::pressure).name);
    }
    if (table().time.size() < 2) refuse("has fewer than two times", kTableHeaderCure);
  }

  void time(const std::string& text) {
    const std::optional<double> date = parse_date(text);
    const ParsedQuantity after = parse_quantity(text, Dimension::time);
    if (!date && !after.ok) {
      return refuse("\"" + text + "\" is neither a time nor a date", kTableHeaderCure);
    }
    std::vector<double>& times = table().time;
    if (!times.empty() && date.has_value() != result_.has_dates) {
      return refuse("some columns have dates and some have times", "keep to one of the two");
    }
    result_.has_dates = date.has_value();
    if (date && !start_) start_ = date;
    const double seconds = date ? *date - *start_ : after.value;
    if (times.empty() && seconds != 0) {
      refuse("the first column is at " + text + " and not at time 0",
             "begin with the pressures that the scene starts from");
    } else if (!times.empty() && seconds <= times.back()) {
      refuse("the time " + text + " does not come after the one before",
             "write the times in their order, each once");
    }
    times.push_back(seconds);
  }

  void row(const std::vector<std::string>& cells) {
    if (cells.size() != factors_.size()) {
      return refuse(concat("has ", cells.size(), " values for ", factors_.size(), " columns"),
                    "write one value per column");
    }
    std::vector<double> values;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      char* end = nullptr;
      const double number = std::strtod(cells[i].c_str(), &end);
      if (cells[i].empty() || *end != '\0' || !std::isfinite(number)) {
        return refuse("\"" + cells[i] + "\" is not a number", "units stand in the header only");
      }
      values.push_back(number * factors_[i]);
    }
    const std::pair<double, double> place{values[0], has_strike_ ? values[1] : 0};
    const std::vector<double> pressures(values.begin() + static_cast<long>(first_time()),
                                        values.end());
    if (!rows_.try_emplace(place, pressures).second)
      refuse("the place is there twice", "give each place one row");
  }

  /// Rows in order of place, as changes since the first time; and the times at which they turn.
  void arrange() {
    FaultPressureTable& to = table();
    std::vector<double> strikes;
    for (const auto& [place, values] : rows_) {
      if (to.dip.empty() || to.dip.back() != place.first) to.dip.push_back(place.first);
      strikes.push_back(place.second);
      for (const double value : values) to.change.push_back(value - values.front());
    }
    std::sort(strikes.begin(), strikes.end());
    strikes.erase(std::unique(strikes.begin(), strikes.end()), strikes.end());
    if (has_strike_) to.strike = strikes;
    if (rows_.size() != to.dip.size() * strikes.size()) {
      return refuse(concat("has ", rows_.size(), " places for ", to.dip.size(), " values of ",
                           to.place == FaultPressureTable::Place::depth ? "depth" : "along_dip",
                           " and ", strikes.size(), " of along_strike"),
                    "write a row for every pair");
    }
    constexpr double kSame = 1;  // Pa
    const Eigen::Map<const Eigen::MatrixXd> by_time(to.change.data(), std::ssize(to.time),
                                                    static_cast<Eigen::Index>(rows_.size()));
    for (const int i : needed_reports(to.time, by_time.transpose(), kSame))
      to.turns.push_back(to.time[static_cast<std::size_t>(i)]);
  }

  std::size_t first_time() const { return has_strike_ ? 2 : 1; }
  FaultPressureTable& table() { return result_.table; }

  std::string given_;
  std::optional<double> start_;
  int line_ = 0;
  bool has_strike_ = false;
  std::vector<double> factors_;  ///< of the columns: SI per unit.
  std::map<std::pair<double, double>, std::vector<double>> rows_;
  FaultPressureCsv result_;
};

}  // namespace

FaultPressureCsv parse_fault_pressure_csv(const std::string& text, const std::string& given,
                                          std::optional<double> start) {
  return TableReader(given, start).read(text);
}

}  // namespace faultsim
