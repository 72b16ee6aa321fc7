#include "campaign/answers/posterior.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "campaign/answers/probability.h"
#include "campaign/common/names.h"
#include "campaign/query/table_output.h"
#include "campaign/render/shown.h"

namespace faultsweep {

namespace {

/// The cases as columns of rows.
struct WeightedRows {
  std::vector<WeightRange> computed;            ///< weights: of full histories a number.
  std::vector<WeightRange> open;                ///< the same with what the cells leave open.
  std::vector<std::vector<double>> values;      ///< per parameter: SI; NaN for words.
  std::vector<std::vector<std::string>> texts;  ///< per parameter that is words.
  std::vector<std::string> units;               ///< per parameter, as given for the first case.
  std::vector<std::vector<Held>> held;          ///< per condition.
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
    return contains(seen, kind, &SeenStatement::kind);
  };
  std::map<long, CaseHistory> histories;
  Store::TableQuery query;
  query.where = where;
  if (any(SeenStatement::Kind::slid)) {
    store.for_each_onset(campaign.id, query, [&](const CaseOnsets& one) {
      if (one.onsets.empty() && one.unresolved.empty()) return;
      histories[one.position].onsets = one.onsets;
      histories[one.position].unresolved = one.unresolved;
    });
  }
  if (!any(SeenStatement::Kind::event)) return histories;
  bool has_magnitudes = true;
  store.for_each_slip_event(campaign.id, query, [&](const SeenEvent& one) {
    has_magnitudes = has_magnitudes && one.magnitude.has_value();
    histories[one.position].events.push_back(one);
  });
  if (!has_magnitudes) {
    throw InputError("--seen", "events of cases in plane strain have no magnitude",
                     "state a metric that they have, such as event_stress_drop, or run the "
                     "cases in three dimensions");
  }
  return histories;
}

/// The conditions of statements, then those asked about.
std::vector<std::string> all_conditions(const std::vector<SeenStatement>& seen,
                                        const std::vector<std::string>& asked) {
  std::vector<std::string> all;
  for (const SeenStatement& one : seen)
    if (!one.condition.empty()) all.push_back(one.condition);
  all.insert(all.end(), asked.begin(), asked.end());
  return all;
}

class PosteriorReader {
 public:
  PosteriorReader(const Store& store, Posterior& posterior, const Selection& selection,
                  const std::vector<std::string>& conditions)
      : store_(store),
        posterior_(posterior),
        verdicts_(store, posterior.campaign, selection,
                  all_conditions(posterior.seen, conditions)) {
    const CampaignInfo& campaign = posterior.campaign;
    query_ = case_query(campaign, selection, posterior.request.where);
    for (const SeenStatement& one : posterior.seen)
      if (!one.column.text.empty()) query_.columns.push_back(one.column);
    first_verdict_ = query_.columns.size();
    append(query_.columns, verdicts_.columns());
    first_asked_ = verdicts_.columns().size() - conditions.size();
    const std::size_t n_parameters = campaign.parameters.size();
    rows_.values.resize(n_parameters), rows_.texts.resize(n_parameters);
    rows_.units.resize(n_parameters), rows_.held.resize(conditions.size());
  }

  WeightedRows read() {
    auto histories = read_histories(store_, posterior_.campaign, query_.where, posterior_.seen);
    posterior_.agreement.assign(posterior_.seen.size(), 0);
    const SampleRows sample(store_, posterior_.campaign);
    store_.for_each_case(posterior_.campaign.id, query_, [&](const CaseRow& row) {
      CaseHistory& history = histories[row.position];
      history.events_resolved = row.outcome != to_string(faultsim::Outcome::unresolved_event);
      for (int k = 0; k < sample.count(row.position); ++k) add(row, history);
    });
    for (double& one : posterior_.agreement)
      one /= static_cast<double>(std::max(1L, posterior_.n_rows));
    return std::move(rows_);
  }

 private:
  void add(const CaseRow& row, const CaseHistory& history) {
    bool is_open = false;
    if (row.complete()) {
      ++posterior_.n_rows;
      add_weights(row, history, is_open);
    } else {
      ++posterior_.n_unknown;
      WeightRange weight = {1, 1};
      for (const SeenStatement& one : posterior_.seen) weight *= likelihood_range(one, history);
      rows_.computed.push_back(weight);
      rows_.open.push_back(weight);
    }
    for (std::size_t c = 0; c < rows_.held.size(); ++c) {
      const Held held = verdicts_.held(row, first_asked_ + c, first_verdict_);
      is_open = is_open || held == Held::undecided_no || held == Held::undecided_yes;
      rows_.held[c].push_back(held);
    }
    posterior_.n_undecided += is_open ? 1 : 0;
    add_parameters(row);
  }

