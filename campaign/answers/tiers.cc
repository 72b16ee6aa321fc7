#include "campaign/answers/tiers.h"

#include <algorithm>
#include <cmath>

#include "campaign/answers/probability.h"
#include "campaign/answers/tier_rows.h"
#include "campaign/common/names.h"
#include "campaign/statistics/calibrated_quantile.h"
#include "campaign/statistics/calibrated_share.h"
#include "campaign/statistics/control_variate.h"
#include "simulator/scene/tiers.h"

namespace faultsweep {

namespace {

/// The k-th row must be the same sample at both.
void refuse_other_samples(const TierRows& low, const TierRows& high, const CampaignInfo& campaign) {
  const bool fit =
      high.parameters.size() <= low.parameters.size() &&
      std::equal(high.parameters.begin(), high.parameters.end(), low.parameters.begin());
  if (fit) return;
  throw InputError(
      "tiers", concat("the samples of ", campaign.name, " are not the first ones of the low tier"),
      "give both the same monte-carlo design and seed");
}

void refuse_few(std::size_t n_pairs) {
  if (static_cast<long>(n_pairs) >= kFewestPairsForTiers) return;
  throw InputError("tiers", concat(n_pairs, " full histories at both tiers are too few"),
                   concat("run at least ", kFewestPairsForTiers, ": --tier-budget"));
}

void refuse_missing(const std::vector<double>& values, const std::string& label) {
  if (std::ranges::all_of(values, [](double one) { return std::isfinite(one); })) return;
  throw InputError("--metrics", concat("full histories have no ", label),
                   "ask for a metric that all have, or for a condition");
}

/// A question with the columns that answer it.
struct Asked {
  TierAnswer answer;
  std::size_t column = 0;  ///< of TierRows::values, or held.
  std::vector<std::size_t> predictors = {};
};

/// What is asked, and the columns that it takes.
class Questions {
 public:
  Questions(const Store& store, const CampaignInfo& campaign, const TierRequest& request)
      : campaign_(campaign),
        selection_(make_selection(store, campaign, "", "")),
        plane_strain_(store.kinds(campaign.id, {}).plane_strain) {
    const bool with_defaults = request.quantiles.empty();
    if (!request.metrics.empty() || with_defaults) add_means(request);
    if (!request.conditions.empty() || with_defaults) {
      for (const std::string& one :
           request.conditions.empty() ? default_conditions(selection_) : request.conditions)
        add_probability(one);
    }
    if (!request.quantiles.empty()) add_quantiles(request);
  }
  const TierColumns& columns() const { return columns_; }
  const std::vector<Asked>& asked() const { return asked_; }

 private:
  /// As lists of metrics have them, each with its unit.
  Asked of_metric(const ScopedMetric& metric) {
    Asked one;
    one.answer.label = metric.spelled;
    one.answer.unit = shown_unit(metric.dimension, plane_strain_);
    const auto place = std::ranges::find(columns_.metrics, metric.spelled);
    one.column = static_cast<std::size_t>(place - columns_.metrics.begin());
    if (place == columns_.metrics.end()) columns_.metrics.push_back(metric.spelled);
    return one;
  }
  void add_means(const TierRequest& request) {
    const std::string names =
        request.metrics.empty() ? of_each_fault(selection_.faults, "chi_bar") : request.metrics;
    for (const ScopedMetric& metric : choose_metrics(selection_, names, true, false))
      asked_.push_back(of_metric(metric));
  }
  void add_probability(const std::string& condition) {
    Asked one;
    one.answer.label = condition;
    one.answer.question = TierQuestion::probability;
    one.answer.unit = percent();
    one.column = columns_.conditions.size();
    columns_.conditions.push_back(condition);
    add_predictors(one, condition);
    asked_.push_back(std::move(one));
  }
  void add_quantiles(const TierRequest& request) {
    for (const double q : request.at) {
      if (q > 0 && q < 1) continue;
      throw InputError("--at", concat(q, " is not a share of the cases"),
                       "write shares between 0 and 1: 0.05,0.5,0.95");
    }
    for (const ScopedMetric& metric : choose_metrics(selection_, request.quantiles, true, false)) {
      Asked one = of_metric(metric);
      one.answer.question = TierQuestion::quantile;
      add_predictors(one, metric.spelled);
      for (const double q : request.at) {
        one.answer.share = q;
        asked_.push_back(one);
      }
    }
  }
  void add_predictors(Asked& one, const std::string& condition) {
    for (const ScopedMetric& metric : predictors_of(condition, campaign_, selection_)) {
      one.predictors.push_back(columns_.place_of(metric));
      one.answer.predictors.push_back(metric.spelled);
    }
  }

