#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "campaign/answers/sample.h"
#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/query/ranking.h"

namespace faultsweep {

namespace {

/// Kinds of designs whose rows are drawn.
const std::set<std::string> kRandomKinds = {"monte-carlo", "latin-hypercube", "sobol", "samples"};
constexpr const char* kGroupParameter = "group";  ///< of campaigns with several.

/// Whether some case is a row of several groups: its name of a group is then that of the first.
bool share_cases(const std::vector<DesignRow>& rows) {
  std::map<long, int> group_of;
  return std::ranges::any_of(rows, [&](const DesignRow& row) {
    return group_of.emplace(row.position, row.design).first->second != row.design;
  });
}

/// Names of the groups that the selected cases are of.
std::set<std::string> selected_groups(const Store& store, const CampaignInfo& campaign,
                                      const SampledCases& cases) {
  const auto parameter =
      std::ranges::find(campaign.parameters, std::string(kGroupParameter), &StoredParameter::name);
  const auto index = static_cast<int>(parameter - campaign.parameters.begin());
  const Selection selection = make_selection(store, campaign, cases.stage, cases.fault);
  std::set<std::string> names;
  store.for_each_case(campaign.id, case_query(campaign, selection, cases.where),
                      [&](const CaseRow& row) {
                        for (const CaseParameter& one : row.parameters)
                          if (one.index == index) names.insert(one.text);
                      });
  return names;
}

/// The groups that the answer is about: all, unless a condition leaves some out.
std::vector<json> asked_groups(const Store& store, const CampaignInfo& campaign, const json& spec,
                               const SampledCases& cases) {
  auto groups = spec.at("groups").get<std::vector<json>>();
  if (groups.size() < 2 || cases.where.empty()) return groups;
  if (share_cases(store.design_rows(campaign.id))) return groups;
  const std::set<std::string> names = selected_groups(store, campaign, cases);
  std::vector<json> chosen;
  for (const json& one : groups)
    if (names.contains(one.value("name", ""))) chosen.push_back(one);
  return chosen.empty() ? groups : chosen;
}

/// The numbers of the generator that a monte-carlo design takes: from, to; nothing where it is
/// another.
std::optional<std::pair<long, long>> drawn_numbers(const json& design) {
  if (design.at("kind") != "monte-carlo" || !design.contains("samples")) return std::nullopt;
  const auto of_each = static_cast<long>(design.at("parameters").size());
  const long first = design.value("first", 0L) * of_each;
  return std::pair(first, first + design.at("samples").get<long>() * of_each);
}

/// Whether two designs that are drawn at random have samples that depend on each other.
bool share_draws(const json& a, const json& b) {
  const bool a_is_file = a.at("kind") == "samples", b_is_file = b.at("kind") == "samples";
  if (a_is_file && b_is_file) return a.value("fingerprint", "") == b.value("fingerprint", "");
  if (a_is_file || b_is_file || a.value("seed", 1L) != b.value("seed", 1L)) return false;
  const auto of_a = drawn_numbers(a), of_b = drawn_numbers(b);
  return !of_a || !of_b || (of_a->first < of_b->second && of_b->first < of_a->second);
}

/// Sampling::dependence between groups that are drawn at random.
std::string dependence_between(const std::vector<json>& groups) {
  const auto name = [](const json& one) { return one.value("name", ""); };
  for (const json& one : groups)
    if (one.at("kind") == "sobol")
      return concat("group ", name(one), " is a sobol design, most rows of which repeat values");
  for (std::size_t b = 1; b < groups.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if (!share_draws(groups[a], groups[b])) continue;
      return concat("groups ", name(groups[a]), " and ", name(groups[b]), " have the same ",
                    groups[a].at("kind") == "samples" ? "file" : "seed");
    }
  }
  return "";
}

/// Sampling::dependence of these groups, each of which is drawn at random.
std::string row_dependence(const std::vector<json>& groups, std::size_t n_of_campaign,
                           bool are_apart) {
  for (const json& one : groups)
    if (one.at("kind") == "nested")
      return "in a nested design each row of one design goes with every row of the next";
  if (n_of_campaign == 1) return "";  // SampleRows leaves out what a sobol design repeats
  if (!are_apart) return dependence_between(groups);
  for (const json& one : groups) {
    const std::string alone = dependence_between({one});
    if (!alone.empty()) return alone;
  }
  return "";
}

/// What to know of the designs, in a sentence.
std::string design_remark(const std::set<std::string>& kinds, const Sampling& sampling) {
  const auto all_are = [&](const std::set<std::string>& these) {
    return std::ranges::includes(these, kinds);
  };
  if (!sampling.dependence.empty())
    return concat("The cases do not vary independently: ", sampling.dependence,
                  ". So shares are of these cases, not probabilities.");
  if (all_are({"places"}))
    return "Places are not a sample: shares are of these places, not probabilities.";
  if (all_are({"samples"})) {
    return "Samples of a file, taken as independent: for a correlated chain, intervals are too "
           "narrow.";
  }
  if (all_are({"latin-hypercube", "sobol"}))
    return "Samples are spread evenly: intervals are wider than necessary.";
  if (sampling.is_factorial)
    return "A grid: shares are of the values given, each counted equally, not probabilities.";
  if (!sampling.is_random)
    return "The cases were not drawn at random: shares are of these cases, not probabilities.";
  return "";
}

}  // namespace

Sampling sampling_of(const Store& store, const CampaignInfo& campaign, const SampledCases& cases,
                     bool groups_are_apart) {
  const json spec = json::parse(store.spec_copies(campaign.id).resolved);
  Sampling sampling;
  sampling.approximation = approximation_note(store, campaign);
  if (spec.contains("limits")) {
    sampling.remark =
        "Cases were chosen by the search for limits: shares are of the cases run, not "
        "probabilities.";
    return sampling;
  }
  const std::vector<json> groups = asked_groups(store, campaign, spec, cases);
  std::set<std::string> kinds;
  for (const json& group : groups)
    for (const json& design : designs_of_group(group)) kinds.insert(design.at("kind"));
  const bool is_drawn = std::ranges::includes(kRandomKinds, kinds);
  if (is_drawn) {
    const bool are_apart = groups_are_apart && !share_cases(store.design_rows(campaign.id));
    sampling.dependence = row_dependence(groups, spec.at("groups").size(), are_apart);
  }
  sampling.is_random = is_drawn && sampling.dependence.empty();
  sampling.is_factorial = kinds == std::set<std::string>{"grid"};
  sampling.remark = design_remark(kinds, sampling);
  if (sampling.is_random && campaign.n_excluded > 0) {
    sampling.remark +=
        concat(sampling.remark.empty() ? "" : " ", campaign.n_excluded,
               " rows of the design are excluded by the spec: probabilities are those of "
               "the rest.");
  }
  return sampling;
}

}  // namespace faultsweep
