#include <unistd.h>

#include <map>
#include <system_error>

#include "campaign/common/names.h"
#include "campaign/store/checksums.h"
#include "campaign/store/sqlite.h"
#include "campaign/store/store.h"

/// Copies of the store, and whether it is sound.
namespace faultsweep {

namespace {

std::map<std::string, std::int64_t> rows_of_tables(Connection& connection) {
  std::map<std::string, std::int64_t> counts;
  for (const auto& name :
       connection.rows<std::string>("SELECT name FROM sqlite_schema WHERE type = 'table'")) {
    counts[name] = connection.row<std::int64_t>(concat("SELECT count(*) FROM \"", name, '"'));
  }
  return counts;
}

std::string first_of(const std::vector<std::string>& problems) {
  return problems.size() == 1 ? problems.front()
                              : concat(problems.front(), " (and ", problems.size() - 1, " more)");
}

/// A file that is removed unless it was released.
class Temporary {
 public:
  explicit Temporary(std::filesystem::path path) : path_(std::move(path)) { remove(); }
  ~Temporary() { remove(); }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  void remove() const {
    for (const char* ending : {"", "-wal", "-shm", "-journal"}) {
      std::error_code ignored;
      std::filesystem::remove(path_.string() + ending, ignored);
    }
  }
  std::filesystem::path path_;
};

}  // namespace

void Store::backup_to(const std::filesystem::path& target) const {
  if (std::filesystem::exists(target)) {
    throw StorageError(
        concat("the backup ", target.string(), " exists already; choose another name"));
  }
  const Temporary temporary(concat(target.string(), '.', getpid(), ".tmp"));
  std::map<std::string, std::int64_t> rows;
  {
    const Transaction one_state(*connection_, "BEGIN");
    rows = rows_of_tables(*connection_);
    connection_->copy_to(temporary.path());
  }
  {
    Store copy(temporary.path().parent_path(),
               std::make_unique<Connection>(temporary.path(), Connection::Mode::read_only), "");
    const std::vector<std::string> problems = copy.integrity_problems();
    if (!problems.empty()) {
      throw StorageError(concat("no backup was made, as the store is damaged: ", first_of(problems),
                                "; ", kDamageCure));
    }
    if (rows_of_tables(*copy.connection_) != rows) {
      throw StorageError(concat("the backup ", target.string(),
                                " differed from the store and was removed; make it again"));
    }
  }
  std::error_code error;
  std::filesystem::rename(temporary.path(), target, error);
  if (error) {
    throw StorageError(concat("cannot write the backup ", target.string(), ": ", error.message()));
  }
}

std::vector<std::string> Store::integrity_problems() const {
  std::vector<std::string> problems;
  try {
    Statement integrity(*connection_, "PRAGMA integrity_check");
    while (integrity.step()) {
      if (integrity.text(0) != "ok") problems.push_back(integrity.text(0));
    }
    using Row = std::tuple<std::string, std::int64_t, std::string>;
    for (const auto& [table, row, missing] : connection_->rows<Row>("PRAGMA foreign_key_check")) {
      problems.push_back(
          concat("row ", row, " of ", table, " refers to a missing row of ", missing));
    }
    for (std::string& text : Checksums(*connection_).problems())
      problems.push_back(std::move(text));
  } catch (const StorageError& error) {  // so damaged that it cannot be read through
    problems.emplace_back(error.what());
  }
  return problems;
}

std::optional<std::string> Store::damage_of(const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder / "campaign.sqlite")) return std::nullopt;
  try {
    const std::vector<std::string> problems = open_reader(folder).integrity_problems();
    if (problems.empty()) return std::nullopt;
    return concat("the store ", folder.string(), " is damaged: ", first_of(problems), "; ",
                  kDamageCure);
  } catch (const StorageError& error) {
    return error.what();
  }
}

}  // namespace faultsweep
