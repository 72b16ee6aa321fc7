#pragma once

#include <algorithm>

namespace faultsim {

/// Goes through a load step in parts, whatever solves them: halves a part that fails, down to the
/// 2^most_cuts-th of the step, and doubles again where it works, onto the grid of the doubled
/// width.
/// @pre 0 <= most_cuts <= 30: parts are counted in int.
/// @param advance  bool(from, width), in units of the smallest part: whether there is equilibrium.
/// @param at_last  bool(from): what becomes of a smallest part that fails, whether it goes on.
/// @returns whether the end was reached.
template <typename Advance, typename AtLast>
constexpr bool walk_in_parts(int most_cuts, const Advance& advance, const AtLast& at_last) {
  const int units = 1 << most_cuts;
  int position = 0;
  int width = std::max(units / 2, 1);
  while (position < units) {
    if (advance(position, width)) {
      position += width;
      if (position % (2 * width) == 0 && 2 * width <= units - position) width *= 2;
    } else if (width > 1) {
      width /= 2;
    } else {
      if (!at_last(position)) return false;
      ++position;
    }
  }
  return true;
}

}  // namespace faultsim
