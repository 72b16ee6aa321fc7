#include "simulator/flow/flow_csv.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "simulator/common/csv_text.h"
#include "simulator/common/dates.h"
#include "simulator/common/errors.h"
#include "simulator/common/units.h"

namespace faultsim {
namespace {

constexpr std::size_t kMostProblems = 20;
constexpr std::array<const char*, 6> kPlaces{"x", "y", "depth", "dx", "dy", "dz"};
constexpr const char* kFlowHeaderCure =
    "head the columns x [m], y [m], depth [m], dx [m], dy [m], dz [m], then 1990-01-01 [bar] and "
    "so on, or begin with date and end with pressure [bar]";

/// A column's value in SI is size · number + zero.
struct Unit {
  double size = 1, zero = 0;
};

using Place = std::array<double, 6>;  ///< x, y, depth, dx, dy, dz; m.

/// Reads rows into reports; keeps every problem until there are too many to be of use.
class FlowCsvReader {
 public:
  FlowCsvReader(std::string given, FlowQuantity quantity)
      : given_(std::move(given)), is_pressure_(quantity == FlowQuantity::pressure) {}

  FlowField read(const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    for (line_ = 1; std::getline(lines, line); ++line_) {
      if (line_ == 1) remove_byte_order_mark(line);
      const std::string words = trimmed(line);
      if (words.empty() || words[0] == '#') continue;
      if (units_.empty()) {
        header(csv_cells(line));
        if (!problems_.empty()) break;
      } else {
        row(csv_cells(line));
      }
    }
    line_ = 0;
    if (problems_.empty() && places_.empty()) refuse("there are no values", kFlowHeaderCure);
    if (is_long_) require_every_cell();
    if (!problems_.empty()) throw InputError(given_, problems_);
    return result();
  }

 private:
  void refuse(const std::string& what, const std::string& cure) {
    if (problems_.size() < kMostProblems) problems_.push_back({"", line_, what, cure});
  }

  /// What a unit is in SI; none where it is of another dimension.
  static std::optional<Unit> unit_of(const std::string& unit, Dimension dimension) {
    if (dimension == Dimension::temperature) {  // of degrees that do not begin at nothing
      constexpr double kKelvin = 273.15, kFahrenheit = 459.67, kRankine = 5.0 / 9;
      if (unit == "degC") return Unit{1, kKelvin};
      if (unit == "degF") return Unit{kRankine, kFahrenheit * kRankine};
    }
    const ParsedQuantity one = parse_quantity("1 " + unit, dimension);
    if (!one.ok) return std::nullopt;
    return Unit{one.value, 0};
  }

  /// "depth [m]" → name and unit, checked; name "" after a refusal.
  std::string column(const std::string& text, Dimension dimension) {
    const auto open = text.rfind('[');
    const auto close = text.rfind(']');
    const bool whole = open != std::string::npos && close != std::string::npos && open < close;
    const std::string unit = whole ? trimmed(text.substr(open + 1, close - open - 1)) : "";
    const std::optional<Unit> size = whole ? unit_of(unit, dimension) : std::nullopt;
    units_.push_back(size.value_or(Unit{}));
    if (!whole) {
      refuse("column \"" + text + "\" has no unit in brackets", kFlowHeaderCure);
      return "";
    }
    if (!size) {
      refuse("column \"" + text + "\" does not hold " + info_of(dimension).noun, kFlowHeaderCure);
      return "";
    }
    return trimmed(text.substr(0, open));
  }

  void header(const std::vector<std::string>& cells) {
    is_long_ = cells[0] == "date";
    if (is_long_) units_.emplace_back();
    const std::size_t first = is_long_ ? 1 : 0;
    if (cells.size() < first + 7 || (is_long_ && cells.size() != 8)) {
      units_.resize(cells.size());
      return refuse(concat("has ", cells.size(), " columns"), kFlowHeaderCure);
    }
    for (std::size_t i = 0; i < 6; ++i) {
      const std::string name = column(cells[first + i], Dimension::length);
      if (!name.empty() && name != kPlaces[i])
        refuse(concat("column ", first + i + 1, " is \"", name, "\" and not ", kPlaces[i]),
               kFlowHeaderCure);
    }
    for (std::size_t i = first + 6; i < cells.size(); ++i) {
      const std::string name =
          column(cells[i], is_pressure_ ? Dimension::pressure : Dimension::temperature);
      if (name.empty()) continue;
      if (!is_long_)
        next_date(name);
      else if (name != quantity())
        refuse("the last column is \"" + name + "\" and not " + quantity(), kFlowHeaderCure);
    }
  }

