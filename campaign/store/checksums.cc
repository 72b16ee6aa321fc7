#include "campaign/store/checksums.h"

#include <bit>
#include <charconv>

#include "campaign/store/sqlite.h"
#include "simulator/common/fingerprint.h"

namespace faultsweep {

using faultsim::concat;

namespace {

/// Folds rows into a short text: what has been added is replaced by its fingerprint now and then.
class Digest {
 public:
  void add(const Cell& cell) {
    text_ += static_cast<char>('0' + cell.index());  // 1, 1.0 and "1" differ
    if (const auto* whole = std::get_if<std::int64_t>(&cell)) add_number(*whole);
    if (const auto* real = std::get_if<double>(&cell)) {
      add_number(std::bit_cast<std::uint64_t>(*real));
    }
    if (const auto* words = std::get_if<std::string>(&cell)) {
      add_number(words->size());
      text_ += ':';
      text_ += *words;
    }
    text_ += '\n';
    constexpr std::size_t kLongest = 1 << 20;
    if (text_.size() > kLongest) text_ = faultsim::fingerprint(text_);
  }
  void add_rows(Statement& query) {
    while (query.step()) {
      for (int column = 0; column < query.n_columns(); ++column) add(query.cell(column));
    }
  }
  std::string finish() const { return faultsim::fingerprint(text_); }

 private:
  template <typename Integer>
  void add_number(Integer number) {
    char digits[24];
    text_.append(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
  }
  std::string text_;
};

/// Selects the rows of one case, in the order of the primary key. Where the key does not begin with
/// case_id, what stands before it are ids of names, which are few.
std::string select_rows(Connection& connection, const std::string& table) {
  Statement key(connection, "SELECT name FROM pragma_table_info(?) WHERE pk > 0 ORDER BY pk");
  key.bind(table);
  std::string where, order;
  bool has_case = false;
  while (key.step()) {
    const std::string column = key.text(0);
    if (column == "case_id") {
      has_case = true;
    } else if (!has_case) {
      where += concat(column, " IN (SELECT id FROM names) AND ");
    }
    order += (order.empty() ? " ORDER BY " : ", ") + column;
  }
  return concat("SELECT * FROM ", table, " WHERE ", has_case ? where : "", "case_id = ?",
                has_case ? order : " ORDER BY rowid");
}

}  // namespace

Checksums::Checksums(Connection& connection) : connection_(connection) {
  Statement tables(connection,
                   "SELECT m.name FROM sqlite_schema m JOIN pragma_table_info(m.name) c"
                   " WHERE m.type = 'table' AND c.name = 'case_id' AND m.name NOT IN"
                   " ('campaign_cases', 'runs', 'result_checksums') ORDER BY m.name");
  std::vector<std::string> names;
  while (tables.step()) names.push_back(tables.text(0));
  for (const std::string& name : names) {
    rows_.push_back(std::make_unique<Statement>(connection, select_rows(connection, name).c_str()));
  }
}

Checksums::~Checksums() = default;

bool Checksums::exist(Connection& connection) {
  return Statement(connection, "SELECT 1 FROM sqlite_schema WHERE name = 'checksum_schema'").step();
}

std::string Checksums::of_result(std::int64_t case_id) const {
  Digest digest;
  digest.add_rows(
      connection_.prepared("SELECT identity, changes FROM cases WHERE id = ?").bind(case_id));
  digest.add_rows(connection_
                      .prepared("SELECT id, case_id, attempt, status, outcome, reason, operator,"
                                " numerics_version FROM runs"
                                " WHERE id = (SELECT run_id FROM case_metrics WHERE case_id = ?)")
                      .bind(case_id));
  for (const auto& query : rows_) digest.add_rows(query->bind(case_id));
  return digest.finish();
}

std::string Checksums::of_campaign(std::int64_t campaign) const {
  Digest digest;
  digest.add_rows(connection_
                      .prepared("SELECT cc.position, cc.case_id, c.identity, c.scene_id, c.changes"
                                " FROM campaign_cases cc JOIN cases c ON c.id = cc.case_id"
                                " WHERE cc.campaign_id = ? ORDER BY cc.position")
                      .bind(campaign));
  digest.add_rows(connection_
                      .prepared("SELECT position, parameter, si, text FROM case_parameters"
                                " WHERE campaign_id = ? ORDER BY position, parameter")
                      .bind(campaign));
  return digest.finish();
}

void Checksums::seal_result(std::int64_t case_id) {
  const std::string checksum = of_result(case_id);
  connection_.prepared("INSERT OR REPLACE INTO result_checksums (case_id, checksum) VALUES (?, ?)")
      .bind(case_id, checksum)
      .run();
}

void Checksums::seal_campaign(std::int64_t campaign) {
  const std::string checksum = of_campaign(campaign);
  connection_
      .prepared("INSERT OR REPLACE INTO campaign_checksums (campaign_id, checksum) VALUES (?, ?)")
      .bind(campaign, checksum)
      .run();
}

namespace {

std::vector<std::int64_t> ids(Connection& connection, const char* sql) {
  std::vector<std::int64_t> all;
  Statement query(connection, sql);
  while (query.step()) all.push_back(query.integer(0));
  return all;
}

}  // namespace

void Checksums::seal_all() {
  for (const std::int64_t id : ids(connection_, "SELECT case_id FROM case_metrics"))
    seal_result(id);
  for (const std::int64_t id : ids(connection_, "SELECT id FROM campaigns")) seal_campaign(id);
  connection_.execute(
      "UPDATE checksum_schema SET version = (SELECT user_version FROM pragma_user_version)");
}

bool Checksums::are_current() const {
  Statement query(connection_,
                  "SELECT version = (SELECT user_version FROM pragma_user_version)"
                  " FROM checksum_schema");
  return query.step() && query.integer(0) != 0;
}

std::vector<std::string> Checksums::problems() const {
  std::vector<std::string> found;
  if (!are_current()) return found;
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
    if (of_result(results.integer(0)) != results.text(2))
      found.push_back(concat("the result of case ", results.text(1), " differs from its checksum"));
  }
  return found;
}

}  // namespace faultsweep
