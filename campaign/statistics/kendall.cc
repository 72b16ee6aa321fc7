#include "campaign/statistics/kendall.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/errors.h"

namespace faultsweep {
namespace {

using Pair = std::pair<long, long>;

/// Pairs of equal neighbours in a sorted sequence: Σ t(t−1)/2 over runs of t equal ones.
template <typename Same>
double tied_pairs(const std::vector<Pair>& sorted, const Same& same) {
  double ties = 0, run = 0;
  for (std::size_t k = 1; k < sorted.size(); ++k) {
    run = same(sorted[k - 1], sorted[k]) ? run + 1 : 0;
    ties += run;
  }
  return ties;
}

/// Sorts by the second member and counts how often a larger one stood before a smaller one.
double sort_and_count(std::vector<Pair>& pairs, std::vector<Pair>& spare, std::size_t begin,
                      std::size_t end) {
  if (end - begin < 2) return 0;
  const std::size_t middle = begin + (end - begin) / 2;
  double exchanges =
      sort_and_count(pairs, spare, begin, middle) + sort_and_count(pairs, spare, middle, end);
  std::size_t left = begin, right = middle;
  for (std::size_t k = begin; k < end; ++k) {
    const bool take_right =
        right < end && (left == middle || pairs[right].second < pairs[left].second);
    if (take_right) exchanges += static_cast<double>(middle - left);
    spare[k] = take_right ? pairs[right++] : pairs[left++];
  }
  const auto at = [](std::size_t k) { return static_cast<std::ptrdiff_t>(k); };
  std::copy(spare.begin() + at(begin), spare.begin() + at(end), pairs.begin() + at(begin));
  return exchanges;
}

}  // namespace

std::optional<double> kendall_tau_b(const std::vector<long>& a, const std::vector<long>& b) {
  FAULTSIM_DEMAND(a.size() == b.size(), a.size(), " ", b.size());
  std::vector<Pair> pairs;
  for (std::size_t k = 0; k < a.size(); ++k) pairs.emplace_back(a[k], b[k]);
  std::ranges::sort(pairs);
  const double tied_a =
      tied_pairs(pairs, [](const Pair& p, const Pair& q) { return p.first == q.first; });
  const double tied_both = tied_pairs(pairs, [](const Pair& p, const Pair& q) { return p == q; });
  std::vector<Pair> spare(pairs.size());
  const double discordant = sort_and_count(pairs, spare, 0, pairs.size());
  const double tied_b =
      tied_pairs(pairs, [](const Pair& p, const Pair& q) { return p.second == q.second; });
  const double n = static_cast<double>(a.size()), all = n * (n - 1) / 2;
  if (!(all > tied_a) || !(all > tied_b)) return std::nullopt;
  const double concordant = all - tied_a - tied_b + tied_both - discordant;
  return (concordant - discordant) / std::sqrt((all - tied_a) * (all - tied_b));
}

}  // namespace faultsweep
