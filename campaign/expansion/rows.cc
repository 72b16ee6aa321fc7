#include "campaign/expansion/rows.h"

#include <algorithm>

#include "simulator/common/errors.h"

namespace faultsweep {

long count_rows(const Group& group) {
  const auto size_of = [](const Parameter& one) { return static_cast<long>(one.choices.size()); };
  long count = 1;
  switch (group.kind) {
    case DesignKind::list:
      return static_cast<long>(group.rows.size());
    case DesignKind::zip:
      return group.parameters.empty() ? 0 : size_of(group.parameters.front());
    case DesignKind::one_at_a_time:
      for (const Parameter& one : group.parameters) count += size_of(one);
      return count;
    case DesignKind::grid:
      for (const Parameter& one : group.parameters) count *= size_of(one);
      return count;
  }
  faultsim::throw_internal("known design", "", __FILE__, __LINE__);
}

void row_at(const Group& group, long i, Row& row) {
  FAULTSIM_DEMAND(i >= 0 && i < count_rows(group), "row ", i);
  const std::size_t n = group.parameters.size();
  row.assign(n, -1);
  switch (group.kind) {
    case DesignKind::list:
      row = group.rows[static_cast<std::size_t>(i)];
      return;
    case DesignKind::zip:
      std::fill(row.begin(), row.end(), static_cast<int>(i));
      return;
    case DesignKind::one_at_a_time:
      for (std::size_t p = 0, first = 1; p < n; first += group.parameters[p++].choices.size()) {
        const long choice = i - static_cast<long>(first);
        if (choice >= 0 && choice < static_cast<long>(group.parameters[p].choices.size())) {
          row[p] = static_cast<int>(choice);
        }
      }
      return;
    case DesignKind::grid:
      for (std::size_t p = n; p-- > 0;) {
        const auto size = static_cast<long>(group.parameters[p].choices.size());
        row[p] = static_cast<int>(i % size);
        i /= size;
      }
      return;
  }
}

}  // namespace faultsweep
