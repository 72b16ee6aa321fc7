#pragma once

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "campaign/store/records.h"
#include "simulator/common/errors.h"

struct sqlite3;
struct sqlite3_stmt;

/// SQLite as three RAII types. Only campaign/store/*.cc may use them: no SQL anywhere else.
namespace faultsweep {

struct SqliteClose {
  void operator()(sqlite3* handle) const;
  void operator()(sqlite3_stmt* statement) const;
};
using StatementHandle = std::unique_ptr<sqlite3_stmt, SqliteClose>;
class Statement;

/// SQL with every `what` in it replaced.
std::string replaced(std::string sql, std::string_view what, std::string_view with);

/// An open database. Not copyable, not movable: statements point at it.
class Connection {
 public:
  enum class Mode {
    read_only,   ///< mode=ro; immutable where the folder cannot be written (no -shm file possible).
    read_write,  ///< never checkpoints: see `checkpoints`.
    owner,       ///< the manager: the only one that checkpoints (WAL-reset bug of SQLite < 3.51.3);
            ///< without foreign keys, as it writes about cases and names that it just looked up.
  };
  /// Opens (creates, unless read_only) the file. Foreign keys are on but for the owner; a locked
  /// database is waited for 10 s at most. Throws StorageError.
  Connection(const std::filesystem::path& path, Mode mode);
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Runs one or more statements without parameters or results.
  void execute(const std::string& sql);
  /// Runs a statement without results.
  template <typename... Values>
  void run(const std::string& sql, const Values&... values);
  /// The rows of a query: `Row` is what its one column is read as, a tuple of what they are, or a
  /// struct that is made of `Columns...`.
  template <typename Row, typename... Columns, typename... Values>
  std::vector<Row> rows(const std::string& sql, const Values&... values);
  /// The first of them; none = there is none.
  template <typename Row, typename... Columns, typename... Values>
  std::optional<Row> find(const std::string& sql, const Values&... values);
  /// The same of a query that has one whatever is stored.
  template <typename Row, typename... Columns, typename... Values>
  Row row(const std::string& sql, const Values&... values);
  /// Prepared, and kept for the next one who asks for the same text.
  Statement prepared(const std::string& sql);
  std::int64_t last_insert_id() const;
  /// Another number whenever what can be read has changed, by whomever.
  std::int64_t state();
  int changes() const;
  /// How long a locked database is waited for from now on.
  void wait_for_locks(double seconds);
  /// Moves the whole WAL into the database file. No effect under another journal mode.
  void checkpoint();
  /// Copies the database as this connection sees it, also while others write, to a file that it
  /// makes. Throws StorageError, leaving the file to the caller.
  void copy_to(const std::filesystem::path& target);
  const std::filesystem::path& path() const { return path_; }
  /// It takes the file for one that nobody changes: of no use once somebody does.
  bool is_immutable() const { return is_immutable_; }

 private:
  friend class Statement;

  std::unique_ptr<sqlite3, SqliteClose> handle_;
  std::filesystem::path path_;
  bool is_immutable_ = false;
  std::unordered_map<std::string, std::vector<StatementHandle>> idle_;  ///< by their text.
};

/// A prepared statement. bind(...) resets it and binds all parameters in order; step() is true
/// while there is a row; columns are read by position from 0. It holds no lock once it is gone.
class Statement {
 public:
  Statement(Connection& connection, const std::string& sql);
  Statement(Statement&& other) noexcept = default;
  ~Statement();

  /// Text is not copied: it must live until the statement was stepped or bound again.
  template <typename... Values>
  Statement& bind(const Values&... values) {
    reset();
    n_bound_ = 0;
    return append(values...);
  }
  /// Binds the next ones.
  template <typename... Values>
  Statement& append(const Values&... values) {
    (bind_one(values), ...);
    return *this;
  }
  /// The same of a text that does not live as long.
  void append_copy(const std::string& text) { bind_text(text, true); }
  bool step();
  /// Runs to the end; for statements without rows.
  void run();
  void reset();