  const CampaignInfo& campaign_;
  Selection selection_;
  bool plane_strain_;
  TierColumns columns_;
  std::vector<Asked> asked_;
};

/// Undecided flags at the low tier are between the decided ones.
double predictor_of(Held held) {
  switch (held) {
    case Held::no:
      return 0;
    case Held::undecided_no:
      return 1.0 / 3;
    case Held::undecided_yes:
      return 2.0 / 3;
    case Held::yes:
      return 1;
    case Held::unknown:
      break;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

Flag flag_of(Held held) {
  switch (held) {
    case Held::no:
      return Flag::no;
    case Held::undecided_no:
      return Flag::undecided_no;
    case Held::undecided_yes:
      return Flag::undecided_yes;
    case Held::yes:
      return Flag::yes;
    case Held::unknown:
      break;
  }
  FAULTSIM_DEMAND(held != Held::unknown, "a full history is known");
  return Flag::no;
}

/// Answers questions from the rows of both tiers.
class Answering {
 public:
  Answering(const TierRows& low, const TierRows& high, const PairedRows& pairs, const Tiers& tiers)
      : low_(low), high_(high), pairs_(pairs), tiers_(tiers) {}

  TierAnswer answer(const Asked& asked) const {
    TierAnswer answer = asked.answer;
    HalfWidth half_width;
    switch (answer.question) {
      case TierQuestion::mean:
        half_width = set_mean(asked.column, answer);
        break;
      case TierQuestion::probability:
        half_width = set_probability(asked, answer);
        break;
      case TierQuestion::quantile:
        half_width = set_quantile(asked, answer);
        break;
    }
    set_costs(answer);
    if (tiers_.request.width > 0) set_numbers(half_width, answer);
    return answer;
  }

 private:
  double confidence() const { return tiers_.request.confidence; }

  HalfWidth set_mean(std::size_t column, TierAnswer& answer) const {
    const std::vector y = pairs_.of_pairs(high_.values[column]),
                      x = pairs_.of_all(low_.values[column]);
    refuse_missing(x, answer.label);
    refuse_missing(y, answer.label);
    const TieredEstimate mean = tiered_mean({y, x}, confidence());
    answer.found = mean.estimate, answer.alone = mean.direct;
    answer.by_number = half_width(mean.estimate);
    answer.predictors = {answer.label};
    answer.weight = mean.weight;
    answer.correlation = mean.correlation;
    answer.n_equivalent = mean.n_equivalent;
    for (const double one : x) answer.low_value += one / static_cast<double>(x.size());
    return [mean, sure = confidence()](double n, double all) {
      return mean_half_width(mean, n, all, sure);
    };
  }

  HalfWidth set_probability(const Asked& asked, TierAnswer& answer) const {
    const std::vector held = pairs_.of_all(low_.held[asked.column]);
    std::vector<std::vector<double>> columns = predictor_columns(asked);
    columns.push_back(mapped(held, predictor_of));
    answer.predictors.push_back(answer.label);
    const StandardFeatures features = standard(columns, answer);
    const CalibratedShare share =
        calibrated_share(mapped(pairs_.of_pairs(high_.held[asked.column]), flag_of), features);
    answer.found = share.estimate(confidence()), answer.alone = share.direct(confidence());
    answer.by_number = share.by_number(confidence());
    answer.by_undecided = share.by_undecided(confidence());
    answer.n_undecided = static_cast<long>(share.n_undecided);
    answer.correlation = share.as_computed.correlation();
    answer.n_equivalent = share.as_computed.n_equivalent(confidence());
    ShareCounts counts;
    for (const Held one : held) counts.add(one);
    answer.low_value = counts.estimate();
    return [by_number = share.as_computed, sure = confidence()](double n, double all) {
      return by_number.half_width(n, all, sure);
    };
  }

  HalfWidth set_quantile(const Asked& asked, TierAnswer& answer) const {
    const std::vector y = pairs_.of_pairs(high_.values[asked.column]);
    std::vector x = pairs_.of_all(low_.values[asked.column]);
    refuse_missing(x, answer.label);
    refuse_missing(y, answer.label);
    const CalibratedDistribution values(y, standard(predictor_columns(asked), answer));
    const CalibratedQuantile quantile = values.quantile(answer.share, confidence());
    answer.found = estimate_of(quantile.bounds);
    answer.alone = estimate_of(values.direct(answer.share, confidence()));
    answer.by_number = half_width(answer.found);
    answer.correlation = quantile.share_up_to_it.correlation();
    answer.n_equivalent = quantile.share_up_to_it.n_equivalent(confidence());
    std::ranges::sort(x);
    answer.low_value = quantile_bounds(x, 0, answer.share, confidence()).estimate;
    return [quantile, sure = confidence()](double n, double all) {
      return quantile.half_width(n, all, sure);
    };
  }

  static Estimate estimate_of(const QuantileBounds& bounds) {
    constexpr double kOpen = std::numeric_limits<double>::quiet_NaN();
    return {bounds.estimate, kOpen, {bounds.low.value_or(kOpen), bounds.high.value_or(kOpen)}};
  }

  std::vector<std::vector<double>> predictor_columns(const Asked& asked) const {
    return mapped(asked.predictors,
                  [&](std::size_t place) { return pairs_.of_all(low_.predictors[place]); });
  }
  /// Says which of the answer's predictors cannot be used.
  StandardFeatures standard(const std::vector<std::vector<double>>& columns,
                            TierAnswer& answer) const {
    StandardFeatures features(columns, pairs_.order.size());
    for (const std::size_t k : features.left_out()) answer.left_out.push_back(answer.predictors[k]);
    return features;
  }

  void set_costs(TierAnswer& answer) const {
    const TierCost &low = tiers_.low_cost, &high = tiers_.high_cost;
    answer.high_alone_seconds = high.seconds_of(answer.n_equivalent);
    if (tiers_.taken_seconds > 0)
      answer.cost_ratio = answer.high_alone_seconds / tiers_.taken_seconds;
    if (low.seconds_per_case() > 0 && high.seconds_per_case() > 0) {
      answer.best_ratio =
          best_ratio(answer.correlation, low.seconds_per_case() / high.seconds_per_case());
    }
  }

  void set_numbers(const HalfWidth& half_width, TierAnswer& answer) const {
    constexpr double kShortest = 1e-6;  // s: made-up or rounded times
    const TierPrices prices{std::max(kShortest, tiers_.low_cost.seconds_per_case()),
                            std::max(kShortest, tiers_.high_cost.seconds_per_case()),
                            tiers_.low_cost.once_seconds() + tiers_.high_cost.once_seconds()};
    const bool is_share = answer.question == TierQuestion::probability;
    const double first = is_share ? 0.5 * tiers_.request.width : 0.5 * answer.by_number;
    for (const double wanted : {first, 0.5 * first, 0.25 * first}) {
      if (!(wanted > 0) || (!is_share && wanted < 0.5 * first)) continue;
      answer.numbers.push_back(
          {wanted, cheapest_numbers(half_width, wanted, prices, kFewestPairsForTiers)});
    }
  }

  const TierRows &low_, &high_;
  const PairedRows& pairs_;
  const Tiers& tiers_;
};

}  // namespace

double TierCost::once_seconds() const { return has_operator_per_case() ? 0 : operator_seconds; }

double TierCost::seconds_per_case() const {
  return case_seconds +
         (has_operator_per_case() ? operator_seconds / static_cast<double>(n_rows) : 0);
}

double TierCost::seconds_of(double rows) const {
  return once_seconds() + rows * seconds_per_case();
}

Tiers compare_tiers(const Store& store, const CampaignInfo& low, const CampaignInfo& high,
                    const TierRequest& request) {
  Tiers tiers{low, high, request, 0, {}, {}, 0, {}};
  const Questions questions(store, low, request);
  TierColumns without_predictors = questions.columns();
  without_predictors.predictors.clear();
  const TierRows lows = read_tier(store, low, questions.columns(), tiers.low_cost);
  const TierRows highs = read_tier(store, high, without_predictors, tiers.high_cost);
  refuse_other_samples(lows, highs, high);
  const PairedRows pairs = paired_rows(lows, highs);
  refuse_few(pairs.n);
  tiers.n_pairs = static_cast<long>(pairs.n);
  tiers.taken_seconds = tiers.low_cost.seconds_of(static_cast<double>(tiers.low_cost.n_rows)) +
                        tiers.high_cost.seconds_of(static_cast<double>(tiers.high_cost.n_rows));
  const Answering answering(lows, highs, pairs, tiers);
  for (const Asked& one : questions.asked()) tiers.answers.push_back(answering.answer(one));
  return tiers;
}

std::optional<TierPair> tiers_beside(const Store& store, const CampaignInfo& campaign) {
  const std::vector<std::string> names = mapped(store.campaigns(), &CampaignInfo::name);
  const auto beside = [&](const std::string& stem) {
    std::vector<std::string> found;
    for (const faultsim::Tier& tier : faultsim::tiers()) {
      const std::string name = concat(stem, "-", tier.name);
      if (std::ranges::count(names, name) > 0) found.push_back(name);
    }
    return found;
  };
  std::vector<std::string> found = beside(campaign.name);
  for (const faultsim::Tier& tier : faultsim::tiers()) {
    const std::string ending = concat("-", tier.name);
    if (campaign.name.ends_with(ending))
      found = beside(campaign.name.substr(0, campaign.name.size() - ending.size()));
  }
  if (found.size() < 2) return std::nullopt;
  return TierPair{store.campaign(found.front()), store.campaign(found.back())};
}

}  // namespace faultsweep
