#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "campaign/expression/expression.h"
#include "campaign/store/records.h"
#include "campaign/store/result_rows.h"
#include "campaign/store/sqlite.h"
#include "campaign/store/store.h"

/// What several queries of the store share.
namespace faultsweep {

/// Binds the parameters of an expression's SqlFragment after `position`, which it moves on.
void bind_values(Statement& statement, int& position, const std::vector<Value>& values);

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
std::string joins(const Store::TableQuery& query);
/// " AND ..." of the query's condition; "" = all.
std::string where_sql(const SqlFragment& where);

/// The counts of a campaign's cases by family id. In one pass without sorting: with 10^5 cases an
/// SQL GROUP BY takes twice as long.
std::map<std::int64_t, CaseCounts> count_by_family(Connection& connection, std::int64_t campaign);

/// What a fault did in a stage, with its onsets; without a name where nothing is stored, as of
/// results from before fault_metrics.
faultsim::FaultStageMetrics read_fault_row(Connection& db, const ResultTables& tables,
                                           std::int64_t case_id, std::int64_t stage_id,
                                           std::int64_t fault_id);

}  // namespace faultsweep
