#include <algorithm>
#include <charconv>

#include "campaign/common/names.h"
#include "campaign/store/queries.h"
#include "campaign/store/store.h"
#include "simulator/common/fingerprint.h"

namespace faultsweep {

namespace {

std::vector<StoredRun> read_runs(Connection& db, std::int64_t case_id) {
  using Id = std::int64_t;
  using Text = std::string;
  return db.rows<StoredRun, Id, int, double, double, Text, Text, Text, Text, Text, Text, int,
                 std::optional<Id>, std::optional<Id>, bool>(
      "SELECT id, attempt, ended_at, wall_s, status, coalesce(outcome, ''), reason, log_tail,"
      " coalesce(operator, ''), host, rank, signal, exit_code, fields_only FROM runs"
      " WHERE case_id = ? ORDER BY attempt",
      case_id);
}

constexpr std::size_t kShortestPrefix = 6;

/// The case of this number from 1; none = there is none, or the name is no number.
std::optional<long> numbered_case(Connection& db, std::int64_t campaign, const std::string& name) {
  long position = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), position);
  if (error != std::errc() || end != name.data() + name.size()) return std::nullopt;
  return db.find<long>("SELECT position FROM campaign_cases WHERE campaign_id = ? AND position = ?",
                       campaign, position);
}

/// The case whose identity begins so; none = there is none. Throws InputError where it is not the
/// only one.
std::optional<long> case_with_prefix(Connection& db, std::int64_t campaign,
                                     const std::string& prefix) {
  if (prefix.size() < kShortestPrefix) return std::nullopt;
  constexpr std::size_t kListed = 5;
  using Place = std::pair<long, std::string>;
  const auto fitting = db.rows<Place, long, std::string>(
      "SELECT cc.position, c.identity FROM campaign_cases cc JOIN cases c ON c.id = cc.case_id"
      " WHERE cc.campaign_id = ?1 AND c.identity >= ?2 AND c.identity < ?2 || '~'"
      " ORDER BY c.identity LIMIT ?3",
      campaign, prefix, kListed + 1);
  if (fitting.empty()) return std::nullopt;
  if (fitting.size() == 1 || fitting.front().second == prefix) return fitting.front().first;
  std::vector<std::string> listed;
  for (std::size_t k = 0; k < std::min(kListed, fitting.size()); ++k)
    listed.push_back(concat(fitting[k].first, " (", fitting[k].second, ")"));
  throw InputError("CASE",
                   concat("the identities of several cases begin with '", prefix,
                          "': ", joined(listed, ", "), fitting.size() > kListed ? ", ..." : ""),
                   "give more digits, or the number of the case");
}

}  // namespace

StoredCase Store::stored_case(std::int64_t campaign, const std::string& name) const {
  Connection& db = *connection_;
  auto position = numbered_case(db, campaign, name);
  if (!position) position = case_with_prefix(db, campaign, name);
  if (!position) {
    throw InputError(
        "CASE", concat("the campaign has no case '", name, "'"),
        concat("give its number from 1, or at least ", kShortestPrefix, " digits of its identity"));
  }
  Statement query(db,
                  "SELECT c.id, cc.position, c.identity, f.fingerprint, c.state, c.changes,"
                  " c.scene_id, cc.fields, k.name FROM campaign_cases cc"
                  " JOIN campaigns k ON k.id = cc.campaign_id JOIN cases c ON c.id = cc.case_id"
                  " JOIN families f ON f.id = c.family_id"
                  " WHERE cc.campaign_id = ? AND cc.position = ?");
  query.bind(campaign, *position);
  query.step();
  StoredCase found;
  std::string fields, campaign_name;
  query.read(found.id, found.position, found.identity, found.family, found.state, found.changes,
             found.scene, fields, campaign_name);
  found.parameters = ParameterReader(db, campaign).of(found.position);
  found.fields = stored_word<FieldsState>(fields, "state of fields");
  found.fields_folder = fields_folder(campaign_name, found.position);
  found.runs = read_runs(db, found.id);
  if (auto result = stored_result(found.id)) {
    found.has_result = true;
    found.result = std::move(*result);
  }
  found.result.identity = found.identity;
  return found;
}

