#pragma once

#include <map>
#include <string>
#include <vector>

#include "campaign/expansion/rows.h"
#include "simulator/reading/read_scene.h"

namespace faultsweep {

/// Gives the names in a spec's expressions their values, case by case, for one group.
class CaseValues {
 public:
  /// Throws InputError where a value replaces the object around what a name stands for by one that
  /// has no such value.
  CaseValues(const CampaignSpec& spec, const Group& group);

  /// Computes the derived parameters of a row (SI); NaN where one has no value.
  void derive(const Row& row, std::vector<double>& derived) const;
  /// The first exclusion that is true, or -1.
  int excluded_by(const Row& row, const std::vector<double>& derived) const;

 private:
  /// Where a name's value comes from.
  struct Source {
    int derived = -1;            ///< index into CampaignSpec::derived, or
    int parameter = -1;          ///< index into the group's parameters, or neither:
    std::vector<Value> choices;  ///< of that parameter: value per choice, then
    const std::vector<DrawnValue>* drawn = nullptr;
    Value base;  ///< the value otherwise.
  };
  Source source_of(const std::string& name);
  std::vector<Source> sources_of(const Expression& expression);
  void follow_changes(const std::string& name, const std::string& pointer, Source& source);
  void refuse_lost(const std::string& name, const std::string& pointer, const Choice& choice,
                   const Change& change);
  static Value value_of(const Source& source, const Row& row, const std::vector<double>& derived);

  const CampaignSpec& spec_;
  const Group& group_;
  std::map<std::string, faultsim::ParameterInfo> infos_;  ///< by scene pointer.
  std::map<std::string, Value> base_;         ///< scene pointer -> value in the group's scene.
  std::vector<std::vector<Source>> derived_;  ///< per derived parameter and name.
  std::vector<std::vector<Source>> exclude_;  ///< per exclusion and name.
  std::vector<Problem> problems_;             ///< while these are found.
};

}  // namespace faultsweep
