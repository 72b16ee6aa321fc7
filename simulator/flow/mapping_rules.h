#pragma once

#include <array>
#include <limits>

namespace faultsim {

/// What a cell of which nothing is covered by the flow grid takes.
enum class OutsideRule {
  nearest,    ///< the flow cell whose centre is nearest to its own (the first of equals).
  unchanged,  ///< no flow cell: its pressure does not change.
};

/// What the integral of the change over a compartment, ∫Δp dV, is.
enum class IntegralRule {
  mapped,     ///< that of the means that its cells take: over what both grids cover the flow
              ///< grid's, elsewhere assumed.
  flow_grid,  ///< that of the flow cells that count with it, whole, wherever they lie.
};

struct MappingRules {
  OutsideRule outside = OutsideRule::nearest;
  IntegralRule integral = IntegralRule::mapped;
  /// Of flow_grid: what of the flow cells is modelled, m: half a domain, a section of plane strain.
  std::array<double, 2> y_range = {-std::numeric_limits<double>::infinity(),
                                   std::numeric_limits<double>::infinity()};
};

}  // namespace faultsim
