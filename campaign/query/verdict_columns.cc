#include "campaign/query/verdict_columns.h"

#include "campaign/common/names.h"
#include "campaign/query/ranking.h"
#include "campaign/query/table_output.h"

namespace faultsweep {

namespace {

/// What a column says.
constexpr int kImpossible = 0, kCameOutNo = 1, kCameOutYes = 2, kCertain = 3;

SqlFragment column_of(const VerdictSql& verdict, const SqlFragment& computed) {
  SqlFragment column{"CASE WHEN ", {}};
  column += verdict.certain;
  column.text += concat(" THEN ", kCertain, " WHEN NOT coalesce(");
  column += verdict.possible;
  column.text += concat(", 0) THEN ", kImpossible, " WHEN ");
  column += computed;
  column.text += concat(" THEN ", kCameOutYes, " ELSE ", kCameOutNo, " END");
  return column;
}

}  // namespace

VerdictColumns::VerdictColumns(const Store& store, const CampaignInfo& campaign,
                               const Selection& selection,
                               const std::vector<std::string>& conditions) {
  const StatedErrors errors = stated_errors_of(store, campaign);
  for (const std::string& one : conditions) {
    columns_.push_back(column_of(parse_verdict(one, campaign, selection, errors),
                                 parse_condition(one, campaign, selection)));
  }
}

Held VerdictColumns::held(const CaseRow& row, std::size_t c, std::size_t first) const {
  // What is asked of parameters alone is known of every case.
  const auto code = static_cast<int>(number_of(row.metrics[first + c]));
  if (code == kCertain) return Held::yes;
  if (code == kImpossible) return Held::no;
  if (!row.complete()) return Held::unknown;
  return code == kCameOutYes ? Held::undecided_yes : Held::undecided_no;
}

}  // namespace faultsweep
