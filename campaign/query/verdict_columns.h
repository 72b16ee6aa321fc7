#pragma once

#include <string>
#include <vector>

#include "campaign/query/selection.h"
#include "campaign/store/store.h"

namespace faultsweep {

/// What is known of a condition on the case of a row.
enum class Held {
  no,
  undecided_no,   ///< cells or the stated error leave it open; as computed it does not hold.
  undecided_yes,  ///< the same; as computed it holds.
  yes,
  unknown,  ///< no history to its end: it may be either.
};

/// Conditions on cases as columns of a query over them, one for each: what is known of them, with
/// what the cells do not resolve and the campaign's errors (stated_errors_of) left open
/// (expression/expression.h).
class VerdictColumns {
 public:
  /// Throws InputError where a condition cannot be read.
  VerdictColumns(const Store& store, const CampaignInfo& campaign, const Selection& selection,
                 const std::vector<std::string>& conditions);
  /// For Store::TableQuery::columns.
  const std::vector<SqlFragment>& columns() const { return columns_; }
  /// Of the c-th condition. @param first  the place of the first of columns() in the row's metrics.
  Held held(const CaseRow& row, std::size_t c, std::size_t first = 0) const;

 private:
  std::vector<SqlFragment> columns_;
};

}  // namespace faultsweep
