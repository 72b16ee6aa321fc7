#pragma once

#include <optional>

#include "simulator/flow/flow_field.h"

namespace faultsim {

/// By how much a field differs from its mirror image about y = 0: the largest difference between
/// the values of a cell and of its image at any report, over the largest value. Nothing where the
/// grid is not its own mirror image, to a millimetre in every corner.
std::optional<double> asymmetry(const FlowField& field);

}  // namespace faultsim