Store::Approximations Store::approximations(std::int64_t campaign) const {
  return connection_
      ->row<Approximations, long, long, double, double, std::optional<double>, long, double>(
          "SELECT count(*), count(u.case_id), coalesce(max(u.error_of_stiffness), 0),"
          " coalesce(max(u.error_of_slip), 0), max(u.error_of_chi_bar), "
          "coalesce(sum(m.field_coverage < 0.999999), 0),"
          " coalesce(min(m.field_coverage), 1) FROM campaign_cases cc"
          " JOIN case_metrics m ON m.case_id = cc.case_id"
          " LEFT JOIN case_surfaces u ON u.case_id = cc.case_id WHERE cc.campaign_id = ?",
          campaign);
}

int Store::oldest_numerics(std::int64_t campaign) const {
  return connection_->row<int>(
      "SELECT coalesce(min(r.numerics_version), ?2) FROM campaign_cases cc"
      " JOIN case_metrics m ON m.case_id = cc.case_id JOIN runs r ON r.id = m.run_id"
      " WHERE cc.campaign_id = ?1",
      campaign, faultsim::kNumericsVersion);
}

std::vector<FailureCount> Store::failure_counts(std::int64_t campaign) const {
  return connection_->rows<FailureCount, std::string, std::string, long>(
      "SELECT status, why, count(*) FROM ("
      "SELECT r.status, CASE WHEN r.outcome IS NULL THEN r.reason ELSE r.outcome END AS why"
      " FROM campaign_case_states s JOIN runs r ON r.id = s.run_id WHERE s.campaign_id = ?1"
      " AND s.state <> 'waiting' AND (NOT s.lacks_only_fields OR s.state = 'done')"
      " AND NOT s.complete"
      " UNION ALL SELECT r.status, 'fields: ' || r.reason FROM campaign_case_states s"
      " JOIN runs r ON r.case_id = s.case_id WHERE s.campaign_id = ?1 AND s.fields = 'failed'"
      " AND s.lacks_only_fields AND r.campaign_id = ?1 AND r.fields_only"
      " AND NOT EXISTS (SELECT 1 FROM runs later WHERE later.case_id = r.case_id"
      " AND later.campaign_id = ?1 AND later.fields_only AND later.attempt > r.attempt))"
      " GROUP BY 1, 2 ORDER BY 3 DESC, 1, 2 LIMIT 20",
      campaign);
}

std::vector<EventRecord> Store::events(std::int64_t campaign, int limit) const {
  return connection_->rows<EventRecord, double, std::string, std::string>(
      "SELECT at, kind, text FROM events WHERE campaign_id = ? ORDER BY id DESC LIMIT ?", campaign,
      limit);
}

std::vector<Store::FamilyProgress> Store::family_progress(std::int64_t campaign) const {
  std::vector<FamilyProgress> all;
  Statement query = connection_->prepared(
      "SELECT f.fingerprint, coalesce(f.operator, ''), o.build_s, f.n_operators,"
      " f.predicted_memory_bytes, iif(o.build_s IS NULL, NULL, o.peak_bytes) FROM families f"
      " LEFT JOIN operators o ON o.fingerprint = f.operator WHERE f.id = ?");
  for (const auto& [family, counts] : count_by_family(*connection_, campaign)) {
    FAULTSIM_DEMAND(query.bind(family).step(), family);
    FamilyProgress& one = all.emplace_back();
    static_cast<CaseCounts&>(one) = counts;
    query.read(one.fingerprint, one.operator_fingerprint, one.build_seconds, one.n_operators,
               one.memory_bytes, one.peak_bytes);
  }
  return all;
}

std::vector<std::string> Store::campaigns_with(std::int64_t case_id) const {
  return connection_->rows<std::string>(
      "SELECT k.name FROM campaign_cases cc JOIN campaigns k ON k.id = cc.campaign_id"
      " WHERE cc.case_id = ? ORDER BY k.id",
      case_id);
}

}  // namespace faultsweep
