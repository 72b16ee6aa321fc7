#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "campaign/spec/spec.h"
#include "simulator/plan/plan.h"

namespace faultsweep {

/// The value of one parameter in one case.
struct ParameterValue {
  std::string name;          ///< as in the spec.
  std::string text;          ///< as given: "100 m", "0.5", "mean".
  std::optional<double> si;  ///< SI; nothing for words.
  faultsim::Dimension dimension = faultsim::Dimension::number;
};

/// One case: small, because there may be 10^5. Its parameter vector and its scene are made on
/// demand by the functions below.
struct Case {
  int index = 0;                ///< from 0, in design order, without gaps.
  int group = 0;                ///< into CampaignSpec::groups.
  int family = 0;               ///< into Expansion::families.
  std::string identity;         ///< faultsim::case_identity of its scene.
  std::vector<int> choices;     ///< per parameter of the group: its value, numbered as there.
  std::vector<double> derived;  ///< SI, per CampaignSpec::derived.
};

/// The cases that share a linear bulk, hence an operator.
struct Family {
  std::string fingerprint;  ///< faultsim::Plan::family.
  /// Sizes and predicted cost: of its first case, or of the planned family before it.
  std::shared_ptr<const faultsim::Plan> plan;
  std::vector<int> cases;  ///< indices into Expansion::cases, ascending.
};

/// Cases left out by one `exclude` expression. A case counts for the first that is true.
struct ExcludedCases {
  std::string reason;  ///< the expression's text.
  long n_cases = 0;
};

/// A spec's cases, in design order. Pure: the same spec gives the same expansion.
struct Expansion {
  CampaignSpec spec;
  std::vector<Case> cases;
  std::vector<Family> families;  ///< in order of first use.
  /// Per group and row of its design: the index in `cases` of what it became (rows that are merged
  /// have the same), or -1 where it is excluded.
  std::vector<std::vector<int>> case_of_row;
  std::vector<ExcludedCases> excluded;  ///< per CampaignSpec::exclude.
  long n_designed = 0;                  ///< cases before exclusion and merging.
  long n_merged = 0;                    ///< cases dropped as the same as an earlier one.
  std::size_t n_planned = 0;            ///< plans made.
  std::vector<std::string> notes;       ///< what the user should know: merged cases, ...
};

/// Expands a spec. Throws InputError with all problems: values that the scene does not accept (each
/// once, however many cases use it), cases that are invalid only as a combination (the first few).
///
/// Up to 2000 rows of a group are checked one by one and 200 families are planned. Beyond that rows
/// are read without what relates their values (row_reader.h), families are told by their
/// fingerprints, and plans are made of 200 more families, spread over the design. Checked are each
/// value, of a parameter with more than 64 the extremes and a spread; of a grid every combination
/// of extremes; and the mesh of each family that is planned. A case that is wrong in a way that
/// none of these shows is found when it runs, and is then a failed case with its reason.
///
/// @param most_planned  plans to make. Families beyond are counted by their parameters and have no
///                      fingerprint of use: for a look at a campaign, not for a store.
Expansion expand(CampaignSpec spec,
                 std::size_t most_planned = std::numeric_limits<std::size_t>::max());

/// The parameter vector of a case: the group's parameters in order, then the derived ones.
std::vector<ParameterValue> parameters_of(const Expansion& expansion, const Case& one);

/// The case's differences from its group's scene: {"/json/pointer": value, ...}.
nlohmann::json changes_of(const Expansion& expansion, const Case& one);

/// The case's scene document: its group's scene with the changes put in. Relative paths in it
/// start from CampaignSpec::scene_source.
nlohmann::json scene_of(const Expansion& expansion, const Case& one);

/// The same from what a store keeps: the base scene's text and the text of changes_of.
nlohmann::json scene_from_changes(const std::string& base, const std::string& changes);

}  // namespace faultsweep
