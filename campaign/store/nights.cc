#include <algorithm>

#include "campaign/store/sqlite.h"
#include "campaign/store/store.h"

namespace faultsweep {

void Store::record_night(const NightRecord& night) {
  Connection& db = *connection_;
  Transaction transaction(db);
  db.run(
      "INSERT INTO nights (at, wall_s, suite, environment, environment_fields,"
      " baseline_environment, program_version, numerics_version, n_compared, n_regressed,"
      " exit_code, blessed) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
      night.at, night.wall_seconds, night.suite, night.environment, night.environment_fields,
      night.baseline_environment, night.program_version, night.numerics_version, night.n_compared,
      night.n_regressed, night.exit_code, night.blessed);
  const std::int64_t id = db.last_insert_id();
  for (const NightCaseRecord& one : night.cases) {
    db.run(
        "INSERT INTO night_cases (night_id, campaign, position, identity, label, verdict,"
        " regressed, max_ulps, load_step, place, quantity, remark, digest, wall_s, outcome,"
        " activated_area_m2, moment_nm, chi_bar)"
        " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
        id, one.campaign, one.position, one.identity, one.label, one.verdict, one.regressed,
        one.max_ulps, one.load_step, one.place, one.quantity, one.remark, one.digest,
        one.wall_seconds, one.outcome, one.activated_area, one.moment, one.chi_bar);
  }
  transaction.commit();
}

std::vector<NightRecord> Store::nights(const std::string& suite, int limit) const {
  Connection& db = *connection_;
  using Text = std::string;
  using Real = std::optional<double>;
  auto all = db.rows<NightRecord, std::int64_t, double, double, Text, Text, Text, Text, Text, int,
                     long, long, int, std::optional<Text>>(
      "SELECT id, at, wall_s, suite, environment, environment_fields, baseline_environment,"
      " program_version, numerics_version, n_compared, n_regressed, exit_code, blessed FROM nights"
      " WHERE ?1 = '' OR suite = ?1 ORDER BY id DESC LIMIT ?2",
      suite, limit);
  for (NightRecord& night : all) {
    night.cases = db.rows<NightCaseRecord, Text, long, Text, Text, Text, bool, double,
                          std::optional<int>, Text, Text, Text, Text, Real, Text, Real, Real, Real>(
        "SELECT campaign, position, identity, label, verdict, regressed, max_ulps, load_step,"
        " place, quantity, remark, digest, wall_s, outcome, activated_area_m2, moment_nm,"
        " chi_bar FROM night_cases WHERE night_id = ? ORDER BY campaign, position",
        night.id);
  }
  std::ranges::reverse(all);
  return all;
}

}  // namespace faultsweep
