#include "campaign/answers/posterior.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "campaign/answers/probability.h"
#include "campaign/report/table_output.h"
#include "campaign/report/text_table.h"

namespace faultsweep {

using faultsim::concat;
using faultsim::InputError;
using nlohmann::json;

namespace {

/// The cases as columns of rows.
struct WeightedRows {
  std::vector<WeightRange> weights;
  std::vector<std::vector<double>> values;      ///< per parameter: SI; NaN for words.
  std::vector<std::vector<std::string>> texts;  ///< per parameter that is words.
  std::vector<std::string> units;               ///< per parameter, as given for the first case.
  std::vector<std::vector<Holds>> holds;        ///< per condition.
  std::vector<double> of_complete;              ///< the weights of rows with a history to its end.
};

std::string unit_of_text(const std::string& text) {
  const std::size_t blank = text.rfind(' ');
  return blank == std::string::npos ? "" : text.substr(blank + 1);
}

/// Onsets and events by position, of those statements that speak of them.
std::map<long, CaseHistory> read_histories(const Store& store, const CampaignInfo& campaign,
                                           const SqlFragment& where,
                                           const std::vector<SeenStatement>& seen) {
  const auto any = [&](SeenStatement::Kind kind) {
    return std::any_of(seen.begin(), seen.end(),
                       [&](const SeenStatement& one) { return one.kind == kind; });
  };
  std::map<long, CaseHistory> histories;
  Store::TableQuery query;
  query.where = where;
  if (any(SeenStatement::Kind::slid)) {
    store.for_each_onset(campaign.id, query, [&](const CaseOnsets& one) {
      if (!one.onsets.empty()) histories[one.position].onsets = one.onsets;
    });
  }
  if (!any(SeenStatement::Kind::event)) return histories;
  bool has_magnitudes = true;
  store.for_each_slip_event(campaign.id, query, [&](const SeenEvent& one) {
    has_magnitudes = has_magnitudes && one.magnitude.has_value();
    histories[one.position].events.push_back(one);
  });
  if (!has_magnitudes) {
    throw InputError("--seen", {{"", 0, "events of cases in plane strain have no magnitude",
                                 "state a metric of theirs, such as event_stress_drop, or run the "
                                 "cases in three dimensions"}});
  }
  return histories;
}

class PosteriorReader {
 public:
  PosteriorReader(const Store& store, Posterior& posterior, const Selection& selection,
                  const std::vector<std::string>& conditions)
      : store_(store), posterior_(posterior) {
    const CampaignInfo& campaign = posterior.campaign;
    query_.where = parse_condition(posterior.request.where, campaign, selection);
    for (const SeenStatement& one : posterior.seen)
      if (!one.column.text.empty()) query_.columns.push_back(one.column);
    n_seen_columns_ = query_.columns.size();
    for (const std::string& one : conditions)
      query_.columns.push_back(parse_condition(one, campaign, selection));
    const std::size_t n_parameters = parameters_from_json(campaign.parameters).size();
    rows_.values.resize(n_parameters), rows_.texts.resize(n_parameters);
    rows_.units.resize(n_parameters), rows_.holds.resize(conditions.size());
  }

  WeightedRows read() {
    const auto histories =
        read_histories(store_, posterior_.campaign, query_.where, posterior_.seen);
    posterior_.agreement.assign(posterior_.seen.size(), 0);
    const SampleRows sample(store_, posterior_.campaign);
    static const CaseHistory kQuiet;
    store_.for_each_case(posterior_.campaign.id, query_, [&](const CaseRow& row) {
      const auto found = histories.find(row.position);
      const CaseHistory& history = found == histories.end() ? kQuiet : found->second;
      for (int k = 0; k < sample.count(row.position); ++k) add(row, history);
    });
    for (double& one : posterior_.agreement)
      one /= static_cast<double>(std::max(1L, posterior_.n_rows));
    return std::move(rows_);
  }

 private:
  void add(const CaseRow& row, const CaseHistory& history) {
    if (row.complete()) {
      ++posterior_.n_rows;
      const double weight = weight_of(row, history);
      rows_.weights.push_back({weight, weight});
      rows_.of_complete.push_back(weight);
    } else {
      ++posterior_.n_unknown;
      WeightRange weight = {1, 1};
      for (const SeenStatement& one : posterior_.seen) {
        const WeightRange p = likelihood_range(one, history);
        weight = {weight.least * p.least, weight.most * p.most};
      }
      rows_.weights.push_back(weight);
    }
    for (std::size_t c = 0; c < rows_.holds.size(); ++c) {
      rows_.holds[c].push_back(!row.complete()                                    ? Holds::unknown
                               : number_of(row.metrics[n_seen_columns_ + c]) == 1 ? Holds::yes
                                                                                  : Holds::no);
    }
    add_parameters(row);
  }

