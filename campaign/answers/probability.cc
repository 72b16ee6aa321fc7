#include "campaign/answers/probability.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>

#include "campaign/common/names.h"
#include "campaign/render/shown.h"

namespace faultsweep {

namespace figure = faultsim::figure;

namespace {

constexpr std::size_t kMostValues = 12;  ///< of a parameter that is not cut into parts.
constexpr std::size_t kParts = 10;

/// The rows that were asked about.
struct AskedRows {
  std::vector<double> value;             ///< of `by`; NaN for words and where the case has none.
  std::vector<std::string> label;        ///< of `by`.
  std::vector<std::vector<Held>> holds;  ///< of a condition, of a row.
};

int parameter_index(const CampaignInfo& campaign, const std::string& name) {
  std::vector names = mapped(campaign.parameters, &StoredParameter::name);
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) require_name("--by", "parameter", name, names);
  return static_cast<int>(found - names.begin());
}

/// One pass over the cases: every condition is a column.
AskedRows read_rows(const Store& store, const CampaignInfo& campaign,
                    const ProbabilityRequest& request, const Selection& selection,
                    const std::vector<std::string>& conditions) {
  const int by = request.by.empty() ? -1 : parameter_index(campaign, request.by);
  const VerdictColumns verdicts(store, campaign, selection, conditions);
  Store::TableQuery query = case_query(campaign, selection, request.where);
  query.columns = verdicts.columns();
  AskedRows rows;
  rows.holds.resize(conditions.size());
  const SampleRows sample_rows(store, campaign);
  store.for_each_case(campaign.id, query, [&](const CaseRow& row) {
    double value = std::numeric_limits<double>::quiet_NaN();
    std::string label;
    for (const CaseParameter& one : row.parameters) {
      if (one.index != by) continue;
      value = one.si.value_or(value);
      label = one.text;
    }
    for (int k = 0; k < sample_rows.count(row.position); ++k) {
      rows.value.push_back(value);
      rows.label.push_back(label);
      for (std::size_t c = 0; c < conditions.size(); ++c)
        rows.holds[c].push_back(verdicts.held(row, c));
    }
  });
  return rows;
}

Share share_of(std::string label, const std::string& condition,
               const std::vector<std::size_t>& chosen, const std::vector<Held>& holds,
               const Probability& p) {
  Share share;
  share.label = std::move(label);
  share.condition = condition;
  for (const std::size_t k : chosen) share.counts.add(holds[k]);
  share.bounds = bounds_of(share.counts, p.sampling, p.request.confidence);
  return share;
}

void set_more(Share& share, const Probability& p) {
  const double wanted = p.request.width;
  const double estimate = share.counts.estimate();
  if (std::isnan(estimate) || share.bounds.high - share.bounds.low <= wanted) return;
  const long needed = samples_for_half_width(estimate, 0.5 * wanted, p.request.confidence);
  share.n_more = std::max(0L, needed - share.counts.n_known());
}

using Part = std::pair<std::string, std::vector<std::size_t>>;

/// AskedRows of equal label, in the order in which labels come first; nothing if there are more
/// than `most`.
std::vector<Part> parts_by_label(const std::vector<std::size_t>& order, const AskedRows& rows,
                                 std::size_t most) {
  std::vector<Part> parts;
  std::unordered_map<std::string, std::size_t> place;
  for (const std::size_t k : order) {
    const auto [found, is_new] = place.emplace(rows.label[k], parts.size());
    if (is_new) {
      if (parts.size() == most) return {};
      parts.push_back({rows.label[k], {}});
    }
    parts[found->second].second.push_back(k);
  }
  return parts;
}

/// AskedRows in groups, each with a name: by value where there are few, else up to ten of
/// about equal number, none of which begins amid equal values.
std::vector<Part> parts_of(const AskedRows& rows) {
  std::vector<std::size_t> order(rows.label.size());
  std::iota(order.begin(), order.end(), 0u);
  const bool are_numbers =
      std::ranges::none_of(rows.value, [](double value) { return std::isnan(value); });
  if (!are_numbers) return parts_by_label(order, rows, order.size());
  std::ranges::stable_sort(
      order, [&](std::size_t a, std::size_t b) { return rows.value[a] < rows.value[b]; });
  std::vector<Part> parts = parts_by_label(order, rows, kMostValues);
  if (!parts.empty()) return parts;
  std::size_t from = 0;
  for (std::size_t part = 0; part < kParts; ++part) {
    std::size_t to = std::max(from, (part + 1) * order.size() / kParts);
    const auto splits_a_value = [&] {
      return to > 0 && to < order.size() && rows.value[order[to]] == rows.value[order[to - 1]];
    };
    while (splits_a_value()) ++to;
    if (to == from) continue;
    parts.push_back(
        {concat(short_number(rows.label[order[from]]), " to ",
                short_number(rows.label[order[to - 1]])),
         {order.begin() + static_cast<long>(from), order.begin() + static_cast<long>(to)}});
    from = to;
  }
  return parts;
}

/// All rows, under no name, where nothing is asked by parts.
std::vector<Part> parts_asked(const AskedRows& rows, const std::string& by) {
  if (!by.empty()) return parts_of(rows);
  std::vector<std::size_t> all(rows.label.size());
  std::iota(all.begin(), all.end(), 0u);
  return {{"", all}};
}

AnswerTable share_table(const Probability& p) {
  const char* what = p.sampling.is_random ? "probability" : "share";
  AnswerTable table{
      "shares",
      p.request.by.empty() ? "" : p.request.condition,
      {{"label", p.request.by.empty() ? "condition" : p.request.by, {}, 4, Need::always},
       {"estimate", what, percent(), 3, Need::always},
       {"low", "from", percent(), 3, Need::always},
       {"high", "to", percent(), 3, Need::always},
       {"by_number", "± by number", percent(), 2},
       {"holds", "true in", {}, 4},
       {"rows", "of", {}, 4},
       {"undecided", "undecided by cells", {}, 4},
       {"unknown", "no full history", {}, 4},
       {"more_for_width", "more for width", {}, 4}}};
  for (const Share& one : p.shares) {
    const ShareCounts& c = one.counts;
    const bool is_asked = p.request.width > 0 && p.sampling.is_random;
    table.rows.push_back({one.label, c.estimate(), one.bounds.low, one.bounds.high,
                          by_number(c, p.sampling, p.request.confidence), c.n_holds, c.n,
                          c.n_undecided, c.n_unknown,
                          is_asked ? AnswerCell(one.n_more) : AnswerCell()});
  }
  return table;
}

/// What from and to are, in a sentence or two.
std::string meaning_of_bounds(const Probability& p) {
  const bool any_undecided = std::ranges::any_of(
      p.shares, [](const Share& one) { return one.counts.n_undecided + one.counts.n_unknown > 0; });
  const std::string open =
      "what the cells leave undecided and what has no full history may be either";
  if (!p.sampling.is_random)
    return any_undecided ? concat("From and to: ", open, "; they do not bound a probability.") : "";
  return concat("From and to contain the probability with a confidence of ",
                confidence_text(p.request.confidence), any_undecided ? concat(": ", open) : "",
                "; ± is due to the number of cases alone.");
}

const Share& most_often(const Probability& p) {
  const auto less = [](const Share& a, const Share& b) {
    return a.counts.estimate() < b.counts.estimate() || std::isnan(a.counts.estimate());
  };
  return *std::ranges::max_element(p.shares, less);
}

}  // namespace

