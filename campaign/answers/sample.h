#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "campaign/query/parameters.h"
#include "campaign/query/selection.h"
#include "campaign/store/store.h"

/// What a campaign's cases answer when they are taken as a sample of its parameters.
namespace faultsweep {

/// Which cases, and of what.
struct SampledCases {
  std::string where = {};  ///< condition; "" = all cases.
  std::string stage = {};  ///< of metrics without a stage of their own; "" = the whole history.
  std::string fault = {};  ///< "" = all faults of a case together.
};

/// How the campaign's cases were chosen, and what follows for statistics.
struct Sampling {
  /// Drawn, each row independently of the others: shares are estimates of probabilities.
  bool is_random = false;
  bool is_factorial = false;  ///< every combination: shares are of the values given.
  /// Why rows that were drawn depend on each other, so that bounds which take them as independent
  /// would be too narrow; "" = they do not, or are not drawn.
  std::string dependence;
  std::string remark;         ///< what to know of it, in a sentence; "" = nothing.
  std::string approximation;  ///< of its results: approximation_note().
};
/// By the designs of the campaign's spec, of the groups that have a case which `cases` selects. Of
/// a sobol design only the rows of its two independent blocks are a sample. Rows of nested designs
/// share draws, as those of groups with the same seed do, and groups of sobol designs have other
/// rows too: these are no random samples, whatever they are of.
/// @param groups_are_apart  answers are of each group alone, as `--by group` has them.
/// Throws InputError as make_selection and parse_condition.
Sampling sampling_of(const Store& store, const CampaignInfo& campaign,
                     const SampledCases& cases = {}, bool groups_are_apart = false);

/// How often each case of a campaign is a row of its sample: more than once where rows were the
/// same case; in a sobol design as often as it is a row of block A or B.
class SampleRows {
 public:
  SampleRows(const Store& store, const CampaignInfo& campaign);
  int count(long position) const;

 private:
  int others_ = 1;           ///< of cases that are not a row of `design_rows`.
  std::vector<int> counts_;  ///< by position; -1 = another case.
};

/// The rows of a sample as columns of numbers.
struct Sample {
  std::vector<StoredParameter> parameters;  ///< those that vary and are chosen by its designs.
  std::vector<std::string> derived;         ///< that vary, but follow from these: left out.
  std::vector<std::vector<double>> x;       ///< per parameter: SI; words by their first place;
                                            ///< −∞ where a case's group does not have it.
  std::vector<ScopedMetric> outputs;
  std::vector<std::vector<double>> y;  ///< per output; NaN where a full history has no value.
  long n_rows = 0;                     ///< selected, with those that are left out.
  long n_without = 0;                  ///< left out: no result in the stage.
  long n_early = 0;                    ///< left out: the history ends early.
  long n_unresolved = 0;  ///< kept: complete, but an activation or event depends on the mesh.
};

/// Throws InputError as make_selection, parse_condition and choose_metrics.
Sample read_sample(const Store& store, const CampaignInfo& campaign, const SampledCases& request,
                   std::vector<ScopedMetric> outputs);
/// @param metrics  names with commas, as of `export --metrics`.
Sample read_sample(const Store& store, const CampaignInfo& campaign, const SampledCases& request,
                   const std::string& metrics);
/// All rows of the design, in its order: those without a history to its end too, with NaN for
/// outputs, and all parameters but those that follow from others.
Sample read_design(const Store& store, const CampaignInfo& campaign, const Selection& selection,
                   std::vector<ScopedMetric> outputs);

// Inside of the module: how the cases of a stored campaign were designed
// ---------------------------

/// The designs of its resolved spec, those within nested ones too.
std::vector<nlohmann::json> designs_of(const Store& store, const CampaignInfo& campaign);

/// The same of one of its groups.
std::vector<nlohmann::json> designs_of_group(const nlohmann::json& group);

/// What designs of a campaign choose: by index in its parameters, 1 where one follows from others
/// (`derived` of the spec), so that it explains nothing of its own; 2 where it is the name of a
/// place, which explains all and nothing.
std::vector<char> derived_parameters(const std::vector<nlohmann::json>& designs,
                                     const CampaignInfo& campaign);
/// The parameter that names the cases of a campaign, each a place; "" = they have no names.
std::string names_parameter(const Store& store, const CampaignInfo& campaign);
/// "Computed from others, so not told apart from them: throw."; "" where there are none.
std::string derived_note(const std::vector<std::string>& names);

/// Of a sobol design, a group's only one: from one base sample to the next.
long rows_per_base_sample(const nlohmann::json& design);

}  // namespace faultsweep
