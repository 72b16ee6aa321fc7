#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include "campaign/store/row_digest.h"
#include "campaign/store/sqlite.h"
#include "simulator/result/result_fields.h"

/// Fields of results (simulator/result/result_fields.h) as columns of tables. A field is kept where
/// the table has a column of its key or, of the name of a stage, fault or region, of its key and
/// "_id": what the store keeps of a result is said by its schema alone.
namespace faultsweep {

/// The id of a name in the table `names`, which is added if need be.
using NameIds = std::function<std::int64_t(const std::string&)>;

/// How rows are added to a table.
struct RowInsert {
  /// @param columns  "case_id, step".
  RowInsert(const std::string& table, const std::string& columns);
  /// So many rows at once: of one statement SQLite finds the place once, and the next rows, if they
  /// come in the order of the primary key, just behind.
  static constexpr std::array<std::size_t, 3> kRows = {32, 8, 1};
  std::array<std::string, kRows.size()> sql;  ///< "INSERT INTO t (a, b) VALUES (?, ?), (?, ?)".
  std::vector<std::uint64_t> keys;            ///< of the columns, for checksums.
};

/// Adds rows to a table, and to the checksum of the result they belong to.
class RowWriter {
 public:
  /// @param n_rows  that will be added: no fewer.
  RowWriter(Connection& connection, const RowInsert& insert, RowDigest& digest, std::size_t n_rows)
      : connection_(connection), insert_(insert), digest_(digest), n_left_(n_rows) {}
  /// Begins a row with its first columns. Texts must live as long as the writer.
  template <typename... Values>
  void begin(const Values&... values) {
    if (n_open_ == 0) take_statement();
    column_ = 0;
    (bind(values), ...);
  }
  /// Binds the next column.
  template <typename Value>
  void bind(const Value& value) {
    digest_.add(insert_.keys[column_++], value);
    statement_->append(value);
  }
  /// The same of a text that does not live as long.
  void bind_copy(const std::string& text) {
    digest_.add(insert_.keys[column_++], text);
    statement_->append_copy(text);
  }
  void bind_null() {
    ++column_;
    statement_->append(std::monostate());
  }
  /// Ends a row.
  void end();

 private:
  void take_statement();

  Connection& connection_;
  const RowInsert& insert_;
  RowDigest& digest_;
  std::optional<Statement> statement_;
  std::size_t n_left_;       ///< rows for which no statement was taken.
  std::size_t n_taken_ = 0;  ///< rows of the statement.
  std::size_t n_open_ = 0;   ///< of these, those that have not ended.
  std::size_t column_ = 0;   ///< the next one of the row.
};

/// How a field lies in a row.
struct RowField {
  enum class Kind { absent, plain, name } kind = Kind::absent;
  std::string column;    ///< its name in the table.
  std::string selected;  ///< "$." is the row; "" = it cannot be read back.
  bool may_be_null = true;
};

/// Finds the fields of a table.
class TableColumns {
 public:
  TableColumns(Connection& connection, const std::string& table);
  RowField of(const faultsim::Field& field, bool is_text, const std::string& prefix) const;

