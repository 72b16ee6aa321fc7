#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "simulator/common/errors.h"

/// Enumerations and their words. Beside an enumeration that is read or written stands
/// `constexpr auto words(Enum)`, the array of its words in the order of its enumerators.
namespace faultsim {

template <typename Enum>
concept Worded = std::is_enum_v<Enum> && requires(Enum one) {
  words(one).size();
};

template <Worded Enum>
const char* to_string(Enum one) {
  constexpr auto all = words(Enum());
  FAULTSIM_DEMAND(static_cast<std::size_t>(one) < all.size(), static_cast<int>(one));
  return all[static_cast<std::size_t>(one)];
}

template <Worded Enum>
constexpr std::optional<Enum> named(std::string_view word) {
  constexpr auto all = words(Enum());
  const auto found = std::ranges::find(all, word);
  if (found == all.end()) return std::nullopt;
  return static_cast<Enum>(found - all.begin());
}

/// Of a file of ours. @throws StorageError when it is none; `what` it should be: "outcome".
template <Worded Enum>
Enum stored_word(std::string_view word, const char* what) {
  if (const auto one = named<Enum>(word)) return *one;
  throw StorageError(concat("unknown ", what, " \"", word, "\""));
}

template <Worded Enum>
constexpr auto enumerators() {
  std::array<Enum, words(Enum()).size()> all{};
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<Enum>(i);
  return all;
}

}  // namespace faultsim
