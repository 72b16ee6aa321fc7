#pragma once

#include <string>
#include <vector>

namespace faultsim {

/// The candidate that word is most likely a slip of the pen for; "" when none is near. Near means:
/// at most a third of the letters inserted, deleted, replaced or swapped; case and '-' for '_' are
/// free. Ties go to the candidate that comes first.
std::string near_miss(const std::string& word, const std::vector<std::string>& candidates);

/// `did you mean "offset"?`, or `write one of "a", "b"` when nothing is near.
std::string suggest(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace faultsim