std::vector<std::string> default_conditions(const Selection& selection) {
  std::vector<std::string> conditions;
  for (const NamedId& fault : selection.faults) {
    const std::string slides = spelled_name(fault.name) + ".slides";
    conditions.push_back(slides);
    for (const NamedId& stage : selection.stages) {
      if (!stage.name.empty()) conditions.push_back(slides + " in " + spelled_name(stage.name));
    }
  }
  return conditions;
}

Probability find_probability(const Store& store, const CampaignInfo& campaign,
                             const ProbabilityRequest& request) {
  const Selection selection = make_selection(store, campaign, "", "");
  Probability found{campaign,
                    request,
                    sampling_of(store, campaign, {request.where}, request.by == "group"),
                    {},
                    0};
  const std::vector<std::string> conditions = request.condition.empty()
                                                  ? default_conditions(selection)
                                                  : std::vector<std::string>{request.condition};
  // Faults are known from results.
  if (conditions.empty()) refuse_unrun("probability", "no case has a result", campaign);
  const AskedRows rows = read_rows(store, campaign, request, selection, conditions);
  if (rows.label.empty())
    throw InputError("probability", "no case was selected", "select others with --where");
  const std::vector<Part> parts = parts_asked(rows, request.by);
  for (std::size_t c = 0; c < conditions.size(); ++c) {
    for (const auto& [label, chosen] : parts) {
      std::string name = label;
      if (label.empty()) {
        name = conditions[c];
      } else if (conditions.size() > 1) {
        name = concat(conditions[c], ", ", label);
      }
      found.shares.push_back(
          share_of(std::move(name), conditions[c], chosen, rows.holds[c], found));
      if (request.width > 0 && found.sampling.is_random) set_more(found.shares.back(), found);
    }
  }
  const double half = found.shares.size() == 1
                          ? by_number(found.shares[0].counts, found.sampling, request.confidence)
                          : 0;
  if (half > 0) {
    found.n_for_half =
        samples_for_half_width(found.shares[0].counts.estimate(), 0.5 * half, request.confidence);
  }
  return found;
}