  /// Adds a report, unless its date is none or does not come after the one before.
  bool next_date(const std::string& text) {
    const std::optional<double> date = parse_date(text);
    if (!date) {
      refuse("\"" + text + "\" is not a date", "write dates as year-month-day: 1990-01-31");
      return false;
    }
    if (!dates_.empty() && *date == dates_.back() && is_long_) return true;
    if (!dates_.empty() && *date <= dates_.back()) {
      refuse("the date " + text + " does not come after the one before",
             "write the reports in the order of time, each once");
      return false;
    }
    dates_.push_back(*date);
    date_names_.push_back(text);
    pressures_.emplace_back();
    return true;
  }

  std::string quantity() const { return is_pressure_ ? "pressure" : "temperature"; }

  std::optional<double> number(const std::vector<std::string>& cells, std::size_t i) {
    char* end = nullptr;
    const double value = std::strtod(cells[i].c_str(), &end);
    if (!cells[i].empty() && *end == '\0' && std::isfinite(value))
      return units_[i].size * value + units_[i].zero;
    refuse(concat("\"", cells[i], "\" in column ", i + 1, " is not a number"),
           "leave inactive cells out; units stand in the header only");
    return std::nullopt;
  }

  std::optional<Place> place(const std::vector<std::string>& cells, std::size_t first) {
    Place place{};
    for (std::size_t i = 0; i < place.size(); ++i) {
      const std::optional<double> value = number(cells, first + i);
      if (!value) return std::nullopt;
      if (i >= 3 && *value <= 0) {
        refuse(concat(kPlaces[i], " is ", cells[first + i]), "write sizes above zero");
        return std::nullopt;
      }
      place[i] = *value;
    }
    return place;
  }

  void row(const std::vector<std::string>& cells) {
    if (cells.size() != units_.size()) {
      return refuse(concat("has ", cells.size(), " values for ", units_.size(), " columns"),
                    "write one value per column");
    }
    if (is_long_ && !next_date(cells[0])) return;
    const std::size_t first = is_long_ ? 1 : 0;
    const std::optional<Place> at = place(cells, first);
    if (!at) return;
    const auto [known, is_new] = numbers_.try_emplace(*at, std::ssize(places_));
    if (is_new) places_.push_back(*at);
    for (std::size_t i = first + 6; i < cells.size(); ++i) {
      const std::optional<double> value = number(cells, i);
      if (!value) continue;
      if (*value < 0) {
        refuse("the " + quantity() + " " + cells[i] + " is below zero",
               "write absolute " + quantity() + "s, not changes");
      }
      auto& report = is_long_ ? pressures_.back() : pressures_[i - first - 6];
      if (!report.try_emplace(known->second, *value).second)
        return refuse("the cell is there twice", "give each cell one value per report");
    }
  }

  /// In the long form a cell can be missing at a date.
  void require_every_cell() {
    for (std::size_t t = 0; t < pressures_.size(); ++t) {
      const std::size_t n_missing = places_.size() - pressures_[t].size();
      if (n_missing == 0 || !problems_.empty()) continue;
      refuse(concat(n_missing, " of ", places_.size(), " cells are missing at ", date_names_[t]),
             "write every cell at every date");
      return;
    }
  }

  FlowField result() const {
    FlowField field;
    field.date = dates_;
    for (const Place& p : places_) {
      const Eigen::Vector3d centre(p[0], p[1], -p[2]);
      const Eigen::Vector3d half = 0.5 * Eigen::Vector3d(p[3], p[4], p[5]);
      field.cells.push_back({.low = centre - half, .high = centre + half});
    }
    field.value.resize(std::ssize(places_), std::ssize(dates_));
    for (std::size_t t = 0; t < pressures_.size(); ++t) {
      for (const auto& [cell, value] : pressures_[t])
        field.value(cell, static_cast<Eigen::Index>(t)) = value;
    }
    return field;
  }

  std::string given_;
  int line_ = 0;
  bool is_long_ = false;
  bool is_pressure_;
  std::vector<Unit> units_;  ///< of all columns; of dates nothing.
  std::vector<double> dates_;
  std::vector<std::string> date_names_;
  std::vector<Place> places_;
  std::map<Place, Eigen::Index> numbers_;
  std::vector<std::map<Eigen::Index, double>> pressures_;  ///< per report: cell → Pa.
  std::vector<Problem> problems_;
};

}  // namespace

FlowField parse_flow_csv(const std::string& text, const std::string& given, FlowQuantity quantity) {
  return FlowCsvReader(given, quantity).read(text);
}

}  // namespace faultsim
