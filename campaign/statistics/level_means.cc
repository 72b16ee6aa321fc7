#include "campaign/statistics/level_means.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "campaign/common/names.h"

namespace faultsweep {

namespace {

/// Means over levels and over lines of one factor of a grid. Rows lie in its order: `stride` from
/// one level to the next, a block of n_levels · stride then repeats.
ExactIndices indices_along(std::span<const double> centred, std::size_t n_levels,
                           std::size_t stride, double variance) {
  const auto rows = static_cast<double>(centred.size()), levels = static_cast<double>(n_levels);
  std::vector<double> level_sums(n_levels, 0.0), line_sums(stride);
  double of_lines = 0;
  for (std::size_t block = 0; block < centred.size(); block += n_levels * stride) {
    std::ranges::fill(line_sums, 0.0);
    for (std::size_t level = 0; level < n_levels; ++level) {
      const std::span<const double> slice = centred.subspan(block + level * stride, stride);
      for (std::size_t k = 0; k < stride; ++k) {
        level_sums[level] += slice[k];
        line_sums[k] += slice[k];
      }
    }
    for (const double sum : line_sums) of_lines += sum * sum;
  }
  double of_levels = 0;
  for (const double sum : level_sums) of_levels += sum * sum;
  // Level means have rows / levels members, line means have levels of them.
  const double first = of_levels * levels / (rows * rows) / variance;
  const double total = 1 - of_lines / (levels * rows) / variance;
  return {std::clamp(first, 0.0, 1.0), std::clamp(total, 0.0, 1.0)};
}

std::vector<std::size_t> levels_counted(std::span<const std::vector<std::uint32_t>> levels) {
  std::vector<std::size_t> counts;
  for (const std::vector<std::uint32_t>& factor : levels)
    counts.push_back(1 + *std::ranges::max_element(factor));
  return counts;
}

/// How many combinations there are, or the largest number where that is too small for them.
std::size_t combinations(const std::vector<std::size_t>& counts, std::size_t most) {
  std::size_t product = 1;
  for (const std::size_t count : counts) {
    if (count > most / product) return std::numeric_limits<std::size_t>::max();
    product *= count;
  }
  return product;
}

}  // namespace

FullGrid::Made FullGrid::make(std::span<const std::vector<std::uint32_t>> levels) {
  if (levels.empty() || levels.front().empty()) return {{}, "there are no rows"};
  const std::size_t n = levels.front().size();
  for (const std::vector<std::uint32_t>& factor : levels)
    FAULTSIM_DEMAND(factor.size() == n, factor.size(), " and ", n, " rows");
  FullGrid grid;
  grid.n_levels_ = levels_counted(levels);
  const std::size_t expected = combinations(grid.n_levels_, n);
  if (expected > n) return {{}, concat("only ", n, " of all combinations of levels are present")};
  grid.place_.assign(n, 0);
  for (std::size_t f = 0; f < levels.size(); ++f) {
    const auto count = static_cast<std::uint32_t>(grid.n_levels_[f]);
    for (std::size_t row = 0; row < n; ++row)
      grid.place_[row] = grid.place_[row] * count + levels[f][row];
  }
  std::vector<char> is_taken(expected, 0);
  for (std::size_t row = 0; row < n; ++row) {
    char& taken = is_taken[grid.place_[row]];
    if (taken != 0) return {{}, concat("row ", row + 1, " repeats the levels of an earlier row")};
    taken = 1;
  }
  return {std::move(grid), ""};
}

std::optional<GridIndices> FullGrid::indices(std::span<const double> values) const {
  FAULTSIM_DEMAND(values.size() == place_.size(), values.size(), " values, ", place_.size(),
                  " rows");
  const auto n = static_cast<double>(values.size());
  GridIndices found;
  double sum = 0;
  for (const double value : values) sum += value;
  if (!std::isfinite(sum)) return std::nullopt;
  found.mean = sum / n;
  found.factors.resize(n_levels_.size());
  const auto [least, most] = std::ranges::minmax_element(values);
  if (*least == *most) return found;
  std::vector<double> centred(values.size());
  for (std::size_t row = 0; row < values.size(); ++row)
    centred[place_[row]] = values[row] - found.mean;
  for (const double one : centred) found.variance += one * one / n;
  std::size_t stride = 1;
  for (std::size_t f = n_levels_.size(); f-- > 0; stride *= n_levels_[f])
    found.factors[f] = indices_along(centred, n_levels_[f], stride, found.variance);
  return found;
}

std::vector<ExactIndices> aggregated(std::span<const GridIndices> outputs) {
  FAULTSIM_DEMAND(!outputs.empty(), outputs.size());
  std::vector<ExactIndices> together(outputs.front().factors.size());
  double variance = 0;
  for (const GridIndices& one : outputs) variance += one.variance;
  if (!(variance > 0)) return together;
  for (const GridIndices& one : outputs) {
    FAULTSIM_DEMAND(one.factors.size() == together.size(), one.factors.size(), " factors");
    for (std::size_t f = 0; f < together.size(); ++f) {
      together[f].first += one.variance / variance * one.factors[f].first;
      together[f].total += one.variance / variance * one.factors[f].total;
    }
  }
  return together;
}

}  // namespace faultsweep
