#include "campaign/reports/tier_certificate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "campaign/common/names.h"
#include "campaign/query/parameters.h"
#include "campaign/render/shown.h"

namespace faultsweep {

namespace {

bool has_full_history(const RankedCase& row) {
  return row.rank_class < 2 && row.score && !std::isnan(*row.score);
}

/// One number per metre of strike, the other in total.
void require_one_kind(const Ranking& before, const Ranking& after) {
  const bool is_other = before.kinds.plane_strain != after.kinds.plane_strain ||
                        before.kinds.total != after.kinds.total;
  if (!is_other || before.extensive.empty()) return;
  throw InputError("--tier",
                   concat(before.extensive,
                          " per metre of strike, at a tier in plane strain, "
                          "cannot be compared with a total"),
                   "rank by a metric other than areas, potencies and moments: --by chi_bar");
}

std::string first_words(const TierCertificate& c) {
  constexpr std::size_t kNamed = 3;
  std::vector<long> first;
  for (const CertifiedCase& one : c.cases)
    if (one.after != nullptr && first.size() < kNamed) first.push_back(one.before->position);
  if (first.empty())
    return concat("None of the ", c.cases.size(), " cases has a full history at ", c.tier_after,
                  ".");
  return concat("By ", c.by, ", the first ", first.size() == 1 ? "case" : "cases", " at ",
                c.tier_after, first.size() == 1 ? " is " : " are ", joined(first, ", "), ".");
}

std::string certain_words(const TierCertificate& c) {
  const std::string run = counted(c.cases.size(), "case", "cases");
  if (!c.next)
    return concat("All ", run, " that have a full history at ", c.tier_before, " were run at ",
                  c.tier_after, ".");
  const long n = c.n_certain();
  if (n == 0)
    return concat("None of the ", run,
                  " run is sure to come before all that were not run, of which one has ",
                  in_unit(*c.next, c.unit), " at ", c.tier_before, ".");
  const double rise = c.largest_rise();
  return concat(n, " of the ", run, " run ", n == 1 ? "comes" : "come",
                " before all that were not run, unless one of those ",
                c.ascending ? "falls" : "rises", " from ", c.tier_before, " to ", c.tier_after,
                rise > 0 ? concat(" by more than ", in_unit(rise, c.unit)) : std::string(" at all"),
                ".");
}

/// What the promise above is to be held against.
std::string change_words(const TierCertificate& c) {
  const auto [least, most] = c.changes();
  if (std::isnan(least)) return "";
  return concat("Of those that were run, ", c.by, " changed by ", in_unit(least, c.unit), " to ",
                in_unit(most, c.unit), ".");
}

AnswerTable table_of(const TierCertificate& c, const Ranking& before) {
  std::vector<const CaseParameters*> rows;
  for (const CertifiedCase& one : c.cases) rows.push_back(&one.before->parameters);
  const ParameterColumns parameters(before.campaign.parameters, rows);
  AnswerTable table{"first",
                    "",
                    {{"place", "place", {}, 4, Need::always},
                     {"case", "case", {}, 4, Need::always},
                     {"before", concat(c.by, " at ", c.tier_before), c.unit, 4, Need::always},
                     {"after", concat("at ", c.tier_after), c.unit, 4, Need::always},
                     {"margin", "margin", c.unit, 3, Need::always},
                     {"slides_before", concat("slides at ", c.tier_before), {}, 4, Need::wanted},
                     {"slides_after", concat("at ", c.tier_after), {}, 4, Need::wanted},
                     {"resolved_after", "resolved", {}, 4, Need::extra},
                     {"case_after", concat("case at ", c.tier_after), {}, 4, Need::extra}}};
  for (AnswerColumn column : parameters.columns()) {
    column.need = Need::extra;
    table.columns.push_back(column);
  }
  long place = 0;
  for (const CertifiedCase& one : c.cases) {
    const RankedCase* after = one.after;
    const auto of_after = [&](auto value) { return after != nullptr ? value() : AnswerCell(); };
    std::vector<AnswerCell> cells = {
        of_after([&] { return AnswerCell(++place); }),
        one.before->position,
        *one.before->score,
        of_after([&] { return AnswerCell(*after->score); }),
        c.margin(one),
        metrics_of(*one.before).activated,
        of_after([&] { return AnswerCell(metrics_of(*after).activated); }),
        of_after([&] { return AnswerCell(is_resolved(*after)); }),
        of_after([&] { return AnswerCell(after->position); })};
    parameters.add_cells(one.before->parameters, cells);
    table.rows.push_back(std::move(cells));
  }
  return table;
}

std::string missing_words(const TierCertificate& c) {
  const auto n = std::ranges::count(c.cases, nullptr, &CertifiedCase::after);
  std::string text;
  if (n > 0) text = concat(n, " of those run have no full history at ", c.tier_after);
  if (c.n_without > 0)
    text += concat(text.empty() ? "" : "; ", counted(c.n_without, "case", "cases"),
                   " without a full history at ", c.tier_before,
                   " were not run: they may come anywhere");
  return text;
}

}  // namespace

std::vector<const RankedCase*> with_full_histories(const Ranking& ranking) {
  std::vector<const RankedCase*> rows;
  for (const RankedCase& row : ranking.rows)
    if (has_full_history(row)) rows.push_back(&row);
  const double sign = ranking.request.ascending ? 1 : -1;
  std::ranges::stable_sort(rows, {}, [sign](const RankedCase* row) { return sign * *row->score; });
  return rows;
}

std::pair<double, double> TierCertificate::changes() const {
  std::vector<double> all;
  for (const CertifiedCase& one : cases)
    if (one.after != nullptr) all.push_back(*one.after->score - *one.before->score);
  if (all.empty()) return {NAN, NAN};
  const auto [least, most] = std::ranges::minmax(all);
  return {least, most};
}

double TierCertificate::largest_rise() const {
  const auto [least, most] = changes();
  return std::fmax(0, ascending ? -least : most);
}

std::optional<double> TierCertificate::margin(const CertifiedCase& one) const {
  if (!next || one.after == nullptr) return std::nullopt;
  return ascending ? *next - *one.after->score : *one.after->score - *next;
}

long TierCertificate::n_certain() const {
  if (!next) return std::ssize(cases) - std::ranges::count(cases, nullptr, &CertifiedCase::after);
  return std::ranges::count_if(cases, [least = largest_rise(), this](const CertifiedCase& one) {
    return margin(one) && *margin(one) > least;
  });
}

TierCertificate tier_certificate(const Ranking& before, const std::vector<long>& positions_after,
                                 const Ranking& after) {
  require_one_kind(before, after);
  const std::vector<const RankedCase*> all = with_full_histories(before);
  FAULTSIM_DEMAND(positions_after.size() <= all.size(), positions_after.size());
  TierCertificate certificate;
  certificate.by = before.request.by;
  certificate.unit = before.by_unit;
  certificate.ascending = before.request.ascending;
  certificate.n_without = std::ssize(before.rows) - std::ssize(all);
  if (positions_after.size() < all.size()) certificate.next = all[positions_after.size()]->score;
  std::unordered_map<long, const RankedCase*> found;
  for (const RankedCase* row : with_full_histories(after)) found[row->position] = row;
  for (std::size_t k = 0; k < positions_after.size(); ++k) {
    const auto at = found.find(positions_after[k]);
    certificate.cases.push_back({all[k], at == found.end() ? nullptr : at->second});
  }
  const double sign = certificate.ascending ? 1 : -1;
  const auto place = [sign](const CertifiedCase& one) {
    return one.after == nullptr ? std::numeric_limits<double>::infinity()
                                : sign * *one.after->score;
  };
  std::ranges::stable_sort(certificate.cases, {}, place);
  return certificate;
}

Answer to_answer(const TierCertificate& certificate, const Ranking& before) {
  Answer answer{{first_words(certificate), certain_words(certificate)}};
  if (const std::string words = change_words(certificate); !words.empty())
    answer.headline.push_back(words);
  answer.facts = {{"campaign", before.campaign.name},
                  {"by", certificate.by},
                  {"ascending", certificate.ascending},
                  {"tier_before", certificate.tier_before},
                  {"tier_after", certificate.tier_after},
                  {"run", certificate.cases.size()},
                  {"certain", certificate.n_certain()},
                  {"largest_rise", certificate.largest_rise()},
                  {"next", certificate.next ? nlohmann::json(*certificate.next) : nlohmann::json()},
                  {"without_full_history", certificate.n_without}};
  answer.note_if(missing_words(certificate));
  answer.add(table_of(certificate, before));
  if (certificate.next)
    answer.note(concat("margin: how far a case that was not run would have to ",
                       certificate.ascending ? "fall" : "rise", " from its ", certificate.by,
                       " at ", certificate.tier_before,
                       " to come before this one; the first of them has ",
                       in_unit(*certificate.next, certificate.unit), " there"));
  return answer;
}

}  // namespace faultsweep
