#pragma once

#include <optional>
#include <string>
#include <vector>

#include "campaign/common/json.h"
#include "campaign/pillars/pillar_campaign.h"
#include "simulator/scene/field_depths.h"
#include "simulator/scene/scene.h"

/// Inside of the room: the scene of a section across a fault, from a pillar's line.
namespace faultsweep {

/// A parameter of the scene in all cases.
struct Setting {
  std::string pointer, unit;  ///< "date": see below.
  double value = 0;
  std::string heading = {};  ///< of the table's column that it is of; "" = it follows from several.
  std::string date = {};     ///< in place of the value.

  json in_scene() const;
  std::string in_table() const;
};

/// What a section is made of, from the base scene where the table does not say.
class Section {
 public:
  /// Throws InputError where the scene is not one of two blocks with a fault between.
  Section(const faultsim::Scene& base, const faultsim::JsonDocument& document);
  /// Throws InputError where histories of pillars end at dates, and the last stage does not.
  void require_date(const PillarTable& table) const;
  /// Of a pillar, all but its place in flow results and the table's other parameters.
  std::vector<Setting> settings(const PillarTable& table, std::size_t pillar,
                                const std::optional<RegionalStress>& stress) const;
  /// Between strike and the largest horizontal stress, rad.
  static double angle_to(const RegionalStress& stress, const PillarTable& table,
                         std::size_t pillar);

 private:
  const faultsim::Scene& base_;
  std::size_t layer_ = 0;  ///< of the reservoir.
  faultsim::DepthInterval reservoir_;
  std::string last_stage_;  ///< pointer.
  bool ends_at_date_ = false;
};

}  // namespace faultsweep
