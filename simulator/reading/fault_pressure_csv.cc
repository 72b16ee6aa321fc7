#include "simulator/reading/fault_pressure_csv.h"

#include <Eigen/Core>
#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "simulator/common/dates.h"
#include "simulator/common/ranges.h"
#include "simulator/common/table_reader.h"
#include "simulator/flow/report_choice.h"

namespace faultsim {
namespace {

constexpr const char* kTableHeaderCure =
    "name the columns depth [m] (or along_dip [m]), optionally along_strike [m], then the times: "
    "0 year [bar], 1 year [bar]";

class FaultTable {
 public:
  FaultTable(const std::string& text, const std::string& given, std::optional<double> start)
      : reader_(text, given), start_(start) {}

  FaultPressureCsv read() {
    header();
    reader_.require_sound();
    while (reader_.next_row()) row();
    reader_.require_rows(kTableHeaderCure);
    arrange();
    reader_.require_sound();
    return std::move(result_);
  }

 private:
  void header() {
    const std::vector<TableColumn>& columns = reader_.columns();
    if (!reader_.has_header(kTableHeaderCure)) return;
    if (columns[0].name == "along_dip") {
      table().place = FaultPressureTable::Place::along_dip;
    } else if (columns[0].name != "depth") {
      return reader_.refuse("the first column is " + table_quote(columns[0].name),
                            kTableHeaderCure);
    }
    first_time_ = columns.size() > 1 && columns[1].name == "along_strike" ? 2 : 1;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const bool is_place = i < first_time_;
      const bool is_sound =
          reader_.set_unit(i, is_place ? Dimension::length : Dimension::pressure,
                           is_place ? kLengthRange : kPressureChangeRange, kTableHeaderCure);
      if (!is_place && is_sound) time(columns[i].name);
    }
    if (reader_.is_sound() && table().time.size() < 2)
      reader_.refuse("has fewer than two times", kTableHeaderCure);
  }

  void time(const std::string& text) {
    const std::optional<double> date = parse_date(text);
    const ParsedQuantity after = parse_quantity(text, Dimension::time);
    if (!date && !(after.ok && after.value <= kTimeRange.high))
      return reader_.refuse(table_quote(text) + " is neither a time nor a date", kTableHeaderCure);
    std::vector<double>& times = table().time;
    if (!times.empty() && date.has_value() != result_.has_dates)
      return reader_.refuse("some columns have dates and some have times", "use one of the two");
    result_.has_dates = date.has_value();
    if (date && !start_) start_ = date;
    const double seconds = date ? *date - *start_ : after.value;
    if (times.empty() && seconds != 0) {
      reader_.refuse("the first column is at " + text + " and not at time 0",
                     "begin with the pressures that the scene starts from");
    } else if (!times.empty() && seconds <= times.back()) {
      reader_.refuse("the time " + text + " does not come after the one before",
                     "write the times in order, each once");
    }
    times.push_back(seconds);
  }

  void row() {
    std::vector<double> values;
    for (std::size_t i = 0; i < reader_.columns().size(); ++i) {
      if (const std::optional<double> value = reader_.value(i)) values.push_back(*value);
    }
    if (values.size() < reader_.columns().size()) return;
    const std::pair<double, double> place{values[0], has_strike() ? values[1] : 0};
    values.erase(values.begin(), values.begin() + static_cast<long>(first_time_));
    if (!rows_.try_emplace(place, std::move(values)).second)
      reader_.refuse("the place is given twice", "give each place one row");
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
    std::ranges::sort(strikes);
    drop_repeated(strikes);
    if (has_strike()) to.strike = strikes;
    if (rows_.size() != to.dip.size() * strikes.size()) {
      return reader_.refuse_at(
          0,
          concat("has ", rows_.size(), " places for ", to.dip.size(), " values of ",
                 to.place == FaultPressureTable::Place::depth ? "depth" : "along_dip", " and ",
                 strikes.size(), " of along_strike"),
          "write a row for every pair");
    }
    constexpr double kSame = 1;  // Pa
    const Eigen::Map<const Eigen::MatrixXd> by_time(to.change.data(), std::ssize(to.time),
                                                    static_cast<Eigen::Index>(rows_.size()));
    for (const int i : needed_reports(to.time, by_time.transpose(), kSame))
      to.turns.push_back(to.time[static_cast<std::size_t>(i)]);
  }

  bool has_strike() const { return first_time_ == 2; }
  FaultPressureTable& table() { return result_.table; }

  TableReader reader_;
  std::optional<double> start_;
  std::size_t first_time_ = 1;  ///< column.
  std::map<std::pair<double, double>, std::vector<double>> rows_;
  FaultPressureCsv result_;
};

}  // namespace

FaultPressureCsv parse_fault_pressure_csv(const std::string& text, const std::string& given,
                                          std::optional<double> start) {
  return FaultTable(text, given, start).read();
}

}  // namespace faultsim
