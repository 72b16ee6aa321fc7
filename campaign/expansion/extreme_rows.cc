#include "campaign/expansion/extreme_rows.h"

#include <algorithm>
#include <cstdint>
#include <set>

namespace faultsweep {
namespace {

constexpr std::size_t kMaximumCorners = 128;
constexpr long kSpreadRows = 32;

bool is_excluded(const CaseValues& values, const Row& row) {
  std::vector<double> derived;
  values.derive(row, derived);
  return values.excluded_by(row, derived) >= 0;
}

/// Each row once with each of the choices of a parameter, if not too many.
std::vector<Row> crossed(const std::vector<Row>& rows, std::size_t p,
                         const std::vector<int>& choices) {
  std::vector<Row> next;
  for (const Row& row : rows) {
    for (const int choice : choices) {
      if (next.size() >= kMaximumCorners) break;
      next.push_back(row);
      next.back()[p] = choice;
    }
  }
  return next;
}

}  // namespace

std::vector<int> sample_choices(const Parameter& parameter, std::size_t n) {
  const int size = parameter.n_values();
  std::set<int> sample;
  if (static_cast<std::size_t>(size) <= n) {
    for (int c = 0; c < size; ++c) sample.insert(c);
    return {sample.begin(), sample.end()};
  }
  const auto smaller = [](const Choice& a, const Choice& b) {
    return a.si.value_or(0) < b.si.value_or(0);
  };
  const auto [least, most] =  // of a range: its ends
      std::ranges::minmax_element(parameter.choices, smaller);
  sample = {0, size - 1, static_cast<int>(least - parameter.choices.begin()),
            static_cast<int>(most - parameter.choices.begin())};
  const auto wanted = static_cast<std::int64_t>(n);
  for (std::int64_t i = 1; i < wanted && sample.size() < n; ++i) {
    sample.insert(static_cast<int>(i * size / wanted));
  }
  return {sample.begin(), sample.end()};
}

std::vector<Row> extreme_rows(const Group& group, const CaseValues& values,
                              const std::vector<bool>& matters) {
  const long n_rows = count_rows(group);
  Row row;
  long first = 0;
  for (; first < n_rows; ++first) {
    row_at(group, first, row);
    if (!is_excluded(values, row)) break;
  }
  if (first == n_rows) return {};
  std::vector<Row> rows = {row};
  std::size_t p = 0;
  for (const Design& design : group.designs) {
    const std::size_t end = p + design.n_parameters;
    for (; design.kind == DesignKind::grid && p < end; ++p) {
      const Parameter& parameter = group.parameters[p];
      if (matters[p]) rows = crossed(rows, p, sample_choices(parameter, parameter.is_text ? 4 : 2));
    }
    p = end;
  }
  for (long i = 0; i < kSpreadRows; ++i) {
    row_at(group, i * (n_rows - 1) / (kSpreadRows - 1), row);
    rows.push_back(row);
  }
  std::erase_if(rows, [&](const Row& one) { return is_excluded(values, one); });
  return rows;
}

}  // namespace faultsweep
