#include "campaign/expansion/expansion.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>

#include "campaign/expansion/case_values.h"
#include "campaign/expansion/composer.h"
#include "campaign/expansion/families.h"
#include "campaign/expansion/scene_builder.h"
#include "simulator/common/fingerprint.h"
#include "simulator/scene/read_scene.h"

namespace faultsweep {
namespace {

using faultsim::Problem;
using nlohmann::json;

constexpr long kRowsReadOneByOne = 400;    ///< beyond, identities are composed (composer.h).
constexpr std::size_t kChoicesTried = 64;  ///< per parameter; the extremes are among them.
constexpr int kMaximumWrongCases = 20;     ///< of cases wrong only as a combination.
constexpr std::size_t kMaximumProblems = 100;

class Expander {
 public:
  explicit Expander(CampaignSpec spec) { result_.spec = std::move(spec); }

  Expansion run() {
    for (const Group& group : result_.spec.groups) result_.n_designed += count_rows(group);
    for (const Exclusion& one : result_.spec.exclude) result_.excluded.push_back({one.text, 0});
    result_.case_of_row.resize(result_.spec.groups.size());
    for (std::size_t g = 0; g < result_.spec.groups.size(); ++g) expand_group(static_cast<int>(g));
    throw_problems();
    for (const Case& one : result_.cases) {
      result_.families[static_cast<std::size_t>(one.family)].cases.push_back(one.index);
    }
    if (result_.cases.empty()) {
      problems_.push_back({"/design", result_.spec.document.line_of("/design"),
                           "no case is left of " + std::to_string(result_.n_designed),
                           "every case is excluded; loosen exclude"});
      throw_problems();
    }
    write_notes();
    return std::move(result_);
  }

 private:
  void throw_problems() {
    if (problems_.empty()) return;
    throw faultsim::InputError(result_.spec.source, problems_);
  }

  /// Adds problems that were not said before. True if there was a new one.
  bool add(const std::vector<Problem>& found) {
    bool any = false;
    for (const Problem& one : found) {
      if (problems_.size() >= kMaximumProblems) return any;
      if (!said_.insert(one.pointer + "\n" + one.what).second) continue;
      problems_.push_back(one);
      any = true;
    }
    return any;
  }

  void expand_group(int index) {
    const Group& group = result_.spec.groups[static_cast<std::size_t>(index)];
    SceneBuilder builder(result_.spec, group);
    const CaseValues values(result_.spec, group);
    if (!check_choices(group, builder, values)) return;
    FamilyFinder families(result_.spec, group, builder, result_.families, by_fingerprint_);
    const long n_rows = count_rows(group);
    std::optional<Composer> composer;
    if (n_rows > kRowsReadOneByOne) {
      std::vector<Problem> found;
      composer.emplace(result_.spec, group, builder, values);
      if (!composer->prepare(found)) composer.reset();
      add(found);
      if (!found.empty()) return;
    }
    std::vector<int>& case_of_row = result_.case_of_row[static_cast<std::size_t>(index)];
    case_of_row.assign(static_cast<std::size_t>(n_rows), -1);
    Row row;
    std::vector<double> derived;
    int n_wrong = 0;
    for (long i = 0; i < n_rows; ++i) {
      row_at(group, i, row);
      values.derive(row, derived);
      if (const int e = values.excluded_by(row, derived); e >= 0) {
        ++result_.excluded[static_cast<std::size_t>(e)].n_cases;
        continue;
      }
      std::vector<Problem> found;
      std::string identity;
      if (composer) identity = composer->identity(row, derived).value_or("");
      int& place = case_of_row[static_cast<std::size_t>(i)];
      place = add_case(index, row, derived, identity, builder, families, found);
      if (place < 0) {
        for (Problem& one : found) one.what += " (where " + builder.describe(row) + ")";
        add(found);
        if (++n_wrong < kMaximumWrongCases) continue;
        add({{group.pointer, result_.spec.document.line_of(group.pointer),
              "more combinations may be wrong: checking stopped after " + std::to_string(n_wrong),
              "exclude them or change the values"}});
        return;
      }
    }
  }

