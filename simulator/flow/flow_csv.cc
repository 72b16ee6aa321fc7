#include "simulator/flow/flow_csv.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "simulator/common/dates.h"
#include "simulator/common/ranges.h"
#include "simulator/common/table_reader.h"
#include "simulator/common/text.h"
#include "simulator/flow/point_cells.h"

namespace faultsim {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

class FlowTable {
 public:
  FlowTable(std::string_view text, const std::string& given, FlowQuantity quantity)
      : reader_(text, given), is_pressure_(quantity == FlowQuantity::pressure) {
    const std::string unit = is_pressure_ ? " [bar]" : " [degC]";
    header_cure_ =
        "name the columns x [m], y [m], depth [m], dx [m], dy [m], dz [m], then "
        "1990-01-01" +
        unit + " and so on, or give a column date and one of " + name_of_value() + unit +
        "; depth and sizes may be left out (docs/your-field.md)";
  }

  FlowField read() {
    header();
    reader_.require_sound();
    while (reader_.next_row()) row();
    reader_.require_rows(header_cure_);
    require_every_cell();
    require_depths();
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
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::string name = lower_case(columns[i].name);
      if (!date_column_ && (name == "date" || name == "time")) date_column_ = i;
    }
    if (date_column_ && columns[*date_column_].unit) {
      reader_.refuse(
          table_quote(columns[*date_column_].text) + " counts from a day that is not given",
          "write dates, in a column date without a unit: 1990-01-31");
    }
    if (date_column_)
      long_header();
    else
      wide_header();
    for (const std::size_t k : {0, 1}) {
      if (!column_[k])
        reader_.refuse(concat("there is no column ", kPlaceColumns[k],
                              date_column_ ? "" : " before the values"),
                       header_cure_);
    }
    require_all_indices();
    note_what_is_not_used();
    if (column_[5] && !column_[kDepthColumn])
      reader_.refuse("there is a column dz but none of depth", "add depth [m], or leave dz out");
  }

  /// Places, then dates.
  void wide_header() {
    const std::vector<TableColumn>& columns = reader_.columns();
    std::size_t first = 0;
    while (first < columns.size() && take_place(first)) ++first;
    for (std::size_t i = first; i < columns.size(); ++i) value_columns_.push_back(i);
    value_headings();
  }

  /// Whether a column is one of those of the place; then it is taken.
  bool take_place(std::size_t i) {
    const std::string name = lower_case(reader_.columns()[i].name);
    if (take_index(i, name)) return true;
    const bool is_height = name == "z";
    const auto place =
        is_height ? kPlaceColumns.begin() + kDepthColumn : std::ranges::find(kPlaceColumns, name);
    if (place == kPlaceColumns.end()) return false;
    const auto k = static_cast<std::size_t>(place - kPlaceColumns.begin());
    if (column_[k]) {
      reader_.refuse(is_height || is_upwards_ ? "there are columns of z and of depth, or two of z"
                                              : "there are two columns " + name,
                     "remove one of the two");
    }
    is_upwards_ = is_upwards_ || is_height;
    column_[k] = i;
    reader_.set_unit(i, Dimension::length, k < kFirstSizeColumn ? kLengthRange : kSizeRange,
                     header_cure_);
    return true;
  }

  /// Whether it is i, j or k, which have no unit; then it is taken.
  bool take_index(std::size_t i, const std::string& name) {
    const auto known = std::ranges::find(kIndexColumns, name);
    if (known == kIndexColumns.end() || reader_.columns()[i].unit) return false;
    std::optional<std::size_t>& column =
        index_column_[static_cast<std::size_t>(known - kIndexColumns.begin())];
    if (column) reader_.refuse("there are two columns " + name, "remove one of the two");
    column = i;
    return true;
  }

  /// One alone is a property like others, and they are of no use without depths.
  void require_all_indices() {
    std::vector<std::string> there, missing;
    for (std::size_t k = 0; k < kIndexColumns.size(); ++k)
      (index_column_[k] ? there : missing).emplace_back(kIndexColumns[k]);
    if (there.empty() || (missing.empty() && column_[kDepthColumn])) return;
    const bool is_property = date_column_ && there.size() == 1;
    if (column_[kDepthColumn] && !is_property) {
      return reader_.refuse(
          concat("has ", joined(there, " and "), " but no ", joined(missing, ", no ")),
          "give all of i, j and k, by which cells are known, or none of them");
    }
    for (std::optional<std::size_t>& column : index_column_) {
      if (column) not_used_.push_back(*column);
      column.reset();
    }
  }

