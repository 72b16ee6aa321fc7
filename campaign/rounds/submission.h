#pragma once

#include "campaign/expansion/expansion.h"
#include "campaign/store/records.h"

namespace faultsweep {

/// An expansion as the store takes it. Where a spec has several groups, the group's name is one
/// more parameter, called "group".
Submission make_submission(const Expansion& expansion);

}  // namespace faultsweep
