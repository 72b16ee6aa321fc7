#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "campaign/store/store.h"

namespace faultsweep {

/// What became of the pillars of a campaign, in space.
struct FaultMap {
  /// A pillar and its panel: the fault where it crosses the two reservoirs. NaN: not known, as of
  /// refused pillars.
  struct Place {
    std::string id, fault;
    double x = 0, y = 0;                   ///< m, at the top of the panel.
    double azimuth = 0, dip = 0;           ///< deg; dips to the right of its strike.
    double top_depth = 0, base_depth = 0;  ///< m.
    std::string start_date = {};           ///< of time 0 of its history; "" = not known.
    long position = 0;                     ///< of its case in the campaign; 0 = it is refused.
    bool has_panel() const;                ///< its numbers are all known.
  };
  struct Property {
    std::string name, unit, meaning;
    std::vector<double> values;  ///< per place; NaN where there is none.
  };
  CampaignInfo campaign;
  std::int64_t fault = 0;  ///< id, of Store::faults: that of the sections.
  std::vector<Place> places;
  /// Per place; of the case: "converged", "failed", "waiting"; or "refused".
  std::vector<std::string> outcomes;
  std::vector<Property> properties;
  std::vector<std::string>
      first_dates;  ///< per place: when it slides first; "" = never, not known.
};

/// Puts the results of a pillar campaign where its pillars are.
/// @param places_file  places.csv of make_pillar_campaign. Throws InputError where it is not that
/// of
///                the campaign.
FaultMap make_fault_map(const Store& store, const CampaignInfo& campaign,
                        const std::filesystem::path& places_file);

/// A line for each pillar; numbers are rounded to 12 digits, texts as csv_name has them.
std::string fault_map_to_csv(const FaultMap& map);
/// VTK's unstructured grid in XML, for ParaView and ResInsight: a line down the panel of each
/// pillar, and quadrilaterals between one pillar and the next of the same fault; z up. Pillars
/// whose panel is not known are left out.
std::string fault_map_to_vtu(const FaultMap& map);
/// GOCAD triangulated surfaces with properties at their points, one of each fault with two pillars
/// or more; z is depth, positive down, numbers as in CSV. Missing values are the file's
/// NO_DATA_VALUES.
std::string fault_map_to_tsurf(const FaultMap& map);

}  // namespace faultsweep
