#pragma once

#include "campaign/expansion/expansion.h"
#include "campaign/store/records.h"

namespace faultsweep {

/// An expansion as the store takes it. Where a spec has several groups, the group's name is one
/// more parameter, called "group".
/// @param cases  identity = without changes and parameters of cases: for a look, not for a store.
enum class CaseDetail { identity, whole };
Submission make_submission(const Expansion& expansion, CaseDetail cases = CaseDetail::whole);

}  // namespace faultsweep
