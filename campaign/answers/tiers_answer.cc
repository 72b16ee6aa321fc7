#include <algorithm>
#include <cmath>

#include "campaign/answers/tiers.h"
#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/render/shown.h"

namespace faultsweep {

namespace {

/// "28.6 % (26.3 to 31.0)".
std::string interval_text(const Estimate& e, const ShownUnit& unit) {
  constexpr int kDigits = 3;
  const auto number = [&](double value) { return format_number(value / unit.size, kDigits); };
  return concat(number(e.value), unit.name.empty() ? "" : " ", unit.name, " (",
                number(e.bounds.low), " to ", number(e.bounds.high), ")");
}

std::string sentence_of(const TierAnswer& one) {
  return concat(one.is_probability ? "Probability of " : "Mean of ", one.label,
                " at the high tier: ", interval_text(one.found.estimate, one.unit), ".");
}

/// "yes: alone 4.1 times as long".
std::string pays_text(const TierAnswer& one) {
  return concat(one.cost_ratio > 1 ? "yes: " : "no: ", "alone ", format_number(one.cost_ratio, 2),
                " times as long");
}

/// "0.012 s", "355 s".
std::string seconds_text(double value) {
  constexpr double kWhole = 100;  // from here on no decimals
  return format_number(value >= kWhole ? std::round(value) : value, value >= kWhole ? 9 : 2) + " s";
}

/// Whether it was worth while, over all answers.
std::string pays_sentence(const Tiers& tiers) {
  const auto less = [](const TierAnswer& a, const TierAnswer& b) {
    return a.cost_ratio < b.cost_ratio;
  };
  const auto [least, most] = std::ranges::minmax_element(tiers.answers, less);
  const auto n = tiers.answers.size();
  const auto n_pays = static_cast<std::size_t>(std::ranges::count_if(
      tiers.answers, [](const TierAnswer& one) { return one.cost_ratio > 1; }));
  const std::string pays = n_pays == n ? std::string("Two tiers pay")
                           : n_pays == 0
                               ? std::string("Two tiers do not pay")
                               : concat("Two tiers pay for ", n_pays, " of ", n, " answers");
  const std::string from = format_number(least->cost_ratio, 2),
                    to = format_number(most->cost_ratio, 2);
  return concat(pays, ": as sure from the high tier alone would have taken ", from,
                from == to ? "" : concat(" to ", to), " times the ",
                seconds_text(tiers.taken_seconds), " of wall clock that both took.");
}

/// All answers in SI, or for a screen those of a unit.
AnswerTable table_of(const Tiers& tiers) {
  AnswerTable table{"answers",
                    "",
                    {{"label", "at the high tier"},
                     {"is_probability", "is a probability"},
                     {"unit", "unit"},
                     {"value", "value"},
                     {"standard_error", "standard error"},
                     {"low", "from"},
                     {"high", "to"},
                     {"high_alone", "high tier alone"},
                     {"high_alone_standard_error", "standard error"},
                     {"high_alone_low", "from"},
                     {"high_alone_high", "to"},
                     {"low_alone", "low tier alone"},
                     {"weight", "weight"},
                     {"correlation", "correlation"},
                     {"worth", "worth"},
                     {"high_alone_s", "high tier alone", seconds()},
                     {"cost_ratio", "cost ratio"},
                     {"pays", "pays"},
                     {"best_ratio", "best ratio"}}};
  for (const TierAnswer& one : tiers.answers) {
    const Estimate &e = one.found.estimate, &alone = one.found.direct;
    table.rows.push_back({one.label, one.is_probability, one.unit.si, e.value, e.standard_error,
                          e.bounds.low, e.bounds.high, alone.value, alone.standard_error,
                          alone.bounds.low, alone.bounds.high, one.low_mean, one.found.weight,
                          one.found.correlation, one.found.n_equivalent, one.high_alone_seconds,
                          one.cost_ratio, one.cost_ratio > 1, one.best_ratio});
  }
  table.on_screen = false;
  return table;
}

AnswerTable screen_table_of(const Tiers& tiers, const ShownUnit& unit) {
  AnswerTable table{"answers",
                    "",
                    {{"label", "at the high tier", {}, 4, Need::always},
                     {"value", "value", unit, 4, Need::always},
                     {"low", "from", unit, 3},
                     {"high", "to", unit, 3},
                     {"pays", "pays", {}, 4, Need::always},
                     {"high_alone", "high alone", unit, 4},
                     {"low_alone", "low alone", unit, 3},
                     {"worth", "worth cases", {}, 3}}};
  for (const TierAnswer& one : tiers.answers) {
    if (one.unit.name != unit.name) continue;
    const Estimate &e = one.found.estimate, &alone = one.found.direct;
    table.rows.push_back({one.label,
                          {e.value, half_width(e)},
                          e.bounds.low,
                          e.bounds.high,
                          pays_text(one),
                          {alone.value, half_width(alone)},
                          one.low_mean,
                          one.found.n_equivalent});
  }
  table.in_files = false;
  return table;
}

void add_screen_tables(const Tiers& tiers, Answer& answer) {
  std::vector<std::string> done;
  for (const TierAnswer& one : tiers.answers) {
    if (contains(done, one.unit.name)) continue;
    done.push_back(one.unit.name);
    answer.add(screen_table_of(tiers, one.unit));
  }
}

/// What each tier took; facts of JSON have it too.
AnswerTable cost_table(const Tiers& tiers) {
  AnswerTable table{"costs",
                    "",
                    {{"tier", "tier", {}, 4, Need::always},
                     {"campaign", "campaign", {}, 4, Need::always},
                     {"rows", "cases", {}, 4, Need::always},
                     {"left_out", "left out"},
                     {"case_s", "a case takes", seconds(), 4, Need::always},
                     {"operators_s", "operators took", seconds(), 4, Need::always},
                     {"all_s", "together", seconds(), 4, Need::always}}};
  const auto add = [&](const char* tier, const CampaignInfo& campaign, const TierCost& cost) {
    table.rows.push_back({tier, campaign.name, cost.n_rows, cost.n_left_out, cost.case_seconds,
                          cost.operator_seconds,
                          cost.seconds_of(static_cast<double>(cost.n_rows))});
  };
  add("low", tiers.low, tiers.low_cost);
  add("high", tiers.high, tiers.high_cost);
  table.notes.emplace_back(
      "Costs are seconds of wall clock, as if all had run one after the other: of cases, and of "
      "building the operators that were not in the cache.");
  table.in_files = false;
  return table;
}

ordered_json cost_to_json(const CampaignInfo& campaign, const TierCost& one) {
  return {{"campaign", campaign.name},
          {"rows", one.n_rows},
          {"left_out", one.n_left_out},
          {"case_s", one.case_seconds},
          {"operators_s", one.operator_seconds}};
}

}  // namespace

Answer to_answer(const Tiers& tiers) {
  Answer answer;
  for (std::size_t k = 0; k + 1 < kMostSentences && k < tiers.answers.size(); ++k)
    answer.headline.push_back(sentence_of(tiers.answers[k]));
  if (!tiers.answers.empty()) answer.headline.push_back(pays_sentence(tiers));
  answer.facts = {{"confidence", tiers.request.confidence},
                  {"pairs", tiers.n_pairs},
                  {"taken_s", tiers.taken_seconds},
                  {"low", cost_to_json(tiers.low, tiers.low_cost)},
                  {"high", cost_to_json(tiers.high, tiers.high_cost)}};
  answer.add(table_of(tiers));
  add_screen_tables(tiers, answer);
  answer.note(concat(
      tiers.n_pairs, " cases at both tiers. From and to hold the value with a confidence of ",
      confidence_text(tiers.request.confidence),
      "; ± is half of their distance. `worth`: cases of the high tier alone "
      "that would be as sure. `pays`: what these would have taken, against what both tiers took."));
  answer.add(cost_table(tiers));
  if (tiers.low_cost.n_left_out + tiers.high_cost.n_left_out > 0) {
    answer.note(
        "Cases without a history to its end are left out: the answers hold if these are like the "
        "others.");
  }
  return answer;
}

}  // namespace faultsweep
