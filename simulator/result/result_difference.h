#pragma once

#include <string>
#include <vector>

#include "simulator/result/result.h"

namespace faultsim {

/// What became of a case otherwise than before a change of its scene, as sentences for its readers,
/// the most important first: how it ends, which faults slide or open and from when (of the whole
/// case, then stage by stage), unexpected reactivations, slip events, the largest χ̄ and slip of
/// each fault, the pressure that is left. Faults are told apart by their names. Flags that cells
/// leave open are said to be undecided, and changes that are less than what is known of the numbers
/// (0.001 of χ̄, 0.01 mm of slip; on a surface its measured errors) are not said. Never empty: says
/// so where nothing changes. Last comes what the two cannot be compared in.
std::vector<std::string> difference_sentences(const CaseResult& before, const CaseResult& after);

}  // namespace faultsim
