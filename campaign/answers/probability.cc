#include "campaign/answers/probability.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <unordered_map>

#include "campaign/report/table_output.h"
#include "campaign/report/text_table.h"

namespace faultsweep {

using faultsim::concat;
using faultsim::InputError;
using nlohmann::json;

namespace {

constexpr std::size_t kMostValues = 12;  ///< of a parameter that is not cut into parts.
constexpr std::size_t kParts = 10;

/// The rows that were asked about.
struct Rows {
  std::vector<char> complete;
  std::vector<double> value;             ///< of `by`; NaN for words and where the case has none.
  std::vector<std::string> label;        ///< of `by`.
  std::vector<std::vector<char>> holds;  ///< of a condition, of a row.
  long n_unresolved = 0;
};

int parameter_index(const CampaignInfo& campaign, const std::string& name) {
  std::vector<std::string> names;
  for (const StoredParameter& one : parameters_from_json(campaign.parameters))
    names.push_back(one.name);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) require_name("--by", "parameter", name, names);
  return static_cast<int>(found - names.begin());
}

/// One pass over the cases: every condition is a column.
Rows read_rows(const Store& store, const CampaignInfo& campaign, const ProbabilityRequest& request,
               const Selection& selection, const std::vector<std::string>& conditions) {
  const int by = request.by.empty() ? -1 : parameter_index(campaign, request.by);
  Store::TableQuery query;
  query.where = parse_condition(request.where, campaign, selection);
  for (const std::string& condition : conditions)
    query.columns.push_back(parse_condition(condition, campaign, selection));
  Rows rows;
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
      rows.complete.push_back(row.complete() ? 1 : 0);
      rows.value.push_back(value);
      rows.label.push_back(label);
      rows.n_unresolved += row.rank_class && *row.rank_class == 1 ? 1 : 0;
      for (std::size_t c = 0; c < conditions.size(); ++c)
        rows.holds[c].push_back(number_of(row.metrics[c]) == 1 ? 1 : 0);
    }
  });
  return rows;
}

Share share_of(std::string label, const std::vector<std::size_t>& chosen,
               const std::vector<char>& complete, const std::vector<char>& holds,
               double confidence) {
  Share share;
  share.label = std::move(label);
  share.n = static_cast<long>(chosen.size());
  for (const std::size_t k : chosen) {
    share.n_unknown += complete[k] == 0 ? 1 : 0;
    share.n_holds += complete[k] != 0 && holds[k] != 0 ? 1 : 0;
  }
  share.estimate =
      static_cast<double>(share.n_holds) / static_cast<double>(share.n - share.n_unknown);
  share.bounds = proportion_bounds(share.n_holds, share.n_unknown, share.n, confidence);
  return share;
}

void set_more(Share& share, const ProbabilityRequest& request) {
  const long n_known = share.n - share.n_unknown;
  if (n_known == 0 || share.bounds.high - share.bounds.low <= request.width) return;
  share.n_more =
      std::max(0L, samples_for_half_width(share.estimate, 0.5 * request.width, request.confidence) -
                       n_known);
}

using Part = std::pair<std::string, std::vector<std::size_t>>;

/// Rows of equal label, in the order in which labels come first; nothing if there are more than
/// `most`.
std::vector<Part> parts_by_label(const std::vector<std::size_t>& order, const Rows& rows,
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

/// Rows in groups, each with a name: by value where there are few, else ten of equal number.
std::vector<Part> parts_of(const Rows& rows) {
  std::vector<std::size_t> order(rows.label.size());
  std::iota(order.begin(), order.end(), 0u);
  const bool are_numbers = std::none_of(rows.value.begin(), rows.value.end(),
                                        [](double value) { return std::isnan(value); });
  if (!are_numbers) return parts_by_label(order, rows, order.size());
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return rows.value[a] < rows.value[b]; });
  std::vector<Part> parts = parts_by_label(order, rows, kMostValues);
  if (!parts.empty()) return parts;
  for (std::size_t part = 0; part < kParts; ++part) {
    const std::size_t from = part * order.size() / kParts, to = (part + 1) * order.size() / kParts;
    parts.push_back(
        {concat(short_number(rows.label[order[from]]), " to ",
                short_number(rows.label[order[to - 1]])),
         {order.begin() + static_cast<long>(from), order.begin() + static_cast<long>(to)}});
  }
  return parts;
}