  /// Of a row with a history to its end; its agreement is counted.
  void add_weights(const CaseRow& row, const CaseHistory& history, bool& is_open) {
    double computed = 1;
    WeightRange open = {1, 1};
    std::size_t column = 0, verdict = 0;
    for (std::size_t s = 0; s < posterior_.seen.size(); ++s) {
      const SeenStatement& one = posterior_.seen[s];
      double value = 0;
      Held held = Held::no;
      if (!one.column.text.empty()) value = number_of(row.metrics[column++]);
      if (!one.condition.empty()) {
        held = verdicts_.held(row, verdict++, first_verdict_);
        value = held == Held::yes || held == Held::undecided_yes ? 1 : 0;
      }
      const double p = likelihood(one, history, value);
      posterior_.agreement[s] += p;
      computed *= p;
      open *= likelihood_by_cells(one, history, value, held);
    }
    is_open = !open.is_known();
    rows_.computed.push_back({computed, computed});
    rows_.open.push_back(open);
    rows_.of_complete.push_back(computed);
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
  VerdictColumns verdicts_;
  Store::TableQuery query_;
  std::size_t first_verdict_ = 0;  ///< in a row's metrics.
  std::size_t first_asked_ = 0;    ///< among the verdicts.
  WeightedRows rows_;
};

void refuse_few(const Posterior& p) {
  if (p.effective_size >= kFewestEffective) return;
  const std::string what = concat(
      "the observations leave an effective sample of ", format_number(p.effective_size, 3), " of ",
      p.n_rows, " cases: below ", format_number(kFewestEffective), ", a few would stand for all");
  std::string cure = "draw cases closer to the observations, or state their true errors";
  if (p.effective_size >= 1) {
    const double needed = 1.2 * kFewestEffective / p.effective_size * static_cast<double>(p.n_rows);
    cure = concat("run about ", format_number(needed, 2), " cases; or ", cure);
  }
  throw InputError("posterior", what, cure);
}

/// Of the bounds of a sample; none where there is no sample: then what is open makes them.
using Confidence = std::optional<double>;
constexpr double kAny = 0.95;  ///< of estimates without bounds.

/// Estimates by the weights as computed, bounds by what they may be; of no sample none.
std::vector<QuantileBounds> quantiles_of(const std::vector<double>& values,
                                         const std::vector<WeightRange>& computed,
                                         const std::vector<WeightRange>& open,
                                         const std::vector<std::size_t>& order,
                                         Confidence confidence) {
  std::vector<QuantileBounds> found;
  const bool any_known = std::ranges::any_of(
      open, [](const WeightRange& one) { return one.is_known() && one.most > 0; });
  for (const double q : kPosteriorQuantiles) {
    found.push_back(weighted_quantile(values, computed, order, q, confidence.value_or(kAny)));
    const QuantileBounds bounds = any_known && confidence
                                      ? weighted_quantile(values, open, order, q, *confidence)
                                      : QuantileBounds{};
    found.back().low = bounds.low;
    found.back().high = bounds.high;
  }
  return found;
}

/// A parameter of which every row has a number.
ParameterUpdate update_of(const StoredParameter& parameter, std::vector<double> values,
                          const std::string& unit, const WeightedRows& rows,
                          Confidence confidence) {
  ParameterUpdate update{parameter.name, unit, {}, {}};
  if (!unit.empty()) {
    for (double& one : values) one = faultsim::from_si(one, parameter.dimension, unit);
  }
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order,
                           [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  const std::vector<WeightRange> equal(values.size(), {1, 1});
  update.before = quantiles_of(values, equal, equal, order, confidence);
  update.after = quantiles_of(values, rows.computed, rows.open, order, confidence);
  return update;
}

/// Between what the share of all weight with a property lies, as weights and property may be.
Interval open_range(const std::vector<Holds>& holds, const std::vector<WeightRange>& weights) {
  double yes = 0, no = 0, most_yes = 0, most_no = 0;
  for (std::size_t k = 0; k < holds.size(); ++k) {
    if (holds[k] == Holds::yes) yes += weights[k].least;
    if (holds[k] == Holds::no) no += weights[k].least;
    if (holds[k] != Holds::no) most_yes += weights[k].most;
    if (holds[k] != Holds::yes) most_no += weights[k].most;
  }
  return {yes > 0 ? yes / (yes + most_no) : 0, no > 0 ? most_yes / (most_yes + no) : 1};
}

/// The estimate as computed; the bounds over all that is open.
Estimate probability_of(const std::vector<Held>& held, const std::vector<WeightRange>& computed,
                        const std::vector<WeightRange>& open, Confidence confidence) {
  std::vector<Holds> as_computed, as_known;
  bool any_known = false;
  for (std::size_t k = 0; k < held.size(); ++k) {
    const bool is_yes = held[k] == Held::yes || held[k] == Held::undecided_yes;
    const bool is_known = held[k] == Held::yes || held[k] == Held::no;
    as_computed.push_back(held[k] == Held::unknown ? Holds::unknown
                          : is_yes                 ? Holds::yes
                                                   : Holds::no);
    as_known.push_back(is_known ? as_computed.back() : Holds::unknown);
    any_known = any_known || (is_known && open[k].is_known() && open[k].most > 0);
  }
  Estimate found = weighted_probability(as_computed, computed, confidence.value_or(kAny));
  found.bounds = {0, 1};
  if (!confidence) {
    found.bounds = open_range(as_known, open);
  } else if (any_known) {
    found.bounds = weighted_probability(as_known, open, *confidence).bounds;
  }
  return found;
}

Update update_of(const std::string& label, const std::vector<Held>& held, const WeightedRows& rows,
                 Confidence confidence) {
  const std::vector<WeightRange> equal(held.size(), {1, 1});
  return {label, probability_of(held, equal, equal, confidence),
          probability_of(held, rows.computed, rows.open, confidence)};
}

Confidence confidence_of(const Posterior& p) {
  return p.sampling.is_random ? Confidence(p.request.confidence) : std::nullopt;
}

void update_parameters(Posterior& p, const WeightedRows& rows) {
  const std::vector<StoredParameter>& all = p.campaign.parameters;
  const Confidence confidence = confidence_of(p);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const std::vector<double>& values = rows.values[k];
    const bool are_numbers =
        std::ranges::none_of(values, [](double one) { return std::isnan(one); });
    if (are_numbers) {
      const auto [low, high] = std::ranges::minmax_element(values);
      if (*low < *high)
        p.parameters.push_back(update_of(all[k], values, rows.units[k], rows, confidence));
      continue;
    }
    std::map<std::string, std::vector<Held>> words;
    for (const std::string& text : rows.texts[k]) words[text];
    if (words.size() < 2) continue;
    for (auto& [word, holds] : words) {
      for (const std::string& text : rows.texts[k])
        holds.push_back(text == word ? Held::yes : Held::no);
      p.words.push_back(update_of(concat(all[k].name, " = ", word.empty() ? "not given" : word),
                                  holds, rows, confidence));
    }
  }
}

AnswerTable seen_table(const Posterior& p) {
  AnswerTable table{"seen",
                    "",
                    {{"statement", "seen", {}, 4, Need::always},
                     {"agreement", "agreement", percent(), 3},
                     {"exact", "taken as exact"}}};
  for (std::size_t s = 0; s < p.seen.size(); ++s)
    table.rows.push_back({p.seen[s].text, p.agreement[s], p.seen[s].is_exact()});
  return table;
}

AnswerTable update_table(const char* key, const char* heading, const std::vector<Update>& updates) {
  AnswerTable table{key,
                    "",
                    {{"label", heading, {}, 4, Need::always},
                     {"before", "before", percent(), 3, Need::always},
                     {"before_low", "before, from", percent(), 3, Need::extra},
                     {"before_high", "before, to", percent(), 3, Need::extra},
                     {"after", "after", percent(), 3, Need::always},
                     {"after_low", "from", percent(), 3, Need::always},
                     {"after_high", "to", percent(), 3, Need::always}}};
  for (const Update& one : updates) {
    table.rows.push_back({one.label, one.before.value, one.before.bounds.low,
                          one.before.bounds.high, one.after.value, one.after.bounds.low,
                          one.after.bounds.high});
  }
  return table;
}

/// A row for each quantile of each parameter, in the parameter's unit.
AnswerTable parameter_table(const std::vector<ParameterUpdate>& parameters) {
  AnswerTable table{"parameters",
                    "",
                    {{"name", "parameter", {}, 4, Need::always},
                     {"unit", "unit", {}, 4, Need::always},
                     {"quantile", "share below", percent(), 3, Need::always},
                     {"before", "before", {}, 4, Need::always},
                     {"after", "after", {}, 4, Need::always},
                     {"after_low", "from", {}, 4},
                     {"after_high", "to", {}, 4}}};
  for (const ParameterUpdate& one : parameters) {
    for (std::size_t q = 0; q < one.after.size(); ++q) {
      table.rows.push_back({one.name, one.unit, kPosteriorQuantiles[q], one.before[q].estimate,
                            one.after[q].estimate, one.after[q].low, one.after[q].high});
    }
  }
  return table;
}

std::string headline_of(const Posterior& p) {
  const std::string sample =
      concat("The observations leave an effective sample of ", format_number(p.effective_size, 4),
             " of ", grouped(p.n_rows), " cases");
  if (p.probabilities.empty()) return sample + ".";
  const Update& most = *std::ranges::max_element(
      p.probabilities,
      [](const Update& a, const Update& b) { return a.after.value < b.after.value; });
  const Interval& bounds = most.after.bounds;
  const bool has_bounds = p.sampling.is_random || p.n_unknown + p.n_undecided > 0;
  return concat(p.probabilities.size() == 1 ? "" : "Most likely: ", most.label, ": ",
                format_percent(most.after.value), " %",
                has_bounds ? concat(" (", format_percent(bounds.low), " to ",
                                    format_percent(bounds.high), " %)")
                           : std::string(),
                ", before ", format_percent(most.before.value), " %. ", sample, ".");
}

}  // namespace

Posterior find_posterior(const Store& store, const CampaignInfo& campaign,
                         const PosteriorRequest& request) {
  const Selection selection = make_selection(store, campaign, "", "");
  Posterior found;
  found.campaign = campaign;
  found.request = request;
  found.sampling = sampling_of(store, campaign, {request.where});
  found.seen = read_seen(request.seen, campaign, selection);
  const std::vector<std::string> conditions =
      request.conditions.empty() ? default_conditions(selection) : request.conditions;
  const WeightedRows rows = PosteriorReader(store, found, selection, conditions).read();
  found.effective_size = effective_sample_size(rows.of_complete);
  refuse_few(found);
  update_parameters(found, rows);
  for (std::size_t c = 0; c < conditions.size(); ++c) {
    found.probabilities.push_back(
        update_of(conditions[c], rows.held[c], rows, confidence_of(found)));
  }
  return found;
}

Answer to_answer(const Posterior& p) {
  Answer answer;
  answer.headline = {headline_of(p)};
  answer.facts = {{"campaign", p.campaign.name},
                  {"confidence", p.request.confidence},
                  {"rows", p.n_rows},
                  {"unknown", p.n_unknown},
                  {"undecided", p.n_undecided},
                  {"effective_sample_size", p.effective_size},
                  {"remark", p.sampling.remark}};
  answer.add(seen_table(p));
  answer.add(parameter_table(p.parameters));
  answer.add(update_table("words", "parameter", p.words));
  answer.add(update_table("probabilities", "condition", p.probabilities));
  if (p.sampling.is_random && p.effective_size < kFewestEffectiveMembers) {
    answer.note(
        concat("Bounds of a share of one twentieth hold 93 to 97 times in 100 for an "
               "effective sample of at least ",
               kFewestEffectiveMembers, "; less often for smaller ones."));
  }
  if (p.n_unknown > 0) {
    answer.note(
        concat(grouped(p.n_unknown), p.n_unknown == 1 ? " case has" : " cases have",
               " no full history: estimates are from the others, bounds allow for any outcome."));
  }
  if (p.n_undecided > 0) {
    answer.note(concat("In ", grouped(p.n_undecided),
                       " cases the cells leave open what was observed or asked, or when in a load "
                       "step a fault began to slide: estimates take them as computed, bounds allow "
                       "for either."));
  }
  answer.note(
      concat(p.sampling.is_random
                 ? concat("Bounds contain the values after the observations with a confidence of ",
                          confidence_text(p.request.confidence))
                 : "From and to allow for what is open alone: they are not bounds of a probability",
             "; errors of the observations are taken as independent."));
  answer.note_if(p.sampling.remark);
  answer.note_if(p.sampling.approximation);
  return answer;
}

}  // namespace faultsweep
