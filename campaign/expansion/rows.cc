#include "campaign/expansion/rows.h"

#include <algorithm>

#include "simulator/common/errors.h"

namespace faultsweep {

long double count_rows(const Group& group) {
  switch (group.kind) {
    case DesignKind::list: return static_cast<long double>(group.rows.size());
    case DesignKind::zip:
      return group.parameters.empty()
                 ? 0
                 : static_cast<long double>(group.parameters.front().choices.size());
    case DesignKind::one_at_a_time: {
      long double count = 1;
      for (const Parameter& one : group.parameters) {
        count += static_cast<long double>(one.choices.size());
      }
      return count;
    }
    case DesignKind::grid: break;
  }
  long double count = 1;
  for (const Parameter& one : group.parameters) {
    count *= static_cast<long double>(one.choices.size());
  }
  return count;
}

std::string describe_count(const Group& group) {
  const char* between = group.kind == DesignKind::grid ? " x " : " + ";
  if (group.kind == DesignKind::list || group.kind == DesignKind::zip) return "as listed";
  std::string text;
  for (const Parameter& one : group.parameters) {
    if (!text.empty()) text += between;
    text += std::to_string(one.choices.size()) + " (" + one.name + ")";
  }
  return text;
}

void row_at(const Group& group, long i, Row& row) {
  FAULTSIM_DEMAND(i >= 0 && static_cast<long double>(i) < count_rows(group), "row ", i);
  const std::size_t n = group.parameters.size();
  row.assign(n, -1);
  switch (group.kind) {
    case DesignKind::list: row = group.rows[static_cast<std::size_t>(i)]; return;
    case DesignKind::zip: std::fill(row.begin(), row.end(), static_cast<int>(i)); return;
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
