#include "campaign/store/migrations.h"

#include <ctime>
#include <deque>
#include <type_traits>

#include "campaign/common/names.h"
#include "campaign/store/sqlite.h"
#include "simulator/result/measures.h"
#include "store_10_sql.h"
#include "store_11_sql.h"
#include "store_13_sql.h"
#include "store_14_sql.h"
#include "store_15_sql.h"
#include "store_16_sql.h"
#include "store_17_sql.h"
#include "store_18_sql.h"
#include "store_19_sql.h"
#include "store_20_sql.h"
#include "store_21_sql.h"
#include "store_2_sql.h"
#include "store_3_sql.h"
#include "store_4_sql.h"
#include "store_5_sql.h"
#include "store_6_sql.h"
#include "store_7_sql.h"
#include "store_8_sql.h"
#include "store_9_sql.h"
#include "store_sql.h"
#include "views_sql.h"

namespace faultsweep {
namespace {

/// Reads version and application; throws when the file is not ours to touch.
int usable_version(Connection& connection, int newest) {
  const std::string file = connection.path().string();
  const auto id = connection.row<std::int64_t>("PRAGMA application_id");
  const auto version = connection.row<std::int64_t>("PRAGMA user_version");
  const auto n_tables = connection.row<std::int64_t>("SELECT count(*) FROM sqlite_schema");
  const bool is_fresh = id == 0 && version == 0 && n_tables == 0;
  if (id != kStoreApplicationId && !is_fresh) {
    throw StorageError(concat(file, " is another program's database, not a faultsweep store",
                              " (application id ", id, ", ", n_tables,
                              " tables and indices); choose another --store, nothing was changed"));
  }
  if (version > newest) {
    throw StorageError(concat("the store ", file, " has schema version ", version,
                              ", this faultsweep knows up to ", newest,
                              "; use a newer faultsweep, nothing was changed"));
  }
  if (!is_fresh && connection.row<std::int64_t>("SELECT max(version) FROM migrations") != version) {
    throw StorageError(concat("the store ", file, " is damaged: its header and its table of ",
                              "migrations name different schema versions; ", kDamageCure));
  }
  return static_cast<int>(version);
}

void require_sound_references(Connection& connection, const Migration& migration) {
  Statement broken(connection, "PRAGMA foreign_key_check");
  if (!broken.step()) return;
  throw StorageError(concat("migration ", migration.version, " (", migration.name,
                            ") found rows of ", broken.text(0), " that refer to missing rows of ",
                            broken.text(2), "; nothing was changed"));
}

/// The measures as columns of a view on the row.
std::string measure_columns(const std::string& row) {
  std::string columns;
  const faultsim::Measures measures;
  faultsim::for_each_measure(measures, [&](const faultsim::Field& field, const auto&) {
    const std::string value =
        replaced(field.sql.empty() ? concat("$.", field.key) : std::string(field.sql), "$", row);
    if (!columns.empty()) columns += ", ";
    if (faultsim::is_extensive(field.key)) {
      columns += concat("iif(m.plane_strain, NULL, ", value, ") AS ", field.key,
                        ", iif(m.plane_strain, ", value, ", NULL) AS ", field.key, "_per_m");
    } else {
      columns += concat(value, " AS ", field.key);
    }
  });
  return columns;
}

/// schemas/views.sql with the measures in their places.
std::string views() {
  std::string sql(faultsim::embedded::views_sql);
  constexpr std::string_view kPlace = "MEASURES(";
  // Not in the comment that explains it, which is a line.
  for (std::size_t at = sql.find(kPlace); at != std::string::npos; at = sql.find(kPlace, at + 1)) {
    const std::size_t line = sql.rfind('\n', at) + 1, end = sql.find(')', at);
    if (sql.compare(line, 2, "--") == 0) continue;
    const std::size_t row = at + kPlace.size();
    sql.replace(at, end + 1 - at, measure_columns(sql.substr(row, end - row)));
  }
  return sql;
}

/// The migration that adds the columns of the measures that came with the version; "" = none did.
std::string new_measures(int version) {
  std::string sql;
  const faultsim::Measures measures;
  faultsim::for_each_measure(measures, [&](const faultsim::Field& field, const auto& value) {
    if (field.since != version) return;
    // Results from before have none, so that it can be no plain number.
    constexpr bool may_be_missing =
        std::is_same_v<std::remove_cvref_t<decltype(value)>, std::optional<double>>;
    FAULTSIM_DEMAND(may_be_missing, field.key);
    for (const char* table : {"stage_metrics", "fault_metrics"}) {
      sql += concat("ALTER TABLE ", table, " ADD COLUMN ", field.key, " REAL;\n");
    }
  });
  return sql;
}

}  // namespace

const std::vector<Migration>& store_migrations() {
  static std::deque<std::string> texts;  // of migrations that are written here
  static const std::vector<Migration> migrations = [] {
    std::vector<Migration> all = {
        {1, "created", faultsim::embedded::store_sql},
        {2, "2026-11-21 fields of cases", faultsim::embedded::store_2_sql},
        {3, "2026-11-21 slip events and episodes", faultsim::embedded::store_3_sql},
        {4, "2026-11-21 creep of salt", faultsim::embedded::store_4_sql},
        {5, "2026-11-21 rows of designs", faultsim::embedded::store_5_sql},
        {6, "2026-11-21 nights", faultsim::embedded::store_6_sql},
        {7, "2026-11-22 trades of accuracy for speed", faultsim::embedded::store_7_sql},
        {8, "2026-11-22 checksums and operator time limits", faultsim::embedded::store_8_sql},
        {9, "2026-11-22 metrics and pressures per fault", faultsim::embedded::store_9_sql},
        {10, "2026-11-22 flags that hang on the mesh", faultsim::embedded::store_10_sql},
        {11, "2026-11-22 views of the list of measures", faultsim::embedded::store_11_sql},
        {13, "2026-11-23 parameters of cases, rounds", faultsim::embedded::store_13_sql},
        {14, "2026-11-23 checksums as sums over rows", faultsim::embedded::store_14_sql},
        {15, "2026-11-24 failures of last attempts", faultsim::embedded::store_15_sql},
        {16, "2026-11-25 how exact results are", faultsim::embedded::store_16_sql},
        {17, "2026-11-25 errors of stability limits", faultsim::embedded::store_17_sql},
        {18, "2026-11-26 cases on surfaces", faultsim::embedded::store_18_sql},
        {19, "2026-11-27 fields of the cases shown first", faultsim::embedded::store_19_sql},
        {20, "2026-11-28 what is assumed of flow results, temperatures",
         faultsim::embedded::store_20_sql},
        {21, "2026-11-28 onsets within load steps", faultsim::embedded::store_21_sql},
    };
    for (std::size_t k = 0;; ++k) {  // versions are without gaps from 1
      const int version = static_cast<int>(k) + 1;
      const std::string measures = new_measures(version);
      if (!measures.empty()) {
        all.insert(all.begin() + static_cast<std::ptrdiff_t>(k),
                   {version, "measures added", texts.emplace_back(measures)});
      }
      if (k == all.size()) break;
      FAULTSIM_DEMAND(all[k].version == version, version);
    }
    // By the last one alone: they name its tables, and SQLite changes no column while a view names
    // a table that is not there.
    all.back().sql = texts.emplace_back(std::string(all.back().sql) + views());
    return all;
  }();
  return migrations;
}

int stored_version(Connection& connection, const std::vector<Migration>& migrations) {
  return usable_version(connection, migrations.back().version);
}

void migrate(Connection& connection, const std::vector<Migration>& migrations) {
  const int newest = migrations.back().version;
  if (usable_version(connection, newest) == newest) return;
  const PragmaWhile foreign_keys(connection, "foreign_keys", false);
  for (const Migration& migration : migrations) {
    Transaction transaction(connection);
    // Read again: another process may have migrated while we waited for the lock.
    const int version = usable_version(connection, newest);
    if (migration.version <= version) continue;
    FAULTSIM_DEMAND(migration.version == version + 1, migration.version, " after ", version);
    if (version == 0) connection.execute(concat("PRAGMA application_id = ", kStoreApplicationId));
    connection.execute(std::string(migration.sql));
    require_sound_references(connection, migration);
    connection.execute(concat("PRAGMA user_version = ", migration.version));
    connection.run("INSERT INTO migrations (version, name, applied_at) VALUES (?, ?, ?)",
                   migration.version, migration.name, static_cast<double>(std::time(nullptr)));
    transaction.commit();
  }
}

void check_version(Connection& connection, const std::vector<Migration>& migrations) {
  const int newest = migrations.back().version;
  const int version = usable_version(connection, newest);
  if (version == 0) {
    throw StorageError(concat("the store ", connection.path().string(),
                              " is empty: a submit was interrupted, or the file is damaged; submit "
                              "again, or restore a backup (faultsweep backup)"));
  }
  if (version < newest) {
    throw StorageError(concat("the store has schema version ", version, ", this faultsweep reads ",
                              newest,
                              "; migrate it by any writing command (faultsweep run, submit)"));
  }
}

}  // namespace faultsweep
