#pragma once

#include <string>

#include "campaign/store/store.h"

namespace faultsweep {

/// How many results of a campaign have an interpolated operator or a flow result that covers the
/// compartments in part, with the worst measured errors: what answers over them say. "" = none.
std::string approximation_note(const Store::Approximations& found);

}  // namespace faultsweep
