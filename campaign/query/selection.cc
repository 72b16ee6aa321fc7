#include "campaign/query/selection.h"

#include <algorithm>
#include <utility>

#include "campaign/common/names.h"
#include "campaign/expression/expression.h"

namespace faultsweep {

namespace {

constexpr const char* kWholeHistory = "whole_history";

std::vector<std::string> names_of(const std::vector<NamedId>& all) {
  std::vector<std::string> names;
  for (const NamedId& one : all) {
    if (!one.name.empty()) names.push_back(one.name);
  }
  return names;
}

const NamedId* find(const std::vector<NamedId>& all, const std::string& name) {
  const auto found = std::ranges::find(all, name, &NamedId::name);
  return found == all.end() ? nullptr : &*found;
}

constexpr const char* kTexts[] = {"outcome", "activated_fault", "opened_fault", "unexpected_fault"};

Symbols symbols_of(const CampaignInfo& campaign, const std::map<std::string, ScopedMetric>& known) {
  Symbols symbols;
  symbols["case"] = {case_sql(), number_type({})};  // unless a parameter is called so
  int index = 0;
  for (const StoredParameter& parameter : campaign.parameters) {
    const Type type = parameter.is_text ? Type{Kind::text, {}} : number_type(parameter.dimension);
    symbols[parameter.name] = {parameter_sql(index++, parameter.is_text), type};
  }
  // After the parameters: a parameter that is called like a metric does not hide it.
  for (const auto& [name, metric] : known) {
    const Type type = metric.is_flag ? Type{Kind::boolean, {}} : number_type(metric.dimension);
    symbols[name] = {metric.sql, type};
  }
  for (const char* name : kTexts) symbols[name] = {metric_sql(name), Type{Kind::text, {}}};
  return symbols;
}

std::string unresolved_sql_of(const ScopedMetric& metric, const Selection& selection) {
  const MetricIds all = {mapped(selection.faults, &NamedId::id),
                         mapped(selection.stages, &NamedId::id)};
  return metric.scope ? unresolved_sql(metric.metric, all, *metric.scope, selection.stage.id)
                      : unresolved_sql(metric.metric, all, selection.fault.has_value());
}

/// Where the metrics among the names are not resolved, and how large their errors are.
void add_doubts(Symbols& symbols, const std::vector<std::string>& names,
                const std::map<std::string, ScopedMetric>& known, const Selection& selection,
                const StatedErrors& errors) {
  const MetricIds all = {mapped(selection.faults, &NamedId::id),
                         mapped(selection.stages, &NamedId::id)};
  for (const std::string& name : names) {
    if (contains(kTexts, name)) symbols[name].unresolved = unresolved_sql(name, all);
    const auto found = known.find(name);
    if (found == known.end()) continue;
    const ScopedMetric& metric = found->second;
    symbols[name].unresolved = unresolved_sql_of(metric, selection);
    const auto error = errors.find(metric.metric);
    if (error != errors.end()) symbols[name].error = error->second;
  }
}

/// @param option  that the condition is given with, for messages.
Expression read_condition(const std::string& option, const std::string& condition,
                          const Symbols& symbols, const Selection& selection) {
  Expression read = Expression::parse(condition, symbols, scopes_of(selection));
  if (read.type().kind != Kind::boolean) {
    throw InputError(option, concat("'", condition, "' is not a condition"),
                     "compare it with something: \"chi_bar > 0.8\"");
  }
  return read;
}

/// Names with commas between them, without the blanks around them and the quotes in which
/// expressions have what is not a word.
std::vector<std::string> names_in(const std::string& list) {
  std::vector<std::string> names(1);
  std::size_t solid = 0;  // of the name at hand: up to its last letter that is not a blank
  for (std::size_t i = 0; i < list.size(); ++i) {
    std::string& name = names.back();
    const bool may_quote = name.empty() || std::string_view(name).ends_with(" in ");
    if (may_quote && (list[i] == '"' || list[i] == '\'')) {
      const auto quoted = quoted_at(list, i);
      if (!quoted)
        throw InputError("--metrics", concat("this quote is not closed: ", list.substr(i)),
                         "add the closing quote");
      name += quoted->inside;
      i = quoted->end - 1;
      solid = name.size();
    } else if (list[i] == ',') {
      name.resize(solid);
      names.emplace_back();
      solid = 0;
    } else if (list[i] != ' ' || !name.empty()) {
      name += list[i];
      if (list[i] != ' ') solid = name.size();
    }
  }
  names.back().resize(solid);
  if (names.size() > 1 && names.back().empty()) names.pop_back();
  return names;
}

ScopedMetric metric_named(const std::string& name,
                          const std::map<std::string, ScopedMetric>& known) {
  const auto found = known.find(name);
  if (found != known.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [one, metric] : known) names.push_back(one);
  const auto meant = nearest(name, names);
  throw InputError("--metrics", concat("there is no metric '", name, "'"),
                   meant ? concat("did you mean '", *meant, "'?")
                         : "`faultsweep rank --list-metrics` lists them; for a fault "
                           "or stage write F2.max_slip in gas_storage");
}

}  // namespace

void require_name(const std::string& option, const std::string& what, const std::string& name,
                  const std::vector<std::string>& names) {
  if (contains(names, name)) return;
  throw InputError(option, concat("there is no ", what, " '", name, "' in the results"),
                   names.empty() ? concat("no case has a result with a ", what, " of its own yet")
                                 : cure_of_name(name, names));
}

Selection make_selection(const Store& store, const CampaignInfo& campaign, const std::string& stage,
                         const std::string& fault) {
  Selection selection;
  selection.stages = store.stages(campaign.id);
  selection.faults = store.faults(campaign.id);
  if (!stage.empty()) require_name("--stage", "stage", stage, names_of(selection.stages));
  if (const NamedId* found = find(selection.stages, stage)) selection.stage = *found;
  if (fault.empty()) return selection;
  require_name("--fault", "fault", fault, names_of(selection.faults));
  selection.fault = *find(selection.faults, fault);
  return selection;
}

std::map<std::string, ScopedMetric> known_metrics(const Selection& selection) {
  std::map<std::string, ScopedMetric> known;
  const auto add = [&](MetricInfo info, std::string name, std::string spelled,
                       std::optional<MetricScope> scope) {
    const bool of_fault = selection.fault && has_faults(info.name);
    std::string sql =
        scope ? metric_sql(info.name, *scope, selection.stage.id) : metric_sql(info.name, of_fault);
    std::string metric = std::exchange(info.name, name);
    known.insert_or_assign(std::move(name), ScopedMetric{info, std::move(sql), std::move(spelled),
                                                         std::move(metric), scope});
  };
  std::vector<std::pair<std::string, std::int64_t>> stages;  // as expressions name them
  for (const NamedId& stage : selection.stages) {
    stages.emplace_back(stage.name.empty() ? kWholeHistory : stage.name, stage.id);
  }
  for (const MetricInfo& metric : metric_catalogue()) {
    const bool of_fault = selection.fault && has_faults(metric.name);
    for (const std::string& name : {metric.name, metric.synonym}) {
      if (name.empty()) continue;
      add(metric, name, name, std::nullopt);
      if (!has_stages(metric.name)) continue;
      for (const auto& [stage, id] : stages) {
        const auto fault = of_fault ? std::optional(selection.fault->id) : std::nullopt;
        add(metric, concat(name, " in ", stage), concat(name, " in ", spelled_name(stage)),
            MetricScope{fault, id});
      }
      if (!has_faults(metric.name)) continue;
      for (const NamedId& fault : selection.faults) {
        const std::string spelled = concat(spelled_name(fault.name), ".", name);
        add(metric, concat(fault.name, ".", name), spelled, MetricScope{fault.id, std::nullopt});
        for (const auto& [stage, id] : stages) {
          add(metric, concat(fault.name, ".", name, " in ", stage),
              concat(spelled, " in ", spelled_name(stage)), MetricScope{fault.id, id});
        }
      }
    }
  }
  return known;
}

Symbols result_symbols(const CampaignInfo& campaign, const Selection& selection) {
  return symbols_of(campaign, known_metrics(selection));
}

Scopes scopes_of(const Selection& selection) {
  Scopes scopes{names_of(selection.faults), names_of(selection.stages)};
  scopes.stages.emplace_back(kWholeHistory);
  return scopes;
}

SqlFragment parse_condition(const std::string& where, const CampaignInfo& campaign,
                            const Selection& selection) {
  if (where.empty()) return {};
  return read_condition("--where", where, result_symbols(campaign, selection), selection).sql();
}

Store::TableQuery case_query(const CampaignInfo& campaign, const Selection& selection,
                             const std::string& where, const std::vector<ScopedMetric>& metrics) {
  Store::TableQuery query;
  query.stage = selection.stage.name;
  if (selection.fault) query.fault = selection.fault->id;
  query.where = parse_condition(where, campaign, selection);
  for (const ScopedMetric& one : metrics) query.columns.push_back({one.sql, {}});
  return query;
}

StatedErrors stated_errors(const std::vector<ErrorBar>& bars) {
  StatedErrors errors;
  for (const ErrorBar& bar : bars) errors[bar.metric] = std::max(errors[bar.metric], bar.largest);
  return errors;
}

ScopedMetric unresolved_flag(const ScopedMetric& metric, const Selection& selection) {
  ScopedMetric flag = metric;
  flag.sql = concat("coalesce(", unresolved_sql_of(metric, selection), ", 0)");
  flag.dimension = Dimension::number;
  flag.is_flag = true;
  return flag;
}

VerdictSql parse_verdict(const std::string& condition, const CampaignInfo& campaign,
                         const Selection& selection, const StatedErrors& errors) {
  const auto known = known_metrics(selection);
  Symbols symbols = symbols_of(campaign, known);
  const Expression read = read_condition("condition", condition, symbols, selection);
  add_doubts(symbols, read.names(), known, selection, errors);
  return Expression::parse(condition, symbols, scopes_of(selection)).verdict_sql();
}

bool creeps(const Store& store, const CampaignInfo& campaign) {
  const auto families = store.family_progress(campaign.id);
  return std::ranges::any_of(families, [](const auto& family) { return family.n_operators > 1; });
}

std::vector<ScopedMetric> choose_metrics(const Selection& selection, const std::string& list,
                                         bool with_missing, bool with_creep) {
  const auto known = known_metrics(selection);
  std::vector<ScopedMetric> chosen;
  if (list.empty()) {
    for (const MetricInfo& metric : metric_catalogue()) {
      const bool fits = with_creep || !metric.name.starts_with("creep_");
      if (fits && (with_missing || !metric.may_be_missing)) chosen.push_back(known.at(metric.name));
    }
    return chosen;
  }
  for (const std::string& name : names_in(list)) chosen.push_back(metric_named(name, known));
  return chosen;
}

std::string of_each_fault(const std::vector<NamedId>& faults, const std::string& metric) {
  std::string names;
  for (const NamedId& one : faults)
    names += concat(names.empty() ? "" : ",", spelled_name(one.name), ".", metric);
  return names;
}

void refuse_unrun(const std::string& option, const std::string& what,
                  const CampaignInfo& campaign) {
  throw InputError(option, what, concat("run it: faultsweep run ", campaign.name));
}

Store::Kinds kinds_of(const Store& store, const CampaignInfo& campaign, const Selection& selection,
                      const std::string& where) {
  Store::RankingQuery query;
  query.stage = selection.stage.name;
  if (selection.fault) query.fault = selection.fault->id;
  query.where = parse_condition(where, campaign, selection);
  return store.kinds(campaign.id, query);
}

void refuse_mixed(const Store::Kinds& kinds, const std::string& option, const std::string& what) {
  if (!kinds.mixed()) return;
  throw InputError(
      option,
      concat(what,
             " is per metre of strike in the plane-strain cases and a total in the others:"
             " the two cannot be compared"),
      "choose one kind, --where plane_strain or --where \"not plane_strain\", or a metric other "
      "than an area, potency or moment, such as chi_bar or max_slip");
}

}  // namespace faultsweep