  /// A row for each place and date, columns in any order; those of other properties are not used.
  void long_header() {
    const std::vector<TableColumn>& columns = reader_.columns();
    const std::string other_value = is_pressure_ ? "temperature" : "pressure";
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (i == *date_column_ || take_place(i)) continue;
      if (lower_case(columns[i].name) == name_of_value()) {
        value_columns_.push_back(i);
        set_value_unit(i);
      } else if (columns[i].unit && is_length(*columns[i].unit)) {
        reader_.refuse(table_quote(columns[i].text) + " is none of x, y, depth, z, dx, dy and dz",
                       "give it one of these names, or remove it");
      } else if (lower_case(columns[i].name) != other_value) {
        not_used_.push_back(i);
      }
    }
    if (value_columns_.size() != 1) {
      return reader_.refuse(
          concat("has ", value_columns_.size(), " columns of values, named ", name_of_value()),
          header_cure_);
    }
  }

  void note_what_is_not_used() {
    if (not_used_.empty()) return;
    std::ranges::sort(not_used_);
    notes_.push_back("has columns that are not used: " +
                     joined(not_used_, ", ",
                            [&](std::size_t i) { return table_quote(reader_.columns()[i].name); }));
  }

  static bool is_length(const std::string& unit) {
    return contains(std::array{"m", "km", "ft", "cm", "mm"}, unit);
  }

  bool set_value_unit(std::size_t i) {
    return reader_.set_unit(i, is_pressure_ ? Dimension::pressure : Dimension::temperature,
                            is_pressure_ ? kPressureRange : kTemperatureRange, header_cure_);
  }

  void value_headings() {
    if (value_columns_.empty()) return reader_.refuse("has 0 columns of values", header_cure_);
    std::optional<std::string> refused_unit;  // the same in all columns is said once
    for (const std::size_t i : value_columns_) {
      const TableColumn& one = reader_.columns()[i];
      if (!next_date(one.name)) return;
      const std::string unit = one.text.substr(one.name.size());
      if (unit == refused_unit) continue;
      if (!set_value_unit(i)) refused_unit = unit;
    }
  }

  std::optional<double> date_of(std::string_view text) {
    const std::optional<double> date = parse_date(std::string(text));
    if (date) return date;
    reader_.refuse(table_quote(text) + (date_column_ ? " is not a date"
                                                     : " is neither a date nor x, y, depth, z, dx, "
                                                       "dy or dz"),
                   date_column_ ? "write dates as year-month-day, with or without a time of day: "
                                  "1990-01-31 or 1990-01-31 12:00"
                                : "write dates as year-month-day, after the columns of the place: "
                                  "1990-01-31");
    return std::nullopt;
  }

  /// Adds the report of a column, unless its date is none or does not come after the one before.
  bool next_date(const std::string& text) {
    const std::optional<double> date = date_of(text);
    if (!date) return false;
    if (!reports_.empty() && *date <= reports_.back().date) {
      reader_.refuse("the date " + text + " does not come after the one before",
                     "write the reports in order of time, each once");
      return false;
    }
    reports_.push_back({*date, text, {}});
    return true;
  }

  /// The report of a row of the long form, in whatever order they come; none: it has no date.
  std::optional<std::size_t> report_of_row() {
    const std::string_view text = reader_.cell(*date_column_);
    if (!reports_.empty() && reports_[last_report_].name == text) return last_report_;
    const std::optional<double> date = date_of(text);
    if (!date) return std::nullopt;
    const auto [known, is_new] = report_at_.try_emplace(*date, reports_.size());
    if (is_new) reports_.push_back({*date, std::string(text), {}});
    return last_report_ = known->second;
  }

  std::optional<TablePoints::Place> place() {
    TablePoints::Place place{};
    bool is_whole = true;
    for (std::size_t k = 0; k < place.size(); ++k) {
      if (!column_[k]) continue;
      const std::optional<double> value = reader_.value(*column_[k]);
      is_whole = is_whole && value;
      place[k] = value.value_or(0);
    }
    if (!is_whole) return std::nullopt;
    if (is_upwards_) place[kDepthColumn] = -place[kDepthColumn];
    return place;
  }

  void row() {
    std::optional<std::size_t> report;
    if (date_column_ && !(report = report_of_row())) return;
    const std::optional<TablePoints::Place> at = place();
    if (!at) return;
    const auto [known, is_new] = numbers_.try_emplace(*at, points_.places.size());
    if (is_new) {
      points_.places.push_back(*at);
      points_.lines.push_back(reader_.line());
    }
    const std::size_t cell = known->second;
    if (index_column_[0] && !take_index_of(cell, is_new)) return;
    for (std::size_t i = 0; i < value_columns_.size(); ++i) {
      const std::optional<double> value = reader_.value(value_columns_[i]);
      std::vector<double>& values = reports_[report.value_or(i)].values;
      if (values.size() <= cell) values.resize(cell + 1, kNone);
      if (!std::isnan(values[cell]))
        return reader_.refuse("the cell is given twice", "give each cell one value per report");
      values[cell] = value.value_or(kNone);
    }
  }

  /// i, j, k of a row; none after a refusal.
  std::optional<CellIndex> index_of_row() {
    constexpr double kMost = 1e9;
    CellIndex index{};
    bool is_whole = true;
    for (std::size_t k = 0; k < index.size(); ++k) {
      const std::optional<double> value = reader_.number(*index_column_[k]);
      if (value && (*value != std::round(*value) || std::abs(*value) > kMost)) {
        reader_.refuse(concat(kIndexColumns[k], " is ", *value),
                       "write i, j and k as whole numbers, or leave them out");
        is_whole = false;
      }
      is_whole = is_whole && value;
      if (is_whole) index[k] = static_cast<int>(*value);
    }
    if (!is_whole) return std::nullopt;
    return index;
  }

  /// Keeps i, j, k of a row; false after a refusal.
  bool take_index_of(std::size_t cell, bool is_new) {
    const std::optional<CellIndex> index = index_of_row();
    if (is_new) points_.indices.push_back(index.value_or(CellIndex{}));
    if (!index) return false;
    const auto [i, j, k] = *index;
    const std::string text = concat("i = ", i, ", j = ", j, ", k = ", k);
    if (is_new ? indices_.insert(*index).second : points_.indices[cell] == *index) return true;
    if (is_new) {
      reader_.refuse("the cell " + text + " is given at two places", "give each i, j, k one place");
    } else {
      reader_.refuse("the cell has " + text + ", but others in an earlier line",
                     "give a place the same i, j and k at every date");
    }
    return false;
  }

  /// In the long form a cell can be missing at a date.
  void require_every_cell() {
    for (Report& report : reports_) {
      report.values.resize(points_.places.size(), kNone);
      const auto n_missing =
          std::ranges::count_if(report.values, [](double value) { return std::isnan(value); });
      if (n_missing == 0) continue;
      return reader_.refuse_at(
          0,
          concat(n_missing, " of ", points_.places.size(), " cells are missing at ", report.name),
          "write every cell at every date");
    }
  }

  /// z of a file that counts it downwards.
  void require_depths() {
    if (!is_upwards_) return;
    const auto above = std::ranges::find_if(
        points_.places, [](const auto& place) { return place[kDepthColumn] < 0; });
    if (above == points_.places.end()) return;
    reader_.refuse_at(points_.lines[static_cast<std::size_t>(above - points_.places.begin())],
                      "z is above 0: it counts upwards",
                      "name the column depth [m] if it counts downwards");
  }

  FlowField result() {
    for (std::size_t k = 0; k < column_.size(); ++k) points_.has_column[k] = column_[k].has_value();
    PointCells cells = point_cells(points_, reader_);
    FlowField field;
    field.cells = std::move(cells.cells);
    field.notes = std::move(cells.notes);
    field.notes.insert(field.notes.end(), notes_.begin(), notes_.end());
    std::ranges::sort(reports_, {}, &Report::date);
    field.date = mapped(reports_, &Report::date);
    field.value.resize(std::ssize(field.cells), std::ssize(reports_));
    for (std::size_t t = 0; t < reports_.size(); ++t) {
      for (std::size_t c = 0; c < field.cells.size(); ++c)
        field.value(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(t)) =
            reports_[t].values[cells.point[c]];
    }
    return field;
  }

  struct Report {
    double date;
    std::string name;
    std::vector<double> values;  ///< of the points; NaN: missing.
  };

  TableReader reader_;
  bool is_pressure_;
  std::string header_cure_;
  std::optional<std::size_t> date_column_;            ///< of the long form.
  std::array<std::optional<std::size_t>, 6> column_;  ///< of kPlaceColumns.
  bool is_upwards_ = false;                           ///< the column of depth is z.
  std::vector<std::size_t> value_columns_;
  std::array<std::optional<std::size_t>, 3> index_column_;  ///< of kIndexColumns.
  std::vector<std::size_t> not_used_;                       ///< columns.
  std::vector<std::string> notes_;
  std::vector<Report> reports_;
  std::map<double, std::size_t> report_at_;  ///< number of a date's, in the long form.
  std::size_t last_report_ = 0;              ///< of the row before.
  TablePoints points_;
  std::map<TablePoints::Place, std::size_t> numbers_;
  std::set<CellIndex> indices_;
};

}  // namespace

FlowField parse_flow_csv(std::string_view text, const std::string& given, FlowQuantity quantity) {
  return FlowTable(text, given, quantity).read();
}

}  // namespace faultsim
