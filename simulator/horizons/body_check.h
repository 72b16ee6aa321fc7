#pragma once

#include <vector>

#include "simulator/common/errors.h"
#include "simulator/horizons/layered_body.h"

namespace faultsim::horizons {

/// Numbers of a body that make no sense by themselves, and sizes that would make more than some ten
/// million cells, are appended to problems. @pre problems is empty.
void check_numbers(const LayeredBody& body, std::vector<Problem>& problems);

}  // namespace faultsim::horizons
