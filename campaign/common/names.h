#pragma once

#include "simulator/common/errors.h"
#include "simulator/common/exit_code.h"
#include "simulator/common/ranges.h"
#include "simulator/common/text.h"
#include "simulator/common/units.h"
#include "simulator/common/words.h"

/// What every room of campaigns takes from the ground of the simulator.
namespace faultsweep {

using faultsim::concat;
using faultsim::contains;
using faultsim::counted;
using faultsim::Dimension;
using faultsim::enumerators;
using faultsim::ExitCode;
using faultsim::formatted;
using faultsim::InputError;
using faultsim::joined;
using faultsim::mapped;
using faultsim::named;
using faultsim::Problem;
using faultsim::ResourceError;
using faultsim::StorageError;
using faultsim::stored_word;
using faultsim::to_string;

}  // namespace faultsweep
