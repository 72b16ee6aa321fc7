#include <algorithm>
#include <cmath>

#include "campaign/answers/shares.h"
#include "campaign/answers/tiers.h"
#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/render/shown.h"

namespace faultsweep {

namespace {

constexpr int kDigits = 3;

std::string number_text(double value, const ShownUnit& unit) {
  return std::isnan(value) ? "open" : format_number(value / unit.size, kDigits);
}

/// "28.6 %".
std::string with_unit(double value, const ShownUnit& unit) {
  return concat(number_text(value, unit), unit.name.empty() ? "" : " ", unit.name);
}

/// "28.6 % (26.3 to 31.0)".
std::string interval_text(const Estimate& e, const ShownUnit& unit) {
  return concat(with_unit(e.value, unit), " (", number_text(e.bounds.low, unit), " to ",
                number_text(e.bounds.high, unit), ")");
}

/// "F1.chi_bar", "95 % of F1.chi_bar": the row of a table.
std::string name_of(const TierAnswer& one) {
  return one.question == TierQuestion::quantile
             ? concat(format_percent(one.share), " % of ", one.label)
             : one.label;
}

std::string title_of(const TierAnswer& one) {
  switch (one.question) {
    case TierQuestion::mean:
      return concat("Mean of ", one.label);
    case TierQuestion::probability:
      return concat("Probability of ", one.label);
    case TierQuestion::quantile:
      break;
  }
  return concat(format_percent(one.share), " % quantile of ", one.label);
}

/// What makes the width of the bounds, where flags are undecided: ": ± 3 by the number of cases, ±
/// 2 by 7 undecided".
std::string parts_text(const TierAnswer& one) {
  if (one.n_undecided == 0) return "";
  return concat(": ± ", number_text(one.by_number, one.unit), " by the number of cases, ± ",
                number_text(one.by_undecided, one.unit), " by ", one.n_undecided, " undecided");
}

std::string sentence_of(const TierAnswer& one) {
  std::string text =
      concat(title_of(one), " at the high tier: ", interval_text(one.found, one.unit));
  const std::string parts = parts_text(one);
  if (!parts.empty()) text.insert(text.size() - 1, parts);  // before the bracket
  return text + ".";
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

/// "Bounds of F1.slides that are 2 % apart take 420 cases at the high tier and 5,300 at the low
/// one: 430 s." Of the first width that was asked for.
/// @pre one.numbers is not empty.
std::string numbers_sentence(const TierAnswer& one) {
  const NumbersForWidth& first = one.numbers.front();
  const std::string bounds = concat("Bounds of ", name_of(one), " that are ",
                                    with_unit(2 * first.half_width, one.unit), " apart ");
  if (!first.numbers) return bounds + "need more cases than can be run.";
  return concat(bounds, "need ", grouped(first.numbers->n), " cases at the high tier and ",
                grouped(first.numbers->all), " at the low one: ", seconds_text(first.numbers->cost),
                ".");
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
  return concat(pays, ": equal certainty from the high tier alone would have taken ", from,
                from == to ? "" : concat(" to ", to), " times the ",
                seconds_text(tiers.taken_seconds), " of wall clock that both took.");
}

/// "mean", "probability" or "quantile".
std::string word_of(TierQuestion question) {
  switch (question) {
    case TierQuestion::mean:
      return "mean";
    case TierQuestion::probability:
      return "probability";
    case TierQuestion::quantile:
      break;
  }
  return "quantile";
}

/// Nothing for NaN.
AnswerCell number_or_nothing(double value) {
  return std::isnan(value) ? AnswerCell() : AnswerCell(value);
}

/// All answers in SI.
AnswerTable table_of(const Tiers& tiers) {
  AnswerTable table{"answers",
                    "",
                    {{"label", "at the high tier"},
                     {"question", "question"},
                     {"share", "share below"},
                     {"unit", "unit"},
                     {"value", "value"},
                     {"standard_error", "standard error"},
                     {"low", "from"},
                     {"high", "to"},
                     {"by_number", "± by number"},
                     {"by_undecided", "± by undecided"},
                     {"undecided", "undecided"},
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
                     {"best_ratio", "best ratio"},
                     {"left_out", "not used"}}};
  for (const TierAnswer& one : tiers.answers) {
    const Estimate &e = one.found, &alone = one.alone;
    table.rows.push_back({one.label,
                          word_of(one.question),
                          number_or_nothing(one.share),
                          one.unit.si,
                          e.value,
                          number_or_nothing(e.standard_error),
                          number_or_nothing(e.bounds.low),
                          number_or_nothing(e.bounds.high),
                          number_or_nothing(one.by_number),
                          one.by_undecided,
                          one.n_undecided,
                          alone.value,
                          number_or_nothing(alone.standard_error),
                          number_or_nothing(alone.bounds.low),
                          number_or_nothing(alone.bounds.high),
                          one.low_value,
                          one.weight,
                          one.correlation,
                          one.n_equivalent,
                          one.high_alone_seconds,
                          one.cost_ratio,
                          one.cost_ratio > 1,
                          one.best_ratio,
                          words_or_nothing(joined(one.left_out, ", "))});
  }
  table.on_screen = false;
  return table;
}

AnswerCell end_cell(double end) {
  return std::isnan(end) ? AnswerCell({}, end, "open") : AnswerCell(end);
}

AnswerTable screen_table_of(const Tiers& tiers, const ShownUnit& unit) {
  AnswerTable table{"answers",
                    "",
                    {{"label", "at the high tier", {}, 4, Need::always},
                     {"value", "value", unit, 4, Need::always},
                     {"low", "from", unit, 3},
                     {"high", "to", unit, 3}}};
  const bool has_undecided = std::ranges::any_of(tiers.answers, [&](const TierAnswer& one) {
    return one.unit.name == unit.name && one.n_undecided > 0;
  });
  if (has_undecided) table.columns.push_back({"by_undecided", "± by undecided", unit, 2});
  append(table.columns, {{"pays", "pays", {}, 4, Need::always},
                         {"high_alone", "high alone", unit, 4},
                         {"low_alone", "low alone", unit, 3},
                         {"worth", "worth cases", {}, 3}});
  for (const TierAnswer& one : tiers.answers) {
    if (one.unit.name != unit.name) continue;
    const Estimate &e = one.found, &alone = one.alone;
    std::vector<AnswerCell> row = {
        name_of(one), {e.value, half_width(e)}, end_cell(e.bounds.low), end_cell(e.bounds.high)};
    if (has_undecided) row.emplace_back(one.by_undecided);
    append(row,
           {pays_text(one), {alone.value, half_width(alone)}, one.low_value, one.n_equivalent});
    table.rows.push_back(std::move(row));
  }
  table.in_files = false;
  return table;
}

/// What bounds as close as wanted take, in SI.
AnswerTable numbers_table(const Tiers& tiers) {
  AnswerTable table{"numbers",
                    "",
                    {{"label", "bounds of"},
                     {"question", "question"},
                     {"share", "share below"},
                     {"half_width", "to either side"},
                     {"high_cases", "cases, high tier"},
                     {"low_cases", "cases, low tier"},
                     {"time_s", "take", seconds()}}};
  for (const TierAnswer& one : tiers.answers) {
    for (const NumbersForWidth& wanted : one.numbers) {
      std::vector<AnswerCell> row = {one.label, word_of(one.question), number_or_nothing(one.share),
                                     wanted.half_width};
      if (const auto& numbers = wanted.numbers)
        append(row, {numbers->n, numbers->all, numbers->cost});
      table.rows.push_back(std::move(row));
    }
  }
  table.on_screen = false;
  return table;
}

AnswerTable numbers_screen_table(const Tiers& tiers) {
  AnswerTable table{"numbers",
                    "",
                    {{"label", "bounds of", {}, 4, Need::always},
                     {"half_width", "to either side", {}, 4, Need::always},
                     {"high_cases", "cases, high tier", {}, 4, Need::always},
                     {"low_cases", "low tier", {}, 4, Need::always},
                     {"time_s", "take", {}, 4, Need::always}}};
  for (const TierAnswer& one : tiers.answers) {
    for (const NumbersForWidth& wanted : one.numbers) {
      std::vector<AnswerCell> row = {name_of(one), with_unit(wanted.half_width, one.unit)};
      if (const auto& numbers = wanted.numbers)
        append(row, {numbers->n, numbers->all, seconds_text(numbers->cost)});
      table.rows.push_back(std::move(row));
    }
  }
  table.notes.emplace_back(
      "The least time for it, operators included, if further cases are like the present ones. More "
      "cases do not reduce what undecided flags add.");
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

/// How the answers came about.
std::string method_note(const Tiers& tiers) {
  const auto has = [&](TierQuestion question) {
    return contains(tiers.answers, question, &TierAnswer::question);
  };
  std::string text;
  if (has(TierQuestion::mean)) text += "Means are regressions on the low tier's value. ";
  if (has(TierQuestion::probability)) {
    text +=
        "A probability is that of the high tier's flag, predicted for each case from its results "
        "at the low tier (χ̄, largest slip and activated area of the fault and stage that the "
        "condition names, what it compares, and the flag; by logistic regressions fitted without "
        "the case) and corrected by the predictions' errors in the cases at both tiers. ";
  }
  if (has(TierQuestion::quantile)) {
    text +=
        "A quantile is where the probability of lying below it, predicted by a line through the "
        "low tier's results and corrected by the cases at both tiers, equals its share. ";
  }
  text.pop_back();
  return text;
}

/// "" where nothing is open.
std::string undecided_note(const Tiers& tiers) {
  long most = 0;
  for (const TierAnswer& one : tiers.answers) most = std::max(most, one.n_undecided);
  if (most == 0) return "";
  return concat("Of the flags at the high tier, up to ", most, " of ", tiers.n_pairs,
                " are undecided, by its cells or stated errors: from and to allow for none of them "
                "to all.");
}

/// "" where all that the low tier says could be used; else some of it.
std::string left_out_note(const Tiers& tiers) {
  constexpr std::size_t kMostNames = 3;
  std::vector<std::string> names;
  for (const TierAnswer& one : tiers.answers) {
    for (const std::string& name : one.left_out)
      if (!contains(names, name)) names.push_back(name);
  }
  if (names.empty()) return "";
  const std::size_t more = names.size() - std::min(names.size(), kMostNames);
  names.resize(names.size() - more);
  return concat(
      "Not used to predict, as constant over the cases of the low tier or missing in some: ",
      joined(names, ", "), more > 0 ? concat(" and ", more, " more") : "", ".");
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
  std::vector<std::string> last;
  // A width is asked of probabilities first.
  auto with_numbers = std::ranges::find_if(tiers.answers, [](const TierAnswer& one) {
    return one.question == TierQuestion::probability && !one.numbers.empty();
  });
  if (with_numbers == tiers.answers.end())
    with_numbers = std::ranges::find_if_not(tiers.answers, &std::vector<NumbersForWidth>::empty,
                                            &TierAnswer::numbers);
  if (with_numbers != tiers.answers.end()) last.push_back(numbers_sentence(*with_numbers));
  if (!tiers.answers.empty()) last.push_back(pays_sentence(tiers));
  for (std::size_t k = 0; k + last.size() < kMostSentences && k < tiers.answers.size(); ++k)
    answer.headline.push_back(sentence_of(tiers.answers[k]));
  append(answer.headline, last);
  answer.facts = {{"confidence", tiers.request.confidence},
                  {"pairs", tiers.n_pairs},
                  {"taken_s", tiers.taken_seconds},
                  {"low", cost_to_json(tiers.low, tiers.low_cost)},
                  {"high", cost_to_json(tiers.high, tiers.high_cost)}};
  answer.add(table_of(tiers));
  add_screen_tables(tiers, answer);
  if (tiers.request.width > 0) {
    answer.add(numbers_table(tiers));
    answer.add(numbers_screen_table(tiers));
  }
  answer.note(concat(
      tiers.n_pairs, " cases at both tiers. From and to contain the value with a confidence of ",
      confidence_text(tiers.request.confidence),
      "; ± is half of their distance. `worth`: cases of the high tier alone "
      "with equal certainty. `pays`: the time of these against that of both tiers."));
  answer.note(method_note(tiers));
  answer.note_if(undecided_note(tiers));
  answer.note_if(left_out_note(tiers));
  answer.add(cost_table(tiers));
  if (tiers.low_cost.n_left_out + tiers.high_cost.n_left_out > 0) {
    answer.note(
        "Cases without a full history are left out: the answers hold if these are like the "
        "others.");
  }
  return answer;
}

}  // namespace faultsweep