  /// Of a row with a history to its end; its agreement is counted.
  double weight_of(const CaseRow& row, const CaseHistory& history) {
    double weight = 1;
    std::size_t column = 0;
    for (std::size_t s = 0; s < posterior_.seen.size(); ++s) {
      const SeenStatement& one = posterior_.seen[s];
      const double value = one.column.text.empty() ? 0 : number_of(row.metrics[column++]);
      const double p = likelihood(one, history, value);
      posterior_.agreement[s] += p;
      weight *= p;
    }
    return weight;
  }

  void add_parameters(const CaseRow& row) {
    for (std::size_t p = 0; p < rows_.values.size(); ++p) {
      rows_.values[p].push_back(std::nan(""));
      rows_.texts[p].emplace_back();
    }
    for (const CaseParameter& one : row.parameters) {
      const auto p = static_cast<std::size_t>(one.index);
      if (one.si) rows_.values[p].back() = *one.si;
      if (one.si && rows_.units[p].empty()) rows_.units[p] = unit_of_text(one.text);
      if (!one.si) rows_.texts[p].back() = one.text;
    }
  }

  const Store& store_;
  Posterior& posterior_;
  Store::TableQuery query_;
  std::size_t n_seen_columns_ = 0;
  WeightedRows rows_;
};

void refuse_few(const Posterior& p) {
  if (p.effective_size >= kFewestEffective) return;
  const std::string what = concat(
      "what was seen leaves an effective sample of ", format_number(p.effective_size, 3), " of ",
      p.n_rows, " cases: below ", format_number(kFewestEffective), " a few would speak for all");
  std::string cure = "draw cases nearer to what was seen, or state the errors that it really has";
  if (p.effective_size >= 1) {
    const double needed = 1.2 * kFewestEffective / p.effective_size * static_cast<double>(p.n_rows);
    cure = concat("run about ", format_number(needed, 2), " cases; or ", cure);
  }
  throw InputError("posterior", {{"", 0, what, cure}});
}

std::vector<QuantileBounds> quantiles_of(const std::vector<double>& values,
                                         const std::vector<WeightRange>& weights,
                                         const std::vector<std::size_t>& order, double confidence) {
  std::vector<QuantileBounds> found;
  for (const double q : kPosteriorQuantiles)
    found.push_back(weighted_quantile(values, weights, order, q, confidence));
  return found;
}

/// A parameter of which every row has a number.
ParameterUpdate update_of(const StoredParameter& parameter, std::vector<double> values,
                          const std::string& unit, const std::vector<WeightRange>& weights,
                          double confidence) {
  ParameterUpdate update{parameter.name, unit, {}, {}};
  if (!unit.empty()) {
    for (double& one : values) one = faultsim::from_si(one, parameter.dimension, unit);
  }
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  const std::vector<WeightRange> equal(values.size(), {1, 1});
  update.before = quantiles_of(values, equal, order, confidence);
  update.after = quantiles_of(values, weights, order, confidence);
  return update;
}

Update update_of(const std::string& label, const std::vector<Holds>& holds,
                 const std::vector<WeightRange>& weights, double confidence) {
  const std::vector<WeightRange> equal(holds.size(), {1, 1});
  return {label, weighted_probability(holds, equal, confidence),
          weighted_probability(holds, weights, confidence)};
}

void update_parameters(Posterior& p, const WeightedRows& rows) {
  const std::vector<StoredParameter> all = parameters_from_json(p.campaign.parameters);
  const double confidence = p.request.confidence;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const std::vector<double>& values = rows.values[k];
    const bool are_numbers =
        std::none_of(values.begin(), values.end(), [](double one) { return std::isnan(one); });
    if (are_numbers) {
      const auto [low, high] = std::minmax_element(values.begin(), values.end());
      if (*low < *high)
        p.parameters.push_back(update_of(all[k], values, rows.units[k], rows.weights, confidence));
      continue;
    }
    std::map<std::string, std::vector<Holds>> words;
    for (const std::string& text : rows.texts[k]) words[text];
    if (words.size() < 2) continue;
    for (auto& [word, holds] : words) {
      for (const std::string& text : rows.texts[k])
        holds.push_back(text == word ? Holds::yes : Holds::no);
      p.words.push_back(update_of(concat(all[k].name, " = ", word.empty() ? "not given" : word),
                                  holds, rows.weights, confidence));
    }
  }
}

}  // namespace

