#pragma once

#include <array>
#include <string>
#include <vector>

#include "campaign/answers/shares.h"

/// Escalation levels: what is to be done about a fault, by what the cases of a campaign do.
namespace faultsweep {

/// Beside the words, never in their place.
enum class LevelColour { green, amber, red, grey };
constexpr auto words(LevelColour) { return std::array{"green", "amber", "red", "grey"}; }

struct EscalationLevel {
  std::string name;       ///< "amber".
  std::string words;      ///< what it means, or asks for.
  std::string condition;  ///< as of `rank --where`; "" = cases that are at no other level.
  LevelColour colour = LevelColour::grey;
};

/// A table of levels; meaning of each key: schemas/levels.schema.json.
struct EscalationTable {
  std::string title;                    ///< "" = none.
  std::string source;                   ///< file name; "" = built in.
  std::vector<EscalationLevel> levels;  ///< from the least to the most severe; the first one has no
                                        ///< condition.
};

/// Green, amber (χ̄ > 0.8, and does not slide) and red (slides).
EscalationTable default_levels();
/// Reads a table. Where its first level has a condition, a level of cases without a level precedes
/// it. Throws InputError with all that is wrong with the file; conditions are read where they are
/// asked of a campaign.
EscalationTable read_levels(const std::string& path);

/// What is known of a case's level, for each level: a case is at the most severe one whose
/// condition holds. It is at a level for certain where no other is possible; as computed at the
/// first from the most severe one on whose condition came out true.
/// @param conditions  of each level, in the order of the table; of the first `yes`.
std::vector<Held> levels_held(const std::vector<Held>& conditions);

}  // namespace faultsweep