 private:
  std::set<std::string> nullable_, needed_;
};

template <typename Member>
struct RowValue : std::bool_constant<std::is_arithmetic_v<Member> || std::is_enum_v<Member> ||
                                     std::is_same_v<Member, std::string>> {};
template <typename Member>
struct RowValue<std::optional<Member>> : std::is_arithmetic<Member> {};
template <typename Member>
struct RowValue<std::vector<Member>>
    : std::bool_constant<std::is_same_v<Member, double> || std::is_same_v<Member, std::string>> {};
/// Structs whose fields lie in the row of what they belong to.
template <typename Member>
constexpr bool kInRow = std::is_same_v<Member, faultsim::SidePressures> ||
                        std::is_same_v<Member, faultsim::SolveCounts>;

/// Visits the fields that may lie in one row; what has tables of its own is left out.
template <typename Struct, typename Visit>
void for_each_row_value(Struct& from, const Visit& visit) {
  faultsim::for_each_field(from, [&visit](const faultsim::Field& field, auto& value) {
    using Member = std::remove_cvref_t<decltype(value)>;
    if constexpr (kInRow<Member>) {
      for_each_row_value(value, visit);
    } else if constexpr (RowValue<Member>::value) {
      visit(field, value);
    }
  });
}

std::string json_array(const std::vector<double>& values);
std::vector<double> numbers_of(const std::string& json_array);
std::string join_lines(const std::vector<std::string>& lines);
std::vector<std::string> split_lines(const std::string& text);

/// The fields of a struct in a table.
template <typename Struct>
class RowFields {
 public:
  /// @param prefix  of the columns, before the key.
  RowFields(Connection& connection, const std::string& table, const std::string& prefix = "") {
    const TableColumns columns(connection, table);
    const Struct empty;
    for_each_row_value(empty, [&](const faultsim::Field& field, const auto& value) {
      constexpr bool is_text = std::is_same_v<std::remove_cvref_t<decltype(value)>, std::string>;
      fields_.push_back(columns.of(field, is_text, prefix));
    });
  }
  /// ", chi_bar, chi_max": of those that the table keeps.
  std::string columns() const {
    std::string list;
    for (const RowField& field : fields_) {
      if (field.kind != RowField::Kind::absent) list += ", " + field.column;
    }
    return list;
  }
  /// The same to be read back from `row`: ", q.chi_bar, (q.max_slip_m > 0)".
  std::string selected(const std::string& row) const {
    std::string list;
    for (const RowField& field : fields_) {
      if (!field.selected.empty()) list += ", " + replaced(field.selected, "$", row);
    }
    return list;
  }
  /// Binds the columns(); NULL for all of no struct.
  void bind(RowWriter& row, const Struct* from, const NameIds& ids) const {
    if (from == nullptr) {
      for (const RowField& field : fields_) {
        if (field.kind != RowField::Kind::absent) row.bind_null();
      }
      return;
    }
    std::size_t k = 0;
    for_each_row_value(*from, [&](const auto&, const auto& value) {
      const RowField& field = fields_[k++];
      if (field.kind != RowField::Kind::absent) bind_value(row, field, value, ids);
    });
  }
  /// Reads what selected() selects from `column` on, which it moves on. NULL is NaN, none, false, 0
  /// or "".
  void read(const Statement& row, int& column, Struct& to) const {
    std::size_t k = 0;
    for_each_row_value(to, [&](const auto&, auto& value) {
      if (!fields_[k++].selected.empty()) read_value(row, column++, value);
    });
  }

 private:
  template <typename Member>
  static void bind_value(RowWriter& row, const RowField& field, const Member& value,
                         const NameIds& ids) {
    if constexpr (std::is_same_v<Member, double>) {
      const bool none = field.may_be_null && !std::isfinite(value);
      row.bind(none ? std::nullopt : std::optional(value));
    } else if constexpr (std::is_same_v<Member, std::string>) {
      if (field.kind == RowField::Kind::plain) return row.bind(value);
      const bool none = value.empty() && field.may_be_null;
      row.bind(none ? std::nullopt : std::optional(ids(value)));
    } else if constexpr (std::is_enum_v<Member>) {
      row.bind(faultsim::to_string(value));
    } else if constexpr (std::is_same_v<Member, std::vector<double>>) {
      if (field.may_be_null && value.empty()) return row.bind_null();
      row.bind_copy(json_array(value));
    } else if constexpr (std::is_same_v<Member, std::vector<std::string>>) {
      row.bind_copy(join_lines(value));
    } else {
      row.bind(value);
    }
  }
  template <typename Member>
  static void read_value(const Statement& row, int column, Member& value) {
    if constexpr (std::is_same_v<Member, double>) {
      value =
          row.get<std::optional<double>>(column).value_or(std::numeric_limits<double>::quiet_NaN());
    } else if constexpr (std::is_enum_v<Member>) {
      value = faultsim::stored_word<faultsim::Outcome>(row.text(column), "outcome");
    } else if constexpr (std::is_same_v<Member, std::vector<double>>) {
      value = numbers_of(row.text(column));
    } else if constexpr (std::is_same_v<Member, std::vector<std::string>>) {
      value = split_lines(row.text(column));
    } else {
      value = row.get<Member>(column);
    }
  }

  std::vector<RowField> fields_;  ///< in the order of for_each_row_value.
};

/// All tables that hold fields of results, with the statements that add rows: first the key columns
/// as named in result_rows.cc, then the fields.
struct ResultTables {
  explicit ResultTables(Connection& db);

  RowFields<faultsim::CaseResult> whole;
  RowFields<faultsim::CaseSurface> surface;
  RowFields<faultsim::StageMetrics> stage;
  RowFields<faultsim::FaultStageMetrics> fault;
  RowFields<faultsim::FaultOnset> onset;
  RowFields<faultsim::StepResult> step;
  RowFields<faultsim::StepCreep> step_creep;
  RowFields<faultsim::FaultMetrics> history;
  RowFields<faultsim::FaultCreep> history_creep;
  RowFields<faultsim::SlipEvent> event;
  RowFields<faultsim::Episode> episode;
  RowInsert add_whole, add_surface, add_stage, add_fault, add_onset, add_step, add_history,
      add_event, add_episode;
  std::string read_fault, read_onsets;  ///< by stage_id, fault_id, case_id, as q and o.
};

}  // namespace faultsweep
