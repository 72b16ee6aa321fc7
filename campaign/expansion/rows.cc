#include "campaign/expansion/rows.h"

#include <algorithm>

#include "simulator/common/errors.h"

namespace faultsweep {
namespace {

using Parameters = const Parameter*;  ///< those of one design.

long size_of(const Parameter& one) { return static_cast<long>(one.choices.size()); }

/// They are listed, read or drawn.
bool has_rows(const Design& design) {
  return design.kind == DesignKind::list || is_of_file(design.kind) || is_sampled(design.kind);
}

long count_rows(const Design& design, Parameters parameters) {
  if (has_rows(design)) return static_cast<long>(design.rows.size());
  if (design.kind == DesignKind::zip) return design.n_parameters == 0 ? 0 : size_of(parameters[0]);
  const bool is_grid = design.kind == DesignKind::grid;
  long count = design.without_base ? 0 : 1;
  for (std::size_t p = 0; p < design.n_parameters; ++p)
    count = is_grid ? count * size_of(parameters[p]) : count + size_of(parameters[p]);
  return count;
}

/// @param row  of the design's parameters, filled with -1.
void row_at(const Design& design, Parameters parameters, long i, int* row) {
  const std::size_t n = design.n_parameters;
  if (has_rows(design)) {
    std::copy_n(design.rows[i].begin(), n, row);
  } else if (design.kind == DesignKind::zip) {
    std::fill_n(row, n, static_cast<int>(i));
  } else if (design.kind == DesignKind::grid) {
    for (std::size_t p = n; p-- > 0; i /= size_of(parameters[p]))
      row[p] = static_cast<int>(i % size_of(parameters[p]));
  } else {
    long first = design.without_base ? 0 : 1;
    for (std::size_t p = 0; p < n; first += size_of(parameters[p++])) {
      const long choice = i - first;
      if (choice >= 0 && choice < size_of(parameters[p])) row[p] = static_cast<int>(choice);
    }
  }
}

long count_all_rows(const Group& group) {
  long count = 1;
  const Parameter* first = group.parameters.data();
  for (const Design& design : group.designs) {
    count *= count_rows(design, first);
    first += design.n_parameters;
  }
  return count;
}

}  // namespace

long count_rows(const Group& group) {
  return group.picked.empty() ? count_all_rows(group) : static_cast<long>(group.picked.size());
}

void row_at(const Group& group, long i, Row& row) {
  FAULTSIM_DEMAND(i >= 0 && i < count_rows(group), "row ", i);
  if (!group.picked.empty()) i = group.picked[i];
  FAULTSIM_DEMAND(i >= 0 && i < count_all_rows(group), "row ", i);
  row.assign(group.parameters.size(), -1);
  std::size_t end = row.size();
  for (auto design = group.designs.rbegin(); design != group.designs.rend(); ++design) {
    const std::size_t begin = end - design->n_parameters;
    const Parameter* first = group.parameters.data() + begin;
    const long n_rows = count_rows(*design, first);
    row_at(*design, first, i % n_rows, row.data() + begin);
    i /= n_rows;
    end = begin;
  }
}

}  // namespace faultsweep
