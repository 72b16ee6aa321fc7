#pragma once

#include "campaign/expansion/expansion.h"
#include "campaign/store/records.h"

namespace faultsweep {

/// An expansion as the store takes it. Where a spec has several groups, the group's name is one
/// more parameter, called "group".
/// @param cases  identity = without changes and parameters of cases: for a look, not for a store.
enum class CaseDetail { identity, whole };
Submission make_submission(const Expansion& expansion, CaseDetail cases = CaseDetail::whole);

/// For campaigns that a command runs for an answer of its own, in which nobody looks at cases:
/// fields of those ranked first are not kept. What the spec asks for itself stays.
Submission without_shown_fields(Submission submission);

}  // namespace faultsweep
