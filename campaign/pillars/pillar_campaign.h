#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "campaign/pillars/pillar_table.h"
#include "simulator/documents/json_document.h"

namespace faultsweep {

/// Directions of the horizontal stress of a region, where the ratios of a section depend on how its
/// fault strikes: with α the angle between strike and the largest horizontal stress,
///
///   M1 = m_h + (m_H − m_h) sin² α  across the fault,   M2 = m_h + (m_H − m_h) cos² α  along it.
///
/// Shear on the section, (m_H − m_h) sin α cos α, has no place in plane strain and is left out.
struct RegionalStress {
  double azimuth = 0;                ///< deg from north, of the largest one.
  double largest = 1, smallest = 1;  ///< m_H, m_h: effective, over the vertical one.
};

/// A pillar that cannot be modelled, in the words of the scene's checks.
struct RefusedPillar {
  std::string id;
  long line = 0;
  /// Pointer: the column of the table that it is about, as the table calls it; "" = of several or
  /// of none, and then the text says what of the scene it is about.
  std::vector<faultsim::Problem> problems;
};

/// A campaign with a case for each pillar that can be modelled, as texts of files.
struct PillarCampaign {
  std::string spec;     ///< campaign.json; names samples.csv and the scene.
  std::string samples;  ///< samples.csv: a line of scene parameters for each case.
  std::string places;   ///< places.csv: id, fault, place and panel of each pillar, for maps; of
                        ///< refused ones what is known, and why.
  std::size_t n_cases = 0;
  std::vector<RefusedPillar> refused;  ///< in order of lines.
  double largest_shear_left_out = 0;   ///< of RegionalStress, over the vertical effective stress.
};

/// @param scene_file  as campaign.json is to name it.
/// @param base        the scene: a field of two blocks, the western one the footwall, the eastern
///                    one the hanging wall; a section of it is each pillar's. Throws InputError
///                    where it is another.
/// @param progress    told the pillars looked at.
PillarCampaign make_pillar_campaign(const PillarTable& table, const faultsim::JsonDocument& base,
                                    const std::string& scene_file, const std::string& name,
                                    const std::optional<RegionalStress>& stress,
                                    const std::function<void(std::size_t)>& progress = nullptr);

}  // namespace faultsweep
