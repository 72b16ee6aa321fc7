#include "campaign/expansion/families.h"

#include <algorithm>

#include "simulator/plan/geometry_check.h"

namespace faultsweep {

FamilyFinder::FamilyFinder(const CampaignSpec& spec, const Group& group, SceneBuilder& builder,
                           std::vector<Family>& families,
                           std::map<std::string, int>& by_fingerprint, Budget budget)
    : spec_(spec),
      group_(group),
      builder_(builder),
      families_(families),
      by_fingerprint_(by_fingerprint),
      budget_(budget) {
  find_relevant();
}

/// A parameter is irrelevant only if every target is a number known to leave the operator alone
/// *and* is listed as such; what is not listed (words, whole objects) may change anything.
void FamilyFinder::find_relevant() {
  const auto infos = faultsim::parameters({spec_.scene_source, group_.scene, spec_.base.lines});
  const auto may_matter = [&](const std::string& target) {
    const auto info = std::find_if(infos.begin(), infos.end(),
                                   [&](const auto& one) { return one.pointer == target; });
    return info == infos.end() || info->new_family;
  };
  for (const Parameter& parameter : group_.parameters) {
    relevant_.push_back(
        std::any_of(parameter.targets.begin(), parameter.targets.end(), may_matter));
  }
  for (const Derived& one : spec_.derived) {
    derived_relevant_.push_back(may_matter(one.scene_pointer));
  }
}

std::vector<std::string> FamilyFinder::drawn() const {
  std::vector<std::string> names;
  for (std::size_t p = 0; p < relevant_.size(); ++p) {
    if (relevant_[p] && group_.parameters[p].range) names.push_back(group_.parameters[p].name);
  }
  return names;
}

int FamilyFinder::family_of(const Row& row, const std::vector<double>& derived,
                            std::vector<faultsim::Problem>& problems) {
  std::vector<double> key;
  for (std::size_t p = 0; p < row.size(); ++p) {
    if (relevant_[p]) key.push_back(row[p]);
  }
  for (std::size_t d = 0; d < derived.size(); ++d) {
    if (derived_relevant_[d]) key.push_back(derived[d]);
  }
  const auto known = by_key_.find(key);
  if (known != by_key_.end()) return known->second;
  if (families_.size() >= budget_.most_planned) {
    const auto family = static_cast<int>(families_.size());
    families_.push_back({"not planned", families_.back().plan, {}});
    by_key_.emplace(std::move(key), family);
    return family;
  }
  const int family = plan_row(row, derived, problems);
  if (family >= 0 && !may_creep_) by_key_.emplace(std::move(key), family);
  return family;
}

int FamilyFinder::plan_row(const Row& row, const std::vector<double>& derived,
                           std::vector<faultsim::Problem>& problems) {
  const auto scene = builder_.scene(row, derived, problems);
  if (!scene) return -1;
  std::vector<faultsim::Problem> found;
  faultsim::Plan plan = faultsim::make_plan(*scene, found);
  may_creep_ =
      faultsim::has_viscous_material(*scene) && scene->numerics.creep != faultsim::Switch::off;
  const bool is_known = by_fingerprint_.count(plan.family) != 0;
  if (found.empty() && !is_known && plan.n_cells <= budget_.cells_to_check) {
    budget_.cells_to_check -= plan.n_cells;
    found = faultsim::geometry_problems(*scene, plan);
  }
  for (const auto& one : found) problems.push_back(builder_.in_spec(one, row));
  if (!found.empty()) return -1;
  const auto [place, is_new] =
      by_fingerprint_.emplace(plan.family, static_cast<int>(families_.size()));
  if (is_new)
    families_.push_back({plan.family, std::make_shared<const faultsim::Plan>(std::move(plan)), {}});
  return place->second;
}

}  // namespace faultsweep