  /// Tries every choice once, in the first row of the design with that choice put in, so that a
  /// wrong value is reported once and not in each of 10^5 cases.
  bool check_choices(const Group& group, SceneBuilder& builder, const CaseValues& values) {
    if (group.kind != DesignKind::grid) return true;  // the others use each choice about once
    Row first;
    row_at(group, 0, first);
    std::vector<double> derived;
    bool ok = true;
    for (std::size_t p = 0; p < group.parameters.size(); ++p) {
      for (const int choice : sample_choices(group.parameters[p], kChoicesTried)) {
        if (p > 0 && choice == first[p]) continue;  // the first row itself, tried already
        Row row = first;
        row[p] = choice;
        values.derive(row, derived);
        if (values.excluded_by(row, derived) >= 0) continue;
        std::vector<Problem> found;
        if (builder.scene(row, derived, found)) continue;
        add(found);
        ok = false;
      }
    }
    return ok;
  }

  /// The index of the row's case, or -1 where problems were found.
  /// @param identity  of the row's scene; "" where the scene must be read to know it.
  int add_case(int group, const Row& row, const std::vector<double>& derived,
               const std::string& identity, SceneBuilder& builder, FamilyFinder& families,
               std::vector<Problem>& problems) {
    Case one;
    one.index = static_cast<int>(result_.cases.size());
    one.group = group;
    one.choices = row;
    one.derived = derived;
    one.identity = identity;
    if (identity.empty()) {
      const auto scene = builder.scene(row, derived, problems);
      if (!scene) return -1;
      one.identity = faultsim::case_identity(*scene);
    }
    const auto [known, is_new] = by_identity_.emplace(one.identity, one.index);
    if (!is_new) {
      ++result_.n_merged;
      if (first_merged_.empty()) {
        first_merged_ =
            builder.describe(row) + " is the same as case " + std::to_string(known->second + 1);
      }
      return known->second;
    }
    one.family = families.family_of(row, derived, problems);
    if (one.family < 0) return -1;
    result_.cases.push_back(std::move(one));
    return result_.cases.back().index;
  }

  void write_notes() {
    if (result_.n_merged > 0) {
      result_.notes.push_back(
          std::to_string(result_.n_merged) + (result_.n_merged == 1 ? " case is" : " cases are") +
          " the same as an earlier one and run once (the first: " + first_merged_ + ")");
    }
    for (const ExcludedCases& one : result_.excluded) {
      if (one.n_cases == 0) {
        result_.notes.push_back("nothing is excluded by \"" + one.reason + "\"");
      }
    }
  }

  Expansion result_;
  std::vector<Problem> problems_;
  std::set<std::string> said_;
  std::map<std::string, int> by_fingerprint_;
  std::unordered_map<std::string, int> by_identity_;
  std::string first_merged_;
};

const Group& group_of(const Expansion& expansion, const Case& one) {
  return expansion.spec.groups.at(static_cast<std::size_t>(one.group));
}

}  // namespace

Expansion expand(CampaignSpec spec) { return Expander(std::move(spec)).run(); }

std::vector<ParameterValue> parameters_of(const Expansion& expansion, const Case& one) {
  const Group& group = group_of(expansion, one);
  std::vector<ParameterValue> values;
  for (std::size_t p = 0; p < group.parameters.size(); ++p) {
    const Parameter& parameter = group.parameters[p];
    const int c = one.choices[p];
    const Choice& choice = c < 0 ? parameter.base : parameter.choices[static_cast<std::size_t>(c)];
    values.push_back({parameter.name, choice.text, choice.si, parameter.dimension});
  }
  for (std::size_t d = 0; d < one.derived.size(); ++d) {
    const Derived& derived = expansion.spec.derived[d];
    const json text = spelled(one.derived[d], derived.dimension);
    values.push_back({derived.name, text.is_string() ? text.get<std::string>() : text.dump(),
                      one.derived[d], derived.dimension});
  }
  return values;
}

nlohmann::json changes_of(const Expansion& expansion, const Case& one) {
  json result = json::object();
  const SceneBuilder builder(expansion.spec, group_of(expansion, one));
  for (const Change& change : builder.changes(one.choices, one.derived)) {
    result[change.pointer] = change.value;
  }
  return result;
}

nlohmann::json scene_of(const Expansion& expansion, const Case& one) {
  SceneBuilder builder(expansion.spec, group_of(expansion, one));
  return builder.document(one.choices, one.derived).value;
}

std::string base_fingerprint(const Expansion& expansion, int group) {
  return faultsim::fingerprint(
      expansion.spec.groups.at(static_cast<std::size_t>(group)).scene.dump());
}

nlohmann::json scene_from_changes(const std::string& base, const std::string& changes) {
  json scene = json::parse(base);
  const json changed = json::parse(changes);
  for (const auto& [pointer, value] : changed.items()) {
    FAULTSIM_DEMAND(put_value(scene, pointer, value), pointer);
  }
  return scene;
}

}  // namespace faultsweep
