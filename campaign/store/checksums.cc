#include "campaign/store/checksums.h"

#include "campaign/common/names.h"
#include "campaign/store/row_digest.h"
#include "campaign/store/sqlite.h"
#include "simulator/common/fingerprint.h"

namespace faultsweep {

/// A query for the rows of one case or campaign that count.
struct Checksums::Rows {
  Rows(Connection& connection, const std::string& table, const std::string& sql)
      : query(connection, sql) {
    for (int column = 0; column < query.n_columns(); ++column) {
      keys.push_back(RowDigest::column_key(table, query.column_name(column)));
    }
  }
  void add_to(RowDigest& digest, std::int64_t id) const {
    query.bind(id);
    while (query.step()) {
      for (std::size_t k = 0; k < keys.size(); ++k) {
        digest.add(keys[k], query.cell(static_cast<int>(k)));
      }
      digest.end_row();
    }
    query.reset();
  }
  mutable Statement query;
  std::vector<std::uint64_t> keys;
};

namespace {

/// Selects the rows of one case. Where the key does not begin with case_id, what stands before it
/// are ids of names, which are few.
std::string select_rows(Connection& connection, const std::string& table) {
  Statement key(connection, "SELECT name FROM pragma_table_info(?) WHERE pk > 0 ORDER BY pk");
  key.bind(table);
  std::string where;
  while (key.step() && key.text(0) != "case_id") {
    where += concat(key.text(0), " IN (SELECT id FROM names) AND ");
  }
  return concat("SELECT * FROM ", table, " WHERE ", where, "case_id = ?");
}

}  // namespace

Checksums::Checksums(Connection& connection) : connection_(connection) {
  if (!exist(connection)) return;
  for (const std::string& name : connection.rows<std::string>(
           "SELECT m.name FROM sqlite_schema m JOIN pragma_table_info(m.name) c"
           " WHERE m.type = 'table' AND c.name = 'case_id' AND m.name NOT IN"
           " ('campaign_cases', 'runs', 'result_checksums') ORDER BY m.name")) {
    tables_.emplace_back(connection, name, select_rows(connection, name));
  }
  decided_.emplace_back(connection, "cases", "SELECT identity, changes FROM cases WHERE id = ?");
  decided_.emplace_back(connection, "runs",
                        "SELECT id, case_id, attempt, status, outcome, reason, operator,"
                        " numerics_version FROM runs"
                        " WHERE id = (SELECT run_id FROM case_metrics WHERE case_id = ?)");
  campaign_.emplace_back(connection, "campaign_cases",
                         "SELECT cc.position, cc.case_id, c.identity, c.scene_id, c.changes"
                         " FROM campaign_cases cc JOIN cases c ON c.id = cc.case_id"
                         " WHERE cc.campaign_id = ?");
  campaign_.emplace_back(connection, "case_parameters",
                         "SELECT position, parameter, si, text FROM case_parameters"
                         " WHERE campaign_id = ?");
}

Checksums::~Checksums() = default;

bool Checksums::exist(Connection& connection) {
  constexpr int kFirst = 14;  // older stores have others
  return connection.row<int>("PRAGMA user_version") >= kFirst;
}

std::string Checksums::of_result(std::int64_t case_id, RowDigest rows) const {
  for (const Rows& decided : decided_) decided.add_to(rows, case_id);
  return rows.text();
}

RowDigest Checksums::stored_rows(std::int64_t case_id) const {
  RowDigest rows;
  for (const Rows& table : tables_) table.add_to(rows, case_id);
  return rows;
}

std::string Checksums::of_campaign(std::int64_t campaign) const {
  RowDigest rows;
  for (const Rows& part : campaign_) part.add_to(rows, campaign);
  return rows.text();
}

void Checksums::seal_result(std::int64_t case_id, RowDigest rows) {
  connection_.run("INSERT OR REPLACE INTO result_checksums (case_id, checksum) VALUES (?, ?)",
                  case_id, of_result(case_id, rows));
}

void Checksums::seal_campaign(std::int64_t campaign) {
  connection_.run("INSERT OR REPLACE INTO campaign_checksums (campaign_id, checksum) VALUES (?, ?)",
                  campaign, of_campaign(campaign));
}

void Checksums::seal_all() {
  using Id = std::int64_t;
  for (const Id id : connection_.rows<Id>("SELECT case_id FROM case_metrics")) {
    seal_result(id, stored_rows(id));
  }
  for (const Id id : connection_.rows<Id>("SELECT id FROM campaigns")) seal_campaign(id);
  connection_.execute(
      "UPDATE checksum_schema SET version = (SELECT user_version FROM pragma_user_version)");
}

bool Checksums::are_current() const {
  return connection_
      .find<bool>(
          "SELECT version = (SELECT user_version FROM pragma_user_version)"
          " FROM checksum_schema")
      .value_or(false);
}

std::vector<std::string> Checksums::problems() const {
  std::vector<std::string> found;
  if (!exist(connection_) || !are_current()) return found;
  Statement scenes(connection_, "SELECT id, hash, source, document FROM scenes");
  while (scenes.step()) {
    if (faultsim::fingerprint(scenes.text(2) + '\n' + scenes.text(3)) != scenes.text(1))
      found.push_back(concat("base scene ", scenes.integer(0), " differs from its checksum"));
  }
  Statement campaigns(connection_,
                      "SELECT k.name, k.id, c.checksum, k.spec_given, k.spec_given_hash,"
                      " k.spec_resolved, k.spec_resolved_hash FROM campaigns k"
                      " LEFT JOIN campaign_checksums c ON c.campaign_id = k.id");
  while (campaigns.step()) {
    const std::string name = campaigns.text(0);
    if (faultsim::fingerprint(campaigns.text(3)) != campaigns.text(4) ||
        faultsim::fingerprint(campaigns.text(5)) != campaigns.text(6))
      found.push_back(concat("the spec of campaign ", name, " differs from its checksum"));
    if (of_campaign(campaigns.integer(1)) != campaigns.text(2))
      found.push_back(concat("the cases of campaign ", name, " differ from their checksum"));
  }
  Statement results(connection_,
                    "SELECT c.id, c.identity, s.checksum FROM cases c"
                    " LEFT JOIN result_checksums s ON s.case_id = c.id WHERE c.state = 'done'"
                    " OR s.case_id IS NOT NULL");
  while (results.step()) {
    const std::int64_t id = results.integer(0);
    if (of_result(id, stored_rows(id)) != results.text(2))
      found.push_back(concat("the result of case ", results.text(1), " differs from its checksum"));
  }
  return found;
}

}  // namespace faultsweep