figure::IntervalChart chart_of(const Probability& p) {
  const std::string& of = p.request.condition;
  figure::IntervalChart chart;
  chart.title = concat("How often", of.empty() ? " a fault slides" : ": " + of,
                       p.request.by.empty() ? "" : ", by " + p.request.by);
  chart.remark = concat(p.campaign.name,
                        p.sampling.is_random
                            ? concat("; lines: ", confidence_text(p.request.confidence),
                                     " bounds, undecided cases either way")
                            : "; shares of the cases given; lines: undecided cases either way");
  chart.label = "share of cases";
  for (const Share& share : p.shares) {
    const ShareCounts& c = share.counts;
    std::string note = concat(grouped(c.n_holds), " of ", grouped(c.n_known()));
    if (c.n_undecided > 0) note += concat(", ", grouped(c.n_undecided), " undecided");
    if (c.n_unknown > 0) note += concat(", ", grouped(c.n_unknown), " unknown");
    chart.rows.push_back({share.label, {c.estimate(), share.bounds.low, share.bounds.high}, note});
  }
  return chart;
}

Answer to_answer(const Probability& p) {
  Answer answer;
  const Share& most = most_often(p);
  answer.headline.push_back(
      concat(p.shares.size() == 1 ? "" : "Most often: ", most.condition,
             most.label == most.condition ? "" : concat(" (", p.request.by, " ", most.label, ")"),
             ": ", share_sentence(most.counts, p.sampling, p.request.confidence), "."));
  answer.facts = {{"campaign", p.campaign.name},
                  {"condition", p.request.condition},
                  {"by", p.request.by},
                  {"confidence", p.request.confidence},
                  {"is_probability", p.sampling.is_random},
                  {"remark", p.sampling.remark},
                  {"cases_for_half_the_width", p.n_for_half}};
  answer.add(share_table(p));
  answer.blocks.emplace_back(AnswerChart(chart_of(p)));
  answer.note_if(meaning_of_bounds(p));
  if (p.n_for_half > 0) {
    answer.note(concat("Halving the ± by number needs ", grouped(p.n_for_half), " cases."));
  }
  answer.note_if(p.sampling.remark);
  answer.note_if(p.sampling.approximation);
  return answer;
}

}  // namespace faultsweep
