#pragma once

#include <map>
#include <string>
#include <vector>

#include "campaign/expansion/expansion.h"
#include "campaign/expansion/scene_builder.h"

namespace faultsweep {

/// Finds the family of each row of one group, making a plan once per distinct family key: the
/// values of the parameters that may change the linear bulk. A row that may creep is planned by
/// itself: its steps are those of the stages, and whether it creeps may depend on the loads.
class FamilyFinder {
 public:
  /// @param families  those found so far, in all groups; new ones are added.
  struct Budget {
    long& cells_to_check;      ///< of meshes that may still be made to look at them
                               ///< (plan/geometry_check.h); counted down.
    std::size_t most_planned;  ///< families; see expand.
  };
  FamilyFinder(const CampaignSpec& spec, const Group& group, SceneBuilder& builder,
               std::vector<Family>& families, std::map<std::string, int>& by_fingerprint,
               Budget budget);

  /// The index of the row's family. Problems of the geometry are appended; then -1.
  int family_of(const Row& row, const std::vector<double>& derived,
                std::vector<faultsim::Problem>& problems);
  /// Names of parameters that may change the family and are drawn from ranges.
  std::vector<std::string> drawn() const;

 private:
  void find_relevant();
  int plan_row(const Row& row, const std::vector<double>& derived,
               std::vector<faultsim::Problem>& problems);

  const CampaignSpec& spec_;
  const Group& group_;
  SceneBuilder& builder_;
  std::vector<Family>& families_;
  std::map<std::string, int>& by_fingerprint_;
  Budget budget_;
  std::vector<bool> relevant_;          ///< per parameter: may change the family.
  std::vector<bool> derived_relevant_;  ///< per derived parameter.
  bool may_creep_ = false;              ///< the row planned last: its family takes more than a key.
  std::map<std::vector<double>, int> by_key_;
};

}  // namespace faultsweep
