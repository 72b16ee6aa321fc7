#include "campaign/app/submission.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "campaign/report/parameters.h"

namespace faultsweep {

using nlohmann::json;

namespace {

/// Columns of the parameter vectors: the union over the groups, in order of appearance.
class Columns {
 public:
  std::size_t of(const std::string& name, faultsim::Dimension dimension, bool is_text) {
    const auto [place, is_new] = places_.try_emplace(name, parameters.size());
    if (is_new) {
      parameters.push_back({name, dimension, is_text});
    } else if (parameters[place->second].is_text != is_text) {
      parameters[place->second].is_text = true;  // numbers in one group, words in another
    }
    return place->second;
  }
  std::vector<StoredParameter> parameters;

 private:
  std::map<std::string, std::size_t> places_;
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
  const bool sampled = std::any_of(groups.begin(), groups.end(), [](const Group& group) {
    return std::any_of(group.designs.begin(), group.designs.end(),
                       [](const Design& one) { return is_sampled(one.kind); });
  });
  return sampled || all.size() != expansion.cases.size() ? all : std::vector<DesignRow>();
}

}  // namespace

Submission make_submission(const Expansion& expansion) {
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
  Columns columns;
  const bool has_groups = spec.groups.size() > 1;
  if (has_groups) columns.of("group", faultsim::Dimension::number, true);
  for (const Case& one : expansion.cases) {
    for (const ParameterValue& value : parameters_of(expansion, one)) {
      columns.of(value.name, value.dimension, !value.si);
    }
  }
  const std::size_t n_columns = columns.parameters.size();
  submission.cases.reserve(expansion.cases.size());
  for (const Case& one : expansion.cases) {
    std::vector<json> values(n_columns), labels(n_columns);
    if (has_groups) {
      values[0] = labels[0] = spec.groups[static_cast<std::size_t>(one.group)].name;
    }
    for (const ParameterValue& value : parameters_of(expansion, one)) {
      const std::size_t k = columns.of(value.name, value.dimension, !value.si);
      values[k] = columns.parameters[k].is_text ? json(value.text) : json(*value.si);
      labels[k] = value.text;
    }
    submission.cases.push_back({one.identity, one.family, one.group,
                                changes_of(expansion, one).dump(), json(values).dump(),
                                json(labels).dump()});
  }
  submission.design_rows = design_rows(expansion);
  submission.parameters = parameters_to_json(columns.parameters);
  return submission;
}

}  // namespace faultsweep
