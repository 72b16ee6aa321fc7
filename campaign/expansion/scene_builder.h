#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "campaign/expansion/rows.h"
#include "simulator/scene/read_scene.h"

namespace faultsweep {

/// A number as the scene spells it: 0.83, "20000000 Pa". Reading it back gives the same bits.
nlohmann::json spelled(double si, faultsim::Dimension dimension);

/// The changes of a row, parameters first, then derived.
std::vector<Change> changes_of_row(const CampaignSpec& spec, const Group& group, const Row& row,
                                   const std::vector<double>& derived);

/// Turns rows of one group into scenes, and problems of a scene into problems of the spec.
class SceneBuilder {
 public:
  SceneBuilder(const CampaignSpec& spec, const Group& group);

  /// The checked scene of a row; problems (in terms of the spec) are appended, and then it is
  /// empty.
  std::optional<faultsim::Scene> scene(const Row& row, const std::vector<double>& derived,
                                       std::vector<faultsim::Problem>& problems);
  /// Puts a problem of a row's scene where the spec's author can mend it: the value in the design,
  /// in `set`, in `derived`, or the base scene.
  faultsim::Problem in_spec(const faultsim::Problem& problem, const Row& row) const;
  /// "offset = 100 m, friction_angle = 20 deg".
  std::string describe(const Row& row) const;

 private:
  void take_back_changes();

  const CampaignSpec& spec_;
  const Group& group_;
  faultsim::JsonDocument document_;  ///< the group's scene with the changes of the last row.
  std::set<std::string> changed_;    ///< members of it that hold changes.
};

}  // namespace faultsweep
