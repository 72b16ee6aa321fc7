#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "campaign/spec/metrics.h"
#include "campaign/store/store.h"

/// Which cases, stages, faults and metrics a command is about.
namespace faultsweep {

/// What is asked about, of what there is in a campaign's results.
struct Selection {
  NamedId stage;                 ///< "" = the whole history.
  std::optional<NamedId> fault;  ///< none = all faults of a case together.
  std::vector<NamedId> stages, faults;
};
/// Throws InputError that names what there is, and the nearest, where stage or fault is unknown.
/// @param stage, fault  "" = the whole history, all faults.
Selection make_selection(const Store& store, const CampaignInfo& campaign, const std::string& stage,
                         const std::string& fault);
/// The option's InputError unless name is one of those.
void require_name(const std::string& option, const std::string& what, const std::string& name,
                  const std::vector<std::string>& names);

/// A metric as SQL. Its name says of what it is: "max_slip", "F2.max_slip in gas_storage".
struct ScopedMetric : MetricInfo {
  std::string sql;
  std::string spelled;  ///< the name as expressions and lists of metrics have it (spelled_name).
  std::string metric;   ///< its name in metric_catalogue().
  std::optional<MetricScope> scope;  ///< none = the row that the query goes along.
};
/// All metrics by name, synonyms too; those of faults and stages as the expressions spell them (see
/// Scopes). The whole history is the stage `whole_history`.
std::map<std::string, ScopedMetric> known_metrics(const Selection& selection);
/// What expressions over the results of a campaign may name: known_metrics, "outcome",
/// "activated_fault", "opened_fault", "unexpected_fault" and the campaign's parameters.
Symbols result_symbols(const CampaignInfo& campaign, const Selection& selection);
Scopes scopes_of(const Selection& selection);

/// --where as SQL; "" gives the empty fragment. Throws InputError.
SqlFragment parse_condition(const std::string& where, const CampaignInfo& campaign,
                            const Selection& selection);

/// The cases that `where` selects, "" = all, in the stage and of the fault of the selection, with
/// these metrics as columns. Throws InputError as parse_condition.
Store::TableQuery case_query(const CampaignInfo& campaign, const Selection& selection,
                             const std::string& where,
                             const std::vector<ScopedMetric>& metrics = {});

/// Half-width of the error of a metric, SI, by its name in metric_catalogue(). It holds for each
/// fault and stage.
using StatedErrors = std::map<std::string, double>;
/// The *largest* error that a trade measured, not the rms: a case may be the worst one. It is that
/// of the sample that was measured, not a bound. Of several bars of a metric the largest.
/// @param bars  of the tier of the cases in question.
StatedErrors stated_errors(const std::vector<ErrorBar>& bars);

/// Whether the value of a metric is not resolved (unresolved_sql), as a flag in its place.
ScopedMetric unresolved_flag(const ScopedMetric& metric, const Selection& selection);

/// A condition about a case as SQL. It is undecided where what it depends on is not resolved
/// (unresolved_sql: that is so of all results of a case that has none, or whose history ended
/// early) or within its error of a threshold; parameters are resolved and exact. Throws InputError.
VerdictSql parse_verdict(const std::string& condition, const CampaignInfo& campaign,
                         const Selection& selection, const StatedErrors& errors);

/// Whether the salt of any of its cases creeps.
bool creeps(const Store& store, const CampaignInfo& campaign);
/// "moment, F2.max_slip in gas_storage" as metrics, in this order, names of faults and stages with
/// commas in quotes, as in expressions; "" gives all (those of creep
/// only with_creep: they are slow to read), or, unless with_missing, those that every full history
/// has. Throws InputError with the nearest name.
std::vector<ScopedMetric> choose_metrics(const Selection& selection, const std::string& list,
                                         bool with_missing, bool with_creep);

/// "F1.chi_bar,F2.chi_bar", as choose_metrics takes it.
std::string of_each_fault(const std::vector<NamedId>& faults, const std::string& metric);

/// The option's InputError where results are missing: "no case has a result".
[[noreturn]] void refuse_unrun(const std::string& option, const std::string& what,
                               const CampaignInfo& campaign);

/// Of which kind the results are that `where` selects of the selection's stage and fault. Throws
/// InputError as parse_condition.
Store::Kinds kinds_of(const Store& store, const CampaignInfo& campaign, const Selection& selection,
                      const std::string& where);
/// Throws the option's InputError where `what`, an area, a potency or a moment, would be compared
/// between results per metre of strike and in total.
void refuse_mixed(const Store::Kinds& kinds, const std::string& option, const std::string& what);

}  // namespace faultsweep
