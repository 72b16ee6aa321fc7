#include "simulator/reading/pressure_csv.h"

#include <map>

#include "simulator/common/dates.h"
#include "simulator/common/table_reader.h"

namespace faultsim {
namespace {

constexpr const char* kPressureHeaderCure =
    "the first line names columns and units: time [year], west [bar], east [bar]";
constexpr const char* kPressureColumnCure =
    "head it with its region and unit: west [bar] for changes, west [bar] absolute for pressures";

class PressureTable {
 public:
  PressureTable(const std::string& text, const std::string& given, std::optional<double> start)
      : reader_(text, given) {
    result_.start = start;
  }

  PressureCsv read() {
    header();
    reader_.require_sound();
    while (reader_.next_row()) row();
    reader_.require_rows(kPressureHeaderCure);
    return std::move(result_);
  }

 private:
  void header() {
    const std::vector<TableColumn>& columns = reader_.columns();
    if (!reader_.has_header(kPressureHeaderCure)) return;
    result_.has_dates = columns[0].text == "date";
    if (columns.size() < 2 || (!result_.has_dates && columns[0].name != "time"))
      return reader_.refuse("the first column is not \"time\" or \"date\" followed by others",
                            kPressureHeaderCure);
    if (!result_.has_dates) reader_.set_unit(0, Dimension::time, kTimeRange, kPressureHeaderCure);
    std::map<std::string, std::size_t> seen;
    for (std::size_t i = 1; i < columns.size(); ++i) {
      const TableColumn& one = columns[i];
      const bool absolute = one.words == "absolute";
      reader_.set_unit(i, Dimension::pressure, absolute ? kPressureRange : kPressureChangeRange,
                       kPressureColumnCure, {"absolute", "change"});
      const auto [first, is_new] = seen.try_emplace(one.name, i + 1);
      if (one.name.empty()) {
        reader_.refuse(concat("column ", i + 1, " has no name"), "name its pressure region");
      } else if (!is_new) {
        reader_.refuse(
            concat("columns ", first->second, " and ", i + 1, " are both ", table_quote(one.name)),
            "keep one of the two");
      }
      result_.columns.push_back({one.name, absolute, {}});
    }
  }

  void row() {
    const bool is_next = result_.has_dates ? date() : time();
    for (std::size_t i = 1; i < reader_.columns().size(); ++i) {
      if (!reader_.number(i)) continue;
      const std::string cell(reader_.cell(i)), unit = *reader_.columns()[i].unit;
      // In long double and rounded once, as in scenes.
      const double pressure = parse_quantity(cell + " " + unit, Dimension::pressure).value;
      PressureColumn& column = result_.columns[i - 1];
      if (!column.is_absolute && is_next && result_.time.back() == 0 && pressure != 0) {
        reader_.refuse("the change at time 0 is " + cell,
                       "changes begin at 0; name a column of pressures \"" + column.region + " [" +
                           unit + "] absolute\"");
      }
      column.pressure.push_back(pressure);
    }
  }

  bool date() {
    const std::string cell(reader_.cell(0));
    const std::optional<double> seconds = parse_date(cell);
    if (!seconds) {
      reader_.refuse(table_quote(cell) + " is not a date",
                     "write dates as year-month-day: 1990-01-31");
      return false;
    }
    if (!result_.start) result_.start = seconds;
    if (*seconds < *result_.start) {
      reader_.refuse("the date " + cell + " is before time 0",
                     "begin the table at the scene's start_date, or make that earlier");
      return false;
    }
    return next_time(*seconds - *result_.start, "the date " + cell, "write dates that increase");
  }

  bool time() {
    if (!reader_.number(0)) return false;
    const std::string cell(reader_.cell(0)), unit = *reader_.columns()[0].unit;
    return next_time(parse_quantity(cell + " " + unit, Dimension::time).value, "time " + cell,
                     "write increasing times from 0 on");
  }

  bool next_time(double time, const std::string& name, const std::string& cure) {
    const bool is_later = result_.time.empty() || time > result_.time.back();
    if (!is_later) reader_.refuse(name + " does not come after the one before", cure);
    result_.time.push_back(time);
    return is_later;
  }

  TableReader reader_;
  PressureCsv result_;
};

}  // namespace

PressureCsv parse_pressure_csv(const std::string& text, const std::string& given,
                               std::optional<double> start) {
  return PressureTable(text, given, start).read();
}

}  // namespace faultsim
