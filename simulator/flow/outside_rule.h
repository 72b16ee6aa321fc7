#pragma once

namespace faultsim {

/// What a cell of which nothing is covered by the flow grid takes.
enum class OutsideRule {
  nearest,    ///< the flow cell whose centre is nearest to its own (the first of equals).
  unchanged,  ///< no flow cell: its pressure does not change.
};

}  // namespace faultsim
