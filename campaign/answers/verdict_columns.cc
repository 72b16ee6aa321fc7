#include "campaign/answers/verdict_columns.h"

#include "campaign/report/table_output.h"

namespace faultsweep {

using faultsim::concat;

namespace {

void append(SqlFragment& to, const char* before, const SqlFragment& part) {
  to.text += before + part.text;
  to.parameters.insert(to.parameters.end(), part.parameters.begin(), part.parameters.end());
}

/// 3 certain, 0 impossible, between them what came out: 2 yes, 1 no.
SqlFragment column_of(const VerdictSql& verdict, const SqlFragment& computed) {
  SqlFragment column;
  append(column, "CASE WHEN ", verdict.certain);
  append(column, " THEN 3 WHEN NOT coalesce(", verdict.possible);
  append(column, ", 0) THEN 0 WHEN ", computed);
  column.text += " THEN 2 ELSE 1 END";
  return column;
}

}  // namespace

VerdictColumns::VerdictColumns(const Store& store, const CampaignInfo& campaign,
                               const Selection& selection,
                               const std::vector<std::string>& conditions) {
  const StatedErrors errors = stated_errors(store, campaign);
  for (const std::string& one : conditions) {
    columns_.push_back(column_of(parse_verdict(one, campaign, selection, errors),
                                 parse_condition(one, campaign, selection)));
  }
}

Held VerdictColumns::held(const CaseRow& row, std::size_t c, std::size_t first) const {
  if (!row.complete()) return Held::unknown;
  switch (static_cast<int>(number_of(row.metrics[first + c]))) {
    case 3:
      return Held::yes;
    case 2:
      return Held::undecided_yes;
    case 1:
      return Held::undecided_no;
    default:
      return Held::no;
  }
}

}  // namespace faultsweep