  /// The row's columns from 0 into these, each by its type: flags and counts, numbers, text,
  /// optional ones.
  template <typename... Values>
  void read(Values&... values) const {
    int column = 0;
    (read_one(column++, values), ...);
  }
  template <typename... Values>
  void read(std::tuple<Values...>& values) const {
    std::apply([this](auto&... each) { read(each...); }, values);
  }
  /// The row as Connection::rows makes it.
  template <typename Row, typename... Columns>
  Row row() const {
    std::conditional_t<sizeof...(Columns) == 0, Row, std::tuple<Columns...>> columns;
    read(columns);
    if constexpr (sizeof...(Columns) == 0) {
      return columns;
    } else {
      return std::apply([](Columns&... each) { return Row{std::move(each)...}; }, columns);
    }
  }
  template <typename Value>
  Value get(int column) const {
    Value value{};
    read_one(column, value);
    return value;
  }
  std::int64_t integer(int column) const;
  double real(int column) const;
  std::string text(int column) const;
  Cell cell(int column) const;  ///< whatever is there.
  int n_columns() const;
  std::string column_name(int column) const;

 private:
  template <std::integral Value>
  void bind_one(Value value) {
    bind_integer(static_cast<std::int64_t>(value));
  }
  void bind_one(double value) { bind_real(value); }
  void bind_one(std::string_view value) { bind_text(value); }
  void bind_one(const std::string& value) { bind_text(value); }
  void bind_one(const char* value) { bind_text(value); }
  void bind_one(std::monostate) { bind_null(); }
  template <typename Value>
  void bind_one(const std::optional<Value>& value) {
    if (value) {
      bind_one(*value);
    } else {
      bind_null();
    }
  }
  /// Those of an SqlFragment.
  void bind_one(const std::vector<faultsweep::Value>& values) {
    for (const auto& value : values) std::visit([this](const auto& one) { bind_one(one); }, value);
  }
  template <std::integral Value>
  void read_one(int column, Value& value) const {
    value = static_cast<Value>(integer(column));
  }
  void read_one(int column, double& value) const { value = real(column); }
  void read_one(int column, std::string& value) const { value = text(column); }
  template <typename Value>
  void read_one(int column, std::optional<Value>& value) const {
    if (is_null(column)) {
      value.reset();
    } else {
      read_one(column, value.emplace());
    }
  }
  bool is_null(int column) const;
  void bind_integer(std::int64_t value);
  void bind_real(double value);  ///< NaN and infinity are refused: InternalError.
  void bind_text(std::string_view value, bool is_copied = false);
  void bind_null();

  Connection& connection_;
  StatementHandle statement_;
  int n_bound_ = 0;                     ///< parameters.
  std::vector<StatementHandle>& home_;  ///< where it goes when it is done with.
};

template <typename... Values>
void Connection::run(const std::string& sql, const Values&... values) {
  prepared(sql).bind(values...).run();
}
template <typename Row, typename... Columns, typename... Values>
std::vector<Row> Connection::rows(const std::string& sql, const Values&... values) {
  std::vector<Row> all;
  Statement query = prepared(sql);
  query.bind(values...);
  while (query.step()) all.push_back(query.row<Row, Columns...>());
  return all;
}
template <typename Row, typename... Columns, typename... Values>
std::optional<Row> Connection::find(const std::string& sql, const Values&... values) {
  Statement query = prepared(sql);
  if (!query.bind(values...).step()) return std::nullopt;
  return query.row<Row, Columns...>();
}
template <typename Row, typename... Columns, typename... Values>
Row Connection::row(const std::string& sql, const Values&... values) {
  std::optional<Row> found = find<Row, Columns...>(sql, values...);
  FAULTSIM_DEMAND(found, sql);
  return std::move(*found);
}

/// Switches a pragma as long as it lives. Within a transaction that of foreign keys has no effect.
class PragmaWhile {
 public:
  PragmaWhile(Connection& connection, const std::string& name, bool on);
  ~PragmaWhile();
  PragmaWhile(const PragmaWhile&) = delete;
  PragmaWhile& operator=(const PragmaWhile&) = delete;

 private:
  Connection& connection_;
  std::string after_;
};

/// For many rows of our own making, whose references were made or read just before and whose words
/// are those of an enumeration: foreign keys take a quarter of the time, and SQLite makes a tree of
/// each `CHECK (… IN …)` for every row, which takes half of it. Column types are still checked.
struct ConstraintsOff {
  explicit ConstraintsOff(Connection& connection)
      : foreign_keys(connection, "foreign_keys", false),
        checks(connection, "ignore_check_constraints", true) {}
  PragmaWhile foreign_keys, checks;
};

/// BEGIN IMMEDIATE ... COMMIT; rolled back unless committed.
class Transaction {
 public:
  /// @param begin  "BEGIN": to read one state of the database for as long as it lives.
  explicit Transaction(Connection& connection, const char* begin = "BEGIN IMMEDIATE");
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Connection& connection_;
  bool open_ = true;
};

}  // namespace faultsweep
