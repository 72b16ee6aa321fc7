#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "simulator/common/errors.h"

/// Texts from numbers and lists; concat and counted are in errors.h.
namespace faultsim {

/// As printf does.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* pattern, ...);

/// "1234.5": rounded to so many decimals, without zeros behind them; never "-0".
std::string decimal(double value, int decimals);

/// The items, seen through `projection` (to a text or a number), with `between` between them.
template <typename Range, typename Projection = std::identity>
std::string joined(const Range& range, std::string_view between, Projection projection = {}) {
  std::string all;
  bool first = true;
  for (const auto& item : range) {
    if (!std::exchange(first, false)) all += between;
    all += concat(std::invoke(projection, item));
  }
  return all;
}

}  // namespace faultsim
