#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace faultsim {

/// After so many problems nobody reads suggestions, and looking for them takes time.
inline constexpr std::size_t kMostSuggestions = 100;

/// Letters inserted, deleted, replaced or, of neighbours, swapped on the way from a to b (optimal
/// string alignment). Takes the product of both lengths.
std::size_t edit_distance(const std::string& a, const std::string& b);

/// The candidate that word is most likely a slip of the pen for; "" when none is near. Near means:
/// at most a third of the letters inserted, deleted, replaced or swapped; case and '-' for '_' are
/// free. Ties go to the candidate that comes first. Only words of up to 100 bytes and the first 300
/// candidates are compared.
std::string near_miss(const std::string& word, const std::vector<std::string>& candidates);

/// `did you mean "offset"?`, or `write one of "a", "b"` (60 at most) when nothing is near.
std::string suggest(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace faultsim
