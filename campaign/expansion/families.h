#pragma once

#include <boost/container_hash/hash.hpp>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "campaign/expansion/expansion.h"
#include "campaign/expansion/row_reader.h"
#include "campaign/expansion/scene_builder.h"

namespace faultsweep {

/// What is to be known of a flow result, and of the first case in which it is so.
struct FieldRemark {
  std::string text, where;
};

/// What is found of families over all groups of a campaign.
struct FamiliesSoFar {
  std::vector<Family> families;  ///< in order of first use.
  std::unordered_map<std::string, int> by_fingerprint;
  /// Of meshes that may still be made to look at them (plan/geometry_check.h); counted down.
  long cells_to_check = 300'000;           // half a second
  std::size_t most_planned = 0;            ///< see expand.
  std::size_t n_planned = 0;               ///< plans made.
  std::size_t n_estimated = 0;             ///< families that have the plan of another one.
  std::vector<FieldRemark> field_remarks;  ///< each once (plan/field_check.h).

  /// Adds a remark unless it was said before.
  void say(const faultsim::Remark& remark, const std::string& where);
};

/// Finds the family of each row of one group, looking once at each distinct family key: the values
/// of the parameters that may change the linear bulk. The first kPlannedOneByOne keys of a group
/// are planned; of further families one in so many, so that some kPlannedOneByOne more are. The
/// others have their own fingerprint, and the plan of the last one planned.
/// A row that may creep is planned by itself: its steps are those of the stages, and whether it
/// creeps may depend on the loads.
class FamilyFinder {
 public:
  FamilyFinder(const CampaignSpec& spec, const Group& group, SceneBuilder& builder,
               const CaseValues& values, FamiliesSoFar& found);

  /// The index of the row's family. Problems of geometry and flow results are appended; then -1,
  /// without problems where those of the row's flow result have been said for another row.
  int family_of(ReadRow& read);
  /// Whether most of them are told by the fingerprints that rows have.
  bool are_many() const { return are_many_; }
  /// Names of parameters that may change the family and are drawn from ranges.
  std::vector<std::string> drawn() const;

  static constexpr long kPlannedOneByOne = 200;

 private:
  using Key = std::vector<double>;

  bool is_on_surface(const Parameter& parameter) const;
  void find_relevant();
  Key key_of(const Row& row, const std::vector<double>& derived) const;
  void add_estimated(const std::string& fingerprint);
  void check_extremes(std::vector<faultsim::Problem>& problems);
  std::string fingerprint_of(ReadRow& read);
  int plan_row(ReadRow& read);

  const CampaignSpec& spec_;
  const Group& group_;
  SceneBuilder& builder_;
  const CaseValues& values_;
  FamiliesSoFar& found_;
  std::vector<bool> makes_families_;  ///< per parameter: may change the family.
  /// Per parameter, then per derived one: may change the family, or where a flow result lies.
  std::vector<bool> relevant_;
  bool may_creep_ = false;  ///< the row planned last: its family takes more than a key.
  std::unordered_map<Key, int, boost::hash<Key>> by_key_;
  std::unordered_set<Key, boost::hash<Key>> refused_fields_;
  long n_keys_ = 0;        ///< looked at so far.
  long n_planned_ = 0;     ///< of this group.
  bool are_many_ = false;  ///< so many were planned that the others are told by fingerprints.
};

}  // namespace faultsweep
