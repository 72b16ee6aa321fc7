#include "campaign/store/sqlite.h"
#include "campaign/common/names.h"

#include <sqlite3.h>
#include <unistd.h>

#include <charconv>
#include <cmath>
#include <cstring>
#include <utility>

namespace faultsweep {
namespace {

constexpr int kBusyTimeoutMs = 10000;  // a commit takes milliseconds; 10 s means somebody hangs

[[noreturn]] void fail(sqlite3* handle, const std::filesystem::path& path, const char* doing) {
  const int code = handle != nullptr ? sqlite3_extended_errcode(handle) : SQLITE_NOMEM;
  const std::string text = concat("the store ", path.string(), " failed while ", doing, ": ",
                                  handle != nullptr ? sqlite3_errmsg(handle) : "out of memory",
                                  " (SQLite code ", code, ")");
  switch (code & 0xff) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      throw StoreBusy(
          concat(text, "; another process has been writing for ", kBusyTimeoutMs / 1000, " s"));
    case SQLITE_FULL:
      throw StorageError(concat(text, "; free some space and run again: what is stored is intact"));
    case SQLITE_READONLY:
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
      throw StorageError(
          concat(text, "; check the folder's permissions or choose another --store"));
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      throw StorageError(concat(text, "; the file is damaged: ", kDamageCure));
    case SQLITE_IOERR:
      throw StorageError(concat(text, ": ", std::strerror(sqlite3_system_errno(handle)),
                                "; free space, or check the disk, and run again: what is stored "
                                "is intact"));
    default:
      throw StorageError(concat(text, "; check the file with `faultsweep status --verify`"));
  }
}

std::string uri_path(const std::filesystem::path& path) {
  std::string text;
  for (const char c : std::filesystem::absolute(path).string()) {
    if (c == '?' || c == '#' || c == '%') {
      text += formatted("%%%02X", static_cast<unsigned char>(c));
    } else {
      text += c;
    }
  }
  return "file:" + text;
}

/// exact_real(JSON): the double that the text of a number names, to the last bit, as SQLite's own
/// reading of numbers is not; NULL of anything else.
void exact_real(sqlite3_context* context, int, sqlite3_value** arguments) {
  const auto* text = reinterpret_cast<const char*>(sqlite3_value_text(arguments[0]));
  double number = 0;
  if (text == nullptr) return;
  const char* end = text + std::strlen(text);
  const auto [stop, error] = std::from_chars(text, end, number);
  if (error == std::errc() && stop == end) sqlite3_result_double(context, number);
}

}  // namespace

std::string replaced(std::string sql, std::string_view what, std::string_view with) {
  for (std::size_t at = sql.find(what); at != std::string::npos;
       at = sql.find(what, at + with.size()))
    sql.replace(at, what.size(), with);
  return sql;
}

void SqliteClose::operator()(sqlite3* handle) const { sqlite3_close_v2(handle); }
void SqliteClose::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

