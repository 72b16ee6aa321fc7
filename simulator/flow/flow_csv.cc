#include "simulator/flow/flow_csv.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "simulator/common/dates.h"
#include "simulator/common/table_reader.h"
#include "simulator/flow/regular_cells.h"

namespace faultsim {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<const char*, 6> kPlaces{"x", "y", "depth", "dx", "dy", "dz"};
constexpr std::size_t kDepth = 2, kFirstSize = 3;  // in kPlaces

using Place = std::array<double, 6>;  ///< as kPlaces, m; 0 where there is no such column.

class FlowTable {
 public:
  FlowTable(const std::string& text, const std::string& given, FlowQuantity quantity)
      : reader_(text, given), is_pressure_(quantity == FlowQuantity::pressure) {
    const std::string unit = is_pressure_ ? " [bar]" : " [degC]";
    header_cure_ =
        "head the columns x [m], y [m], depth [m], dx [m], dy [m], dz [m], then "
        "1990-01-01" +
        unit + " and so on, or begin with date and end with " + name_of_value() + unit +
        "; depth and sizes may be left out of regular grids";
  }

  FlowField read() {
    header();
    reader_.require_sound();
    while (reader_.next_row()) row();
    reader_.require_rows(header_cure_);
    require_every_cell();
    FlowField field;
    if (reader_.is_sound()) field = result();
    reader_.require_sound();
    return field;
  }

 private:
  std::string name_of_value() const { return is_pressure_ ? "pressure" : "temperature"; }

  void header() {
    const std::vector<TableColumn>& columns = reader_.columns();
    if (!reader_.has_header(header_cure_)) return;
    is_long_ = columns[0].text == "date";
    for (first_value_ = is_long_ ? 1 : 0; first_value_ < columns.size(); ++first_value_) {
      const std::string& name = columns[first_value_].name;
      const auto place = std::ranges::find(kPlaces, name);
      if (place == kPlaces.end()) break;
      const auto k = static_cast<std::size_t>(place - kPlaces.begin());
      if (column_[k]) reader_.refuse("there are two columns " + name, "remove one of the two");
      column_[k] = first_value_;
      reader_.set_unit(first_value_, Dimension::length, k < kFirstSize ? kLengthRange : kSizeRange,
                       header_cure_);
    }
    for (const std::size_t k : {0, 1}) {
      if (!column_[k])
        reader_.refuse(concat("there is no column ", kPlaces[k], " before the values"),
                       header_cure_);
    }
    if (column_[5] && !column_[kDepth])
      reader_.refuse("there is a column dz and none of depth", "add depth [m], or leave dz out");
    value_headings();
  }

  void value_headings() {
    const std::vector<TableColumn>& columns = reader_.columns();
    const std::size_t n_values = columns.size() - first_value_;
    if (n_values == 0 || (is_long_ && n_values > 1))
      return reader_.refuse(concat("has ", n_values, " columns of values"), header_cure_);
    std::optional<std::string> refused_unit;  // the same in all columns is said once
    for (std::size_t i = first_value_; i < columns.size(); ++i) {
      const TableColumn& one = columns[i];
      const bool is_named = is_long_ ? one.name == name_of_value() : next_date(one.name);
      if (!is_named && is_long_)
        reader_.refuse(
            "the last column is " + table_quote(one.name) + " and not " + name_of_value(),
            header_cure_);
      if (!is_named) return;
      const std::string unit = one.text.substr(one.name.size());
      if (unit == refused_unit) continue;
      if (!reader_.set_unit(i, is_pressure_ ? Dimension::pressure : Dimension::temperature,
                            is_pressure_ ? kPressureRange : kTemperatureRange, header_cure_))
        refused_unit = unit;
    }
  }

  /// Adds a report, unless its date is none or does not come after the one before.
  bool next_date(std::string_view text) {
    if (!date_names_.empty() && text == date_names_.back() && is_long_) return true;
    const std::optional<double> date = parse_date(std::string(text));
    if (!date) {
      reader_.refuse(
          table_quote(text) +
              (is_long_ ? " is not a date" : " is neither a date nor x, y, depth, dx, dy or dz"),
          "write dates as year-month-day, behind the columns of the place: 1990-01-31");
      return false;
    }
    if (!dates_.empty() && *date == dates_.back() && is_long_) return true;
    if (!dates_.empty() && *date <= dates_.back()) {
      reader_.refuse("the date " + std::string(text) + " does not come after the one before",
                     "write the reports in the order of time, each once");
      return false;
    }
    dates_.push_back(*date);
    date_names_.emplace_back(text);
    values_.emplace_back();
    return true;
  }

