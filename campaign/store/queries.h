#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "campaign/common/names.h"
#include "campaign/expression/expression.h"
#include "campaign/store/records.h"
#include "campaign/store/result_rows.h"
#include "campaign/store/sqlite.h"
#include "campaign/store/store.h"

/// What several queries of the store share.
namespace faultsweep {

/// Reads case_parameters, case by case.
class ParameterReader {
 public:
  ParameterReader(Connection& connection, std::int64_t campaign);
  CaseParameters of(long position);

 private:
  std::int64_t campaign_;
  Statement query_;
};

/// What tables are read from, after "cc", a campaign's cases; the query's stage is its parameter.
/// With "WHERE cc.campaign_id = ?" and where_sql: stage, campaign, parameters of the condition.
std::string joins(const Store::TableQuery& query);
/// " AND ..." of the query's condition; "" = all.
std::string where_sql(const SqlFragment& where);

/// SQL over "$", a row of fault_metrics or stage_metrics, of a scope's row.
/// @pre the scope has a stage.
std::string value_of_scope(const std::string& sql, const MetricScope& scope);

/// Values of other faults and stages (metric_sql of a scope) as columns of rows that are joined
/// once, instead of a subquery each: 72 metrics are of eight rows.
class ScopeJoins {
 public:
  /// The same value or condition with these rows; where there are too many rows as it was.
  std::string joined(const std::string& sql);
  /// " LEFT JOIN ..." of the rows, behind cc.
  std::string sql() const;

 private:
  static constexpr std::size_t kMost = 40;  ///< rows; SQLite joins up to 64 tables.
  std::vector<std::string> keys_;           ///< of each row: its table and key.
};

/// The counts of a campaign's cases by family id. In one pass without sorting: with 10^5 cases an
/// SQL GROUP BY takes twice as long.
std::map<std::int64_t, CaseCounts> count_by_family(Connection& connection, std::int64_t campaign);

/// What a fault did in a stage, with its onsets; without a name where nothing is stored, as of
/// results from before fault_metrics.
faultsim::FaultStageMetrics read_fault_row(Connection& db, const ResultTables& tables,
                                           std::int64_t case_id, std::int64_t stage_id,
                                           std::int64_t fault_id);

}  // namespace faultsweep
