#pragma once

#include <vector>

#include "simulator/common/errors.h"
#include "simulator/horizons/layered_body.h"

namespace faultsim::horizons {

/// Numbers of a body that make no sense by themselves are appended to problems.
void check_numbers(const LayeredBody& body, std::vector<Problem>& problems);

}  // namespace faultsim::horizons
