#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "campaign/expansion/rows.h"
#include "simulator/reading/changed_scene.h"

namespace faultsweep {

/// The changes of a row, parameters first, then derived.
std::vector<Change> changes_of_row(const CampaignSpec& spec, const Group& group, const Row& row,
                                   const std::vector<double>& derived);

/// Turns rows of one group into scenes, and problems of a scene into problems of the spec.
class SceneBuilder {
 public:
  SceneBuilder(const CampaignSpec& spec, const Group& group);

  /// The scene of a row, until the next one; problems (in terms of the spec) are appended, and then
  /// it is null. Large designs trust the relations between values, which their extremes show.
  const faultsim::ChangedScene* scene(const Row& row, const std::vector<double>& derived,
                                      faultsim::Relations relations,
                                      std::vector<faultsim::Problem>& problems);
  /// Puts a problem of a row's scene where the spec's author can mend it: the value in the design,
  /// in `set`, in `derived`, or the base scene.
  faultsim::Problem in_spec(const faultsim::Problem& problem, const Row& row) const;
  /// "offset = 100 m, friction_angle = 20 deg".
  std::string describe(const Row& row) const;

 private:
  const CampaignSpec& spec_;
  const Group& group_;
  faultsim::JsonDocument base_;     ///< the group's scene.
  faultsim::ChangedScene changed_;  ///< that of the last row.
};

}  // namespace faultsweep
