#pragma once

#include <algorithm>
#include <functional>
#include <iterator>
#include <type_traits>
#include <utility>
#include <vector>

/// What the ranges of C++20 leave to be written by hand.
namespace faultsim {

/// Whether an item, seen through `projection`, equals `value`.
template <typename Range, typename Value, typename Projection = std::identity>
bool contains(const Range& range, const Value& value, Projection projection = {}) {
  return std::ranges::find(range, value, std::move(projection)) != std::ranges::end(range);
}

/// Drops what equals the item before it.
template <typename List, typename Same = std::equal_to<>>
void drop_repeated(List& list, Same same = {}) {
  list.erase(std::unique(list.begin(), list.end(), same), list.end());
}

/// f of every item, in order; f may be a pointer to a member.
template <typename Range, typename F>
auto mapped(Range&& range, F f) {
  std::vector<std::decay_t<std::invoke_result_t<F&, decltype(*std::begin(range))>>> all;
  if constexpr (std::ranges::sized_range<Range>) all.reserve(std::ranges::size(range));
  for (auto&& item : range) all.push_back(std::invoke(f, item));
  return all;
}

}  // namespace faultsim
