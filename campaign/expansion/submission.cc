#include "campaign/expansion/submission.h"
#include "campaign/common/json.h"

#include <algorithm>
#include <filesystem>
#include <future>
#include <map>

namespace faultsweep {

namespace {

/// The campaign's parameters: the union over the groups, in order of appearance.
class Columns {
 public:
  explicit Columns(const Expansion& expansion)
      : expansion_(expansion), places_(expansion.spec.groups.size()) {
    if (places_.size() > 1) of("group", faultsim::Dimension::number, true);
    for (const Case& one : expansion.cases) add(one);
  }
  CaseParameters values_of(const Case& one) const {
    CaseParameters values;
    auto place = places_[one.group].begin();
    for (ParameterValue& value : parameters_of(expansion_, one)) {
      if (parameters[*place].is_text) value.si.reset();
      values.push_back({*place++, value.si, std::move(value.text)});
    }
    if (places_.size() > 1)
      values.push_back({0, std::nullopt, expansion_.spec.groups[one.group].name});
    std::ranges::sort(values, {}, &CaseParameter::index);
    return values;
  }
  std::vector<StoredParameter> parameters;

 private:
  int of(const std::string& name, faultsim::Dimension dimension, bool is_text) {
    const auto [place, is_new] = by_name_.try_emplace(name, static_cast<int>(parameters.size()));
    if (is_new) parameters.push_back({name, dimension, is_text});
    return place->second;
  }
  void add(const Case& one) {
    const Group& group = expansion_.spec.groups[one.group];
    std::vector<int>& places = places_[one.group];
    const bool is_first = places.empty();
    for (std::size_t p = 0; p < group.parameters.size(); ++p) {
      const Parameter& parameter = group.parameters[p];
      const bool is_text = !parameter.si(one.choices[p]);
      if (is_first) places.push_back(of(parameter.name, parameter.dimension, is_text));
      if (is_text) parameters[places[p]].is_text = true;  // if only in some of the cases
    }
    for (const Derived& derived : expansion_.spec.derived) {
      if (is_first) places.push_back(of(derived.name, derived.dimension, false));
    }
  }

  const Expansion& expansion_;
  std::vector<std::vector<int>> places_;  ///< in `parameters`, per group and parameter.
  std::map<std::string, int> by_name_;
};

/// Rows of all designs, or none: see schemas/store_5.sql.
std::vector<DesignRow> design_rows(const Expansion& expansion) {
  std::vector<DesignRow> all;
  for (std::size_t g = 0; g < expansion.case_of_row.size(); ++g) {
    const std::vector<int>& rows = expansion.case_of_row[g];
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (rows[i] < 0) continue;
      all.push_back({static_cast<int>(g), static_cast<long>(i) + 1, rows[i] + 1});
    }
  }
  const auto& groups = expansion.spec.groups;
  const bool sampled = std::ranges::any_of(groups, [](const Group& group) {
    return std::ranges::any_of(group.designs,
                               [](const Design& one) { return is_sampled(one.kind); });
  });
  return sampled || all.size() != expansion.cases.size() ? all : std::vector<DesignRow>();
}

}  // namespace

Submission make_submission(const Expansion& expansion, CaseDetail cases) {
  const CampaignSpec& spec = expansion.spec;
  Submission submission;
  submission.name = spec.name;
  submission.source = spec.source;
  submission.spec_given = spec.given;
  submission.spec_resolved = spec.resolved();
  submission.rank_by = spec.rank_by;
  submission.policy = spec.policy;
  submission.keep_fields = spec.keep_fields;
  submission.n_merged = expansion.n_merged;
  for (const ExcludedCases& excluded : expansion.excluded)
    submission.n_excluded += excluded.n_cases;
  const std::string source =
      std::filesystem::absolute(spec.scene_source).lexically_normal().string();
  for (const Group& group : spec.groups) submission.scenes.push_back({source, group.scene.dump()});
  for (const Family& family : expansion.families) {
    submission.families.push_back({family.fingerprint, family.plan->n_unknowns, family.plan->n_jump,
                                   family.plan->operator_seconds, family.plan->memory_bytes,
                                   1 + static_cast<int>(family.plan->creep.rungs.size())});
  }
  const Columns columns(expansion);
  submission.cases.resize(expansion.cases.size());
  const auto record = [&](std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k) {
      const Case& one = expansion.cases[k];
      submission.cases[k] = {one.identity, one.family, one.group, {}, {}};
      if (cases == CaseDetail::identity) continue;
      submission.cases[k].changes = changes_of(expansion, one).dump();
      submission.cases[k].parameters = columns.values_of(one);
    }
  };
  const std::size_t half = expansion.cases.size() / 2;
  std::future<void> other = std::async(std::launch::async, record, 0, half);
  record(half, expansion.cases.size());
  other.get();
  submission.design_rows = design_rows(expansion);
  submission.parameters = columns.parameters;
  return submission;
}

Submission without_shown_fields(Submission submission) {
  if (submission.keep_fields == KeepFields::shown) submission.keep_fields = KeepFields::none;
  return submission;
}

}  // namespace faultsweep
