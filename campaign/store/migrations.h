#pragma once

#include <string_view>
#include <vector>

namespace faultsweep {

class Connection;

/// A step from schema version `version - 1` to `version`.
struct Migration {
  int version;
  const char* name;
  std::string_view sql;
};

/// The schema as created (schemas/store.sql) and its changes since.
const std::vector<Migration>& store_migrations();

inline constexpr int kStoreApplicationId = 0x46535750;  // "FSWP"

/// The file's schema version, 0 = nothing is in it yet. Throws StorageError as migrate().
int stored_version(Connection& connection, const std::vector<Migration>& migrations);
/// Brings the file to the last version, each step in a transaction of its own with its row in
/// `migrations`; foreign keys are off meanwhile and checked before each step is committed. An empty
/// file is created. Throws StorageError on a file of another application or of a newer version;
/// such a file is left alone.
void migrate(Connection& connection, const std::vector<Migration>& migrations);
/// The same check without changing anything, for readers: the version must be the last one.
void check_version(Connection& connection, const std::vector<Migration>& migrations);

}  // namespace faultsweep