  std::optional<Place> place() {
    Place place{};
    bool is_whole = true;
    for (std::size_t k = 0; k < place.size(); ++k) {
      if (!column_[k]) continue;
      const std::optional<double> value = reader_.value(*column_[k]);
      is_whole = is_whole && value;
      place[k] = value.value_or(0);
    }
    if (!is_whole) return std::nullopt;
    return place;
  }

  void row() {
    if (is_long_ && !next_date(reader_.cell(0))) return;
    const std::optional<Place> at = place();
    if (!at) return;
    const auto [known, is_new] = numbers_.try_emplace(*at, places_.size());
    if (is_new) {
      places_.push_back(*at);
      lines_.push_back(reader_.line());
    }
    const std::size_t cell = known->second;
    for (std::size_t i = first_value_; i < reader_.columns().size(); ++i) {
      const std::optional<double> value = reader_.value(i);
      std::vector<double>& report = is_long_ ? values_.back() : values_[i - first_value_];
      if (report.size() < places_.size()) report.resize(places_.size(), kNone);
      if (!std::isnan(report[cell]))
        return reader_.refuse("the cell is there twice", "give each cell one value per report");
      report[cell] = value.value_or(kNone);
    }
  }

  /// In the long form a cell can be missing at a date.
  void require_every_cell() {
    for (std::size_t t = 0; t < values_.size(); ++t) {
      const auto n_missing = places_.size() - values_[t].size() +
                             static_cast<std::size_t>(std::ranges::count_if(
                                 values_[t], [](double value) { return std::isnan(value); }));
      if (n_missing == 0) continue;
      return reader_.refuse_at(
          0, concat(n_missing, " of ", places_.size(), " cells are missing at ", date_names_[t]),
          "write every cell at every date");
    }
  }

  /// [low, high] of all cells along an axis, downwards for depths; empty after a refusal.
  std::vector<std::array<double, 2>> reach(std::size_t axis) {
    std::vector<std::array<double, 2>> given;
    if (axis == kDepth && !column_[kDepth]) {
      constexpr double kFar = 1e5;  // m: the values hold at all depths
      given.assign(places_.size(), {-kFar, kFar});
    } else if (const std::size_t size = kFirstSize + axis; column_[size]) {
      for (const Place& p : places_)
        given.push_back({p[axis] - 0.5 * p[size], p[axis] + 0.5 * p[size]});
    } else {
      return inferred_reach(axis);
    }
    return given;
  }

  std::vector<std::array<double, 2>> inferred_reach(std::size_t axis) {
    std::map<std::array<double, 2>, int> columns;  // of cells above each other
    std::vector<int> line;
    std::vector<double> at;
    for (const Place& p : places_) {
      line.push_back(
          axis == kDepth
              ? columns.try_emplace({p[0], p[1]}, static_cast<int>(columns.size())).first->second
              : 0);
      at.push_back(p[axis]);
    }
    CellReach cells = regular_cells(line, at);
    if (!cells.what.empty()) {
      const std::string name = kPlaces[axis], size = kPlaces[kFirstSize + axis];
      reader_.refuse_at(
          lines_[cells.cell], name + " " + cells.what + ": the size of the cells is not known",
          "add a column " + size + " [m]" +
              (axis == kDepth ? ", or leave depth out: the values then hold at all depths"
                              : "; x and y are those of the grid's own axes, which the scene turns "
                                "and shifts with \"azimuth\" and \"origin\""));
    }
    return std::move(cells.reach);
  }

  FlowField result() {
    FlowField field;
    const auto x = reach(0), y = reach(1), depth = reach(kDepth);
    if (!reader_.is_sound()) return field;
    field.date = dates_;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      field.cells.push_back(
          {.low = {x[i][0], y[i][0], -depth[i][1]}, .high = {x[i][1], y[i][1], -depth[i][0]}});
    }
    field.value.resize(std::ssize(places_), std::ssize(dates_));
    for (std::size_t t = 0; t < values_.size(); ++t)
      field.value.col(static_cast<Eigen::Index>(t)) =
          Eigen::Map<const Eigen::VectorXd>(values_[t].data(), std::ssize(values_[t]));
    return field;
  }

  TableReader reader_;
  bool is_pressure_;
  std::string header_cure_;
  bool is_long_ = false;
  std::array<std::optional<std::size_t>, 6> column_;  ///< of kPlaces.
  std::size_t first_value_ = 0;                       ///< column.
  std::vector<double> dates_;
  std::vector<std::string> date_names_;
  std::vector<Place> places_;
  std::vector<int> lines_;  ///< where each place stands first.
  std::map<Place, std::size_t> numbers_;
  std::vector<std::vector<double>> values_;  ///< per report and cell; NaN: missing.
};

}  // namespace

FlowField parse_flow_csv(const std::string& text, const std::string& given, FlowQuantity quantity) {
  return FlowTable(text, given, quantity).read();
}

}  // namespace faultsim