Connection::Connection(const std::filesystem::path& path, Mode mode) : path_(path) {
  std::string uri = uri_path(path);
  if (mode == Mode::read_only) {
    uri += "?mode=ro";
    // A reader of a WAL database needs to write the -shm file beside it.
    if (access(path.parent_path().c_str(), W_OK) != 0 &&
        !std::filesystem::exists(path.string() + "-wal")) {
      uri += "&immutable=1";
      is_immutable_ = true;
    }
  }
  const int flags =
      SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX |
      (mode == Mode::read_only ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  sqlite3* opened = nullptr;
  const int code = sqlite3_open_v2(uri.c_str(), &opened, flags, nullptr);
  handle_.reset(opened);
  if (code != SQLITE_OK) fail(opened, path_, "opening");
  sqlite3_busy_timeout(handle_.get(), kBusyTimeoutMs);
  execute(
      "PRAGMA foreign_keys = ON; PRAGMA trusted_schema = OFF; PRAGMA cache_size = -65536;"
      "PRAGMA mmap_size = 268435456; PRAGMA temp_store = MEMORY");
  sqlite3_create_function(handle_.get(), "exact_real", 1, SQLITE_UTF8 | SQLITE_DETERMINISTIC,
                          nullptr, exact_real, nullptr, nullptr);
  if (mode == Mode::owner) {
    // Pages that change in every batch are written once per 32 MB; and see ConstraintsOff: to
    // switch for each batch would prepare all statements again.
    execute("PRAGMA wal_autocheckpoint = 8000; PRAGMA foreign_keys = OFF");
  }
  if (mode == Mode::read_write) {
    execute("PRAGMA wal_autocheckpoint = 0");
    sqlite3_db_config(handle_.get(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
  }
}

void Connection::execute(const std::string& sql) {
  if (sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) {
    fail(handle_.get(), path_, sql.c_str());
  }
}

Statement Connection::prepared(const std::string& sql) { return {*this, sql}; }

std::int64_t Connection::last_insert_id() const { return sqlite3_last_insert_rowid(handle_.get()); }
std::int64_t Connection::state() {
  constexpr int kBitsOfOwn = 32;
  const auto version = row<std::int64_t>("PRAGMA data_version");  // of others' changes
  return (version << kBitsOfOwn) + sqlite3_total_changes(handle_.get());
}
void Connection::wait_for_locks(double seconds) {
  sqlite3_busy_timeout(handle_.get(), static_cast<int>(std::lround(seconds * 1000)));
}
int Connection::changes() const { return sqlite3_changes(handle_.get()); }

void Connection::checkpoint() {
  // Busy readers only make it incomplete, which is not a failure.
  sqlite3_wal_checkpoint_v2(handle_.get(), nullptr, SQLITE_CHECKPOINT_TRUNCATE, nullptr, nullptr);
}

void Connection::copy_to(const std::filesystem::path& target) {
  sqlite3* copy = nullptr;
  const int opened = sqlite3_open(target.c_str(), &copy);
  const std::unique_ptr<sqlite3, SqliteClose> closes(copy);
  if (opened != SQLITE_OK) throw StorageError(concat("cannot write ", target.string()));
  sqlite3_backup* backup = sqlite3_backup_init(copy, "main", handle_.get(), "main");
  int code = SQLITE_ERROR;
  if (backup != nullptr) {
    code = sqlite3_backup_step(backup, -1);
    sqlite3_backup_finish(backup);
  }
  const int system_error = sqlite3_system_errno(copy);
  if (code != SQLITE_DONE) {
    throw StorageError(
        concat("cannot copy the store ", path_.string(), " to ", target.string(), ": ",
               sqlite3_errstr(code),
               system_error != 0 ? concat(" (", std::strerror(system_error), ")") : std::string()));
  }
}

Statement::Statement(Connection& connection, const std::string& sql)
    : connection_(connection), home_(connection.idle_[sql]) {
  if (!home_.empty()) {
    statement_ = std::move(home_.back());
    home_.pop_back();
    return;
  }
  sqlite3* handle = connection.handle_.get();
  sqlite3_stmt* made = nullptr;
  const int code =
      sqlite3_prepare_v3(handle, sql.c_str(), -1, SQLITE_PREPARE_PERSISTENT, &made, nullptr);
  if (code != SQLITE_OK) fail(handle, connection.path_, sql.c_str());
  statement_.reset(made);
}

Statement::~Statement() {
  if (!statement_) return;
  reset();
  home_.push_back(std::move(statement_));
}

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  try {
    fail(connection_.handle_.get(), connection_.path_, sqlite3_sql(statement_.get()));
  } catch (...) {
    sqlite3_reset(statement_.get());
    throw;
  }
}

void Statement::run() {
  while (step()) {
  }
  reset();
}

void Statement::reset() { sqlite3_reset(statement_.get()); }

void Statement::bind_integer(std::int64_t value) {
  FAULTSIM_DEMAND(sqlite3_bind_int64(statement_.get(), ++n_bound_, value) == SQLITE_OK, n_bound_);
}
void Statement::bind_real(double value) {
  // SQLite would store NaN as NULL without a word.
  FAULTSIM_DEMAND(std::isfinite(value), sqlite3_sql(statement_.get()), " parameter ", n_bound_ + 1,
                  " = ", value);
  FAULTSIM_DEMAND(sqlite3_bind_double(statement_.get(), ++n_bound_, value) == SQLITE_OK, n_bound_);
}
void Statement::bind_text(std::string_view value, bool is_copied) {
  const char* data = value.data() != nullptr ? value.data() : "";
  FAULTSIM_DEMAND(
      sqlite3_bind_text64(statement_.get(), ++n_bound_, data, value.size(),
                          is_copied ? SQLITE_TRANSIENT : SQLITE_STATIC, SQLITE_UTF8) == SQLITE_OK,
      n_bound_);
}
void Statement::bind_null() {
  FAULTSIM_DEMAND(sqlite3_bind_null(statement_.get(), ++n_bound_) == SQLITE_OK, n_bound_);
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}
double Statement::real(int column) const { return sqlite3_column_double(statement_.get(), column); }

std::string Statement::text(int column) const {
  const auto* data = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  return data == nullptr
             ? std::string()
             : std::string(
                   data, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column)));
}

bool Statement::is_null(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}

int Statement::n_columns() const { return sqlite3_column_count(statement_.get()); }

std::string Statement::column_name(int column) const {
  return sqlite3_column_name(statement_.get(), column);
}

Cell Statement::cell(int column) const {
  switch (sqlite3_column_type(statement_.get(), column)) {
    case SQLITE_NULL:
      return {};
    case SQLITE_INTEGER:
      return integer(column);
    case SQLITE_FLOAT:
      return real(column);
    default:
      return text(column);
  }
}

PragmaWhile::PragmaWhile(Connection& connection, const std::string& name, bool on)
    : connection_(connection) {
  Statement before(connection, "PRAGMA " + name);
  const bool was_on = before.step() && before.integer(0) != 0;
  if (was_on == on) return;  // prepared statements stay valid
  after_ = concat("PRAGMA ", name, " = ", was_on ? "ON" : "OFF");
  connection_.execute(concat("PRAGMA ", name, " = ", on ? "ON" : "OFF"));
}
PragmaWhile::~PragmaWhile() {
  if (after_.empty()) return;
  try {
    connection_.execute(after_);
  } catch (const StorageError&) {  // the connection is of no use any more, and its owner is told
  }
}

Transaction::Transaction(Connection& connection, const char* begin) : connection_(connection) {
  connection_.execute(begin);
}

Transaction::~Transaction() {
  if (!open_) return;
  try {
    connection_.execute("ROLLBACK");
  } catch (...) {  // SQLite has rolled back by itself (disk full): nothing left to do
  }
}

void Transaction::commit() {
  connection_.execute("COMMIT");
  open_ = false;
}

}  // namespace faultsweep