/// All rows, under no name, where nothing is asked by parts.
std::vector<Part> parts_asked(const Rows& rows, const std::string& by) {
  if (!by.empty()) return parts_of(rows);
  std::vector<std::size_t> all(rows.label.size());
  std::iota(all.begin(), all.end(), 0u);
  return {{"", all}};
}

std::string percent(double share) {
  return std::isfinite(share) ? concat(format_number(100 * share, 3), " %") : "not known";
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
  Probability found{campaign, request, sampling_of(store, campaign), {}, 0, 0};
  const std::vector<std::string> conditions = request.condition.empty()
                                                  ? default_conditions(selection)
                                                  : std::vector<std::string>{request.condition};
  const Rows rows = read_rows(store, campaign, request, selection, conditions);
  if (rows.label.empty()) {
    throw InputError("probability",
                     {{"", 0, "no case was selected", "ask for others with --where"}});
  }
  found.n_unresolved = rows.n_unresolved;
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
          share_of(std::move(name), chosen, rows.complete, rows.holds[c], request.confidence));
      if (request.width > 0) set_more(found.shares.back(), request);
    }
  }
  if (found.shares.size() == 1 && found.shares[0].n_unknown < found.shares[0].n) {
    const Share& one = found.shares[0];
    found.n_for_half = samples_for_half_width(
        one.estimate, 0.25 * (one.bounds.high - one.bounds.low), request.confidence);
  }
  return found;
}

std::string probability_to_text(const Probability& p) {
  const std::string what = p.sampling.is_random ? "probability" : "share";
  TextTable table({p.request.by.empty() ? "condition" : p.request.by, what, "from", "to", "true in",
                   "of", "not known", "more for width"});
  for (const Share& one : p.shares) {
    table.add_row({one.label, percent(one.estimate), percent(one.bounds.low),
                   percent(one.bounds.high), std::to_string(one.n_holds), std::to_string(one.n),
                   one.n_unknown > 0 ? std::to_string(one.n_unknown) : "",
                   one.n_more > 0 ? std::to_string(one.n_more) : ""});
  }
  std::string text;
  if (!p.request.condition.empty() && !p.request.by.empty()) text = p.request.condition + "\n";
  text += table.text();
  text += concat("\nBounds hold the ", what, " with a confidence of ",
                 format_number(100 * p.request.confidence, 4),
                 " %; what is not known may be either.\n");
  if (p.n_unresolved > 0) {
    text +=
        concat(p.n_unresolved,
               " cases have an activation or event that the cells do not resolve: counted as they "
               "are\n");
  }
  if (p.n_for_half > 0) {
    text += concat("half the distance between the bounds takes ", p.n_for_half, " cases\n");
  }
  if (!p.sampling.remark.empty()) text += p.sampling.remark + "\n";
  return text;
}

json probability_to_json(const Probability& p) {
  json shares = json::array();
  for (const Share& one : p.shares) {
    shares.push_back({{"label", one.label},
                      {"estimate", std::isfinite(one.estimate) ? json(one.estimate) : json()},
                      {"low", one.bounds.low},
                      {"high", one.bounds.high},
                      {"holds", one.n_holds},
                      {"rows", one.n},
                      {"unknown", one.n_unknown},
                      {"more_for_width", one.n_more}});
  }
  return {{"campaign", p.campaign.name},
          {"condition", p.request.condition},
          {"by", p.request.by},
          {"confidence", p.request.confidence},
          {"is_probability", p.sampling.is_random},
          {"remark", p.sampling.remark},
          {"unresolved", p.n_unresolved},
          {"cases_for_half_the_width", p.n_for_half},
          {"shares", shares}};
}

}  // namespace faultsweep
