#include "campaign/expansion/families.h"

#include <algorithm>

#include "campaign/common/json.h"
#include "campaign/expansion/extreme_rows.h"
#include "simulator/plan/field_check.h"
#include "simulator/plan/geometry_check.h"

namespace faultsweep {

FamilyFinder::FamilyFinder(const CampaignSpec& spec, const Group& group, SceneBuilder& builder,
                           const CaseValues& values, FamiliesSoFar& found)
    : spec_(spec), group_(group), builder_(builder), values_(values), found_(found) {
  find_relevant();
}

void FamiliesSoFar::say(const faultsim::Remark& remark, const std::string& where) {
  const std::string text = faultsim::remark_text(remark);
  const auto same = [&](const FieldRemark& one) { return one.text == text; };
  if (std::ranges::none_of(field_remarks, same)) field_remarks.push_back({text, where});
}

namespace {

/// Where a flow result lies is looked at with the plan.
bool places_a_field(const std::string& target) {
  return target.rfind("/pressure_field", 0) == 0 || target.rfind("/temperature_field", 0) == 0;
}

}  // namespace

bool FamilyFinder::is_on_surface(const Parameter& parameter) const {
  const json* over = faultsim::value_at(group_.scene, "/numerics/surface/over");
  return over != nullptr && std::ranges::any_of(*over, [&](const json& one) {
           return one.is_object() && contains(parameter.targets, one.value("parameter", ""));
         });
}

/// A parameter is irrelevant only if every target is a number known to leave the operator alone
/// *and* is listed as such; what is not listed (words, whole objects) may change anything.
void FamilyFinder::find_relevant() {
  const auto infos = faultsim::parameters({spec_.scene_source, group_.scene, spec_.base.lines});
  const auto may_matter = [&](const std::string& target) {
    const auto info = std::ranges::find(infos, target, &faultsim::ParameterInfo::pointer);
    return info == infos.end() || info->new_family;
  };
  for (const Parameter& parameter : group_.parameters) {
    const auto& targets = parameter.targets;
    makes_families_.push_back(std::ranges::any_of(targets, may_matter));
    relevant_.push_back(makes_families_.back() || std::ranges::any_of(targets, places_a_field));
  }
  // An offset is taken in intervals, some of which have no surface: whatever moves an exact
  // operator makes families there.
  bool takes_intervals = false;
  for (std::size_t p = 0; p < group_.parameters.size(); ++p)
    takes_intervals |= makes_families_[p] && is_on_surface(group_.parameters[p]);
  for (std::size_t p = 0; takes_intervals && p < group_.parameters.size(); ++p)
    if (is_on_surface(group_.parameters[p])) relevant_[p] = true;
  for (const Derived& one : spec_.derived) {
    relevant_.push_back(may_matter(one.scene_pointer) || places_a_field(one.scene_pointer));
  }
}

std::vector<std::string> FamilyFinder::drawn() const {
  // An offset that is taken in intervals makes a family for each, not for each value.
  std::vector<std::string> names;
  for (std::size_t p = 0; p < group_.parameters.size(); ++p) {
    const Parameter& one = group_.parameters[p];
    if (makes_families_[p] && one.range && !is_on_surface(one)) names.push_back(one.name);
  }
  return names;
}

FamilyFinder::Key FamilyFinder::key_of(const Row& row, const std::vector<double>& derived) const {
  Key key;
  for (std::size_t p = 0; p < row.size(); ++p) {
    if (relevant_[p]) key.push_back(row[p]);
  }
  for (std::size_t d = 0; d < derived.size(); ++d) {
    if (relevant_[row.size() + d]) key.push_back(derived[d]);
  }
  return key;
}

/// Plans rows with extreme values, before others are trusted.
void FamilyFinder::check_extremes(std::vector<faultsim::Problem>& problems) {
  std::vector<double> derived;
  for (const Row& row : extreme_rows(group_, values_, relevant_)) {
    values_.derive(row, derived);
    std::vector<faultsim::Problem> found, wrong;
    const auto* changed = builder_.scene(row, derived, faultsim::Relations::checked, found);
    if (changed != nullptr) faultsim::make_plan(changed->scene, wrong);
    for (const auto& one : wrong) found.push_back(builder_.in_spec(one, row));
    for (faultsim::Problem& one : found) {
      one.what += " (where " + builder_.describe(row) + ")";
      problems.push_back(one);
    }
  }
}

void FamilyFinder::add_estimated(const std::string& fingerprint) {
  found_.families.push_back({fingerprint, found_.families.back().plan, {}});
  ++found_.n_estimated;
}

int FamilyFinder::family_of(ReadRow& read) {
  Key key = key_of(read.row, read.derived);
  const auto known = by_key_.find(key);
  if (known != by_key_.end()) return known->second;
  if (refused_fields_.count(key) > 0) return -1;
  if (n_planned_ == kPlannedOneByOne && !are_many_ && !may_creep_) {
    are_many_ = true;
    check_extremes(read.problems);
  }
  if (!read.problems.empty()) return -1;
  const long stride = std::max(1L, count_rows(group_) / kPlannedOneByOne);
  int family = static_cast<int>(found_.families.size());
  const bool is_beyond = found_.n_planned >= found_.most_planned;
  if (are_many_ && (++n_keys_ % stride != 0 || is_beyond)) {
    const auto [place, is_new] = found_.by_fingerprint.emplace(fingerprint_of(read), family);
    family = place->second;
    if (is_new) add_estimated(place->first);
  } else if (is_beyond) {
    add_estimated("not planned");
  } else {
    family = plan_row(read);
  }
  if (family >= 0 && !may_creep_) by_key_.emplace(std::move(key), family);
  return family;
}

/// Rows that were read before families were many do not have it.
std::string FamilyFinder::fingerprint_of(ReadRow& read) {
  if (!read.family.empty()) return read.family;
  const auto* changed =
      builder_.scene(read.row, read.derived, faultsim::Relations::trusted, read.problems);
  FAULTSIM_DEMAND(changed != nullptr, builder_.describe(read.row));
  return faultsim::family_of(changed->scene);
}

int FamilyFinder::plan_row(ReadRow& read) {
  std::vector<faultsim::Problem>& problems = read.problems;
  const auto* changed =
      builder_.scene(read.row, read.derived, faultsim::Relations::trusted, problems);
  if (changed == nullptr) return -1;
  const faultsim::Scene& scene = changed->scene;
  std::vector<faultsim::Problem> wrong;
  faultsim::Plan plan = faultsim::make_plan(scene, wrong);
  ++n_planned_;
  ++found_.n_planned;
  may_creep_ =
      faultsim::has_viscous_material(scene) && scene.numerics.creep != faultsim::Switch::off;
  const bool is_known = found_.by_fingerprint.count(plan.family) != 0;
  if (wrong.empty() && !is_known && plan.n_cells <= found_.cells_to_check) {
    found_.cells_to_check -= plan.n_cells;
    wrong = faultsim::geometry_problems(scene, plan);
  }
  if (wrong.empty()) {
    const faultsim::FieldCheck fields = faultsim::check_fields(scene, plan);
    wrong = fields.problems;
    if (!wrong.empty()) refused_fields_.insert(key_of(read.row, read.derived));
    for (const faultsim::Remark& one : fields.remarks) found_.say(one, builder_.describe(read.row));
  }
  for (const auto& one : wrong) problems.push_back(builder_.in_spec(one, read.row));
  if (!wrong.empty()) return -1;
  const auto [place, is_new] =
      found_.by_fingerprint.emplace(plan.family, static_cast<int>(found_.families.size()));
  if (is_new) {
    found_.families.push_back(
        {plan.family, std::make_shared<const faultsim::Plan>(std::move(plan)), {}});
  }
  return place->second;
}

}  // namespace faultsweep