Posterior find_posterior(const Store& store, const CampaignInfo& campaign,
                         const PosteriorRequest& request) {
  const Selection selection = make_selection(store, campaign, "", "");
  Posterior found;
  found.campaign = campaign;
  found.request = request;
  found.sampling = sampling_of(store, campaign);
  found.seen = read_seen(request.seen, campaign, selection);
  const std::vector<std::string> conditions =
      request.conditions.empty() ? default_conditions(selection) : request.conditions;
  const WeightedRows rows = PosteriorReader(store, found, selection, conditions).read();
  found.effective_size = effective_sample_size(rows.of_complete);
  refuse_few(found);
  update_parameters(found, rows);
  for (std::size_t c = 0; c < conditions.size(); ++c) {
    found.probabilities.push_back(
        update_of(conditions[c], rows.holds[c], rows.weights, request.confidence));
  }
  return found;
}

namespace {

std::string share_text(double share) { return concat(format_number(100 * share, 3), " %"); }

std::string updates_to_text(const std::string& header, const std::vector<Update>& updates) {
  TextTable table({header, "before", "after", "from", "to"});
  for (const Update& one : updates) {
    table.add_row({one.label, share_text(one.before.value), share_text(one.after.value),
                   share_text(one.after.bounds.low), share_text(one.after.bounds.high)});
  }
  return table.text();
}

std::string parameters_to_text(const std::vector<ParameterUpdate>& parameters) {
  TextTable table(
      {"parameter", "unit", "before 5 %", "50 %", "95 %", "after 5 %", "50 % after", "95 % after"});
  for (const ParameterUpdate& one : parameters) {
    std::vector<std::string> row = {one.name, one.unit};
    for (const auto* side : {&one.before, &one.after})
      for (const QuantileBounds& q : *side) row.push_back(format_number(q.estimate));
    table.add_row(row);
  }
  return table.text();
}

}  // namespace

std::string posterior_to_text(const Posterior& p) {
  TextTable seen({"seen", "agreement", ""});
  for (std::size_t s = 0; s < p.seen.size(); ++s) {
    seen.add_row(
        {p.seen[s].text, share_text(p.agreement[s]), p.seen[s].is_exact() ? "taken as exact" : ""});
  }
  std::string text = concat(seen.text(), "\nEffective sample size ",
                            format_number(p.effective_size, 4), " of ", p.n_rows, " cases");
  if (p.n_unknown > 0) {
    text +=
        concat("; of ", p.n_unknown, " without a history to ", p.n_unknown == 1 ? "its" : "their",
               " end it is not known:\nestimates are of the others, bounds allow for any outcome");
  }
  text += "\n\n";
  if (!p.parameters.empty()) text += parameters_to_text(p.parameters) + "\n";
  if (!p.words.empty()) text += updates_to_text("parameter", p.words) + "\n";
  text += updates_to_text("condition", p.probabilities);
  text += concat("\nBounds hold what is after with a confidence of ",
                 format_number(100 * p.request.confidence, 4),
                 " %;\nwhat was seen is taken to have independent errors.\n");
  if (!p.sampling.remark.empty()) text += p.sampling.remark + "\n";
  return text;
}

namespace {

json to_json(const Estimate& one) {
  return {{"estimate", one.value}, {"low", one.bounds.low}, {"high", one.bounds.high}};
}

json to_json(const std::vector<QuantileBounds>& quantiles) {
  json list = json::array();
  for (std::size_t k = 0; k < quantiles.size(); ++k) {
    const QuantileBounds& one = quantiles[k];
    list.push_back({{"quantile", kPosteriorQuantiles[k]},
                    {"estimate", one.estimate},
                    {"low", one.low ? json(*one.low) : json()},
                    {"high", one.high ? json(*one.high) : json()}});
  }
  return list;
}

json to_json(const std::vector<Update>& updates) {
  json list = json::array();
  for (const Update& one : updates) {
    list.push_back(
        {{"label", one.label}, {"before", to_json(one.before)}, {"after", to_json(one.after)}});
  }
  return list;
}

}  // namespace

json posterior_to_json(const Posterior& p) {
  json seen = json::array(), parameters = json::array();
  for (std::size_t s = 0; s < p.seen.size(); ++s) {
    seen.push_back({{"statement", p.seen[s].text},
                    {"agreement", p.agreement[s]},
                    {"exact", p.seen[s].is_exact()}});
  }
  for (const ParameterUpdate& one : p.parameters) {
    parameters.push_back({{"name", one.name},
                          {"unit", one.unit},
                          {"before", to_json(one.before)},
                          {"after", to_json(one.after)}});
  }
  return {{"campaign", p.campaign.name},
          {"confidence", p.request.confidence},
          {"seen", seen},
          {"rows", p.n_rows},
          {"unknown", p.n_unknown},
          {"effective_sample_size", p.effective_size},
          {"parameters", parameters},
          {"words", to_json(p.words)},
          {"probabilities", to_json(p.probabilities)},
          {"remark", p.sampling.remark}};
}

}  // namespace faultsweep
