#include "campaign/figures/report_page.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <tuple>

#include "campaign/answers/curves.h"
#include "campaign/answers/limit_table.h"
#include "campaign/answers/probability.h"
#include "campaign/answers/sensitivity.h"
#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/figures/campaign_figures.h"
#include "campaign/figures/how_sure.h"
#include "campaign/query/parameters.h"
#include "campaign/render/render.h"
#include "campaign/reports/ranking_answer.h"
#include "simulator/common/fingerprint.h"
#include "simulator/figure/axis.h"
#include "simulator/page/case_part.h"

namespace faultsweep {
namespace {

using faultsim::HtmlPage;
using faultsim::figure::CaseClass;
using faultsim::figure::plain_number;

std::string count_text(long n) { return plain_number(static_cast<double>(n), 12); }

/// "15.0943434363654 deg" as "15.09 deg": samples have more digits than a reader needs.
std::string short_label(const std::string& label) {
  char* end = nullptr;
  const double value = std::strtod(label.c_str(), &end);
  constexpr int kDigits = 4;
  const bool is_number = end != label.c_str() && std::isfinite(value) && (*end == ' ' || *end == 0);
  return is_number ? plain_number(value, kDigits) + end : label;
}

/// "friction angle 15.09 deg, offset 100 m", with the digits that a heading has room for.
std::string settings_text(const CaseParameters& values,
                          const std::vector<StoredParameter>& parameters) {
  std::string text;
  for (const CaseParameter& one : values) {
    if (one.text.empty()) continue;
    const std::string& name = parameters.at(static_cast<std::size_t>(one.index)).name;
    text += concat(text.empty() ? "" : ", ", parameter_label(name), " ", short_label(one.text));
  }
  return text;
}

/// The page as it is written.
struct Report {
  const Store& store;
  const CampaignInfo& campaign;
  const ReportRequest& request;
  faultsim::HtmlPage page = faultsim::HtmlPage(campaign.name);
  std::optional<Probability> sliding = {};  ///< by sliding_of.
};

/// How often each fault slides in each stage, counted once for the page.
const Probability& sliding_of(Report& report) {
  if (!report.sliding) {
    report.sliding =
        find_probability(report.store, report.campaign, {.confidence = report.request.confidence});
  }
  return *report.sliding;
}

/// "Most often it is F2 in gas_storage: 12 of 60 cases, 20 %."; "" where none slides in any stage.
std::string most_often(Report& report) {
  const std::string in_stage = ".slides in ";
  const Probability& all = sliding_of(report);
  std::vector<Share> shares = all.shares;
  std::erase_if(shares, [&](const Share& share) {
    return share.counts.n_holds == 0 || share.label.find(in_stage) == std::string::npos;
  });
  if (shares.empty()) return "";
  const Share& most = *std::ranges::max_element(
      shares, {}, [](const Share& share) { return share.counts.n_holds; });
  const std::size_t end_of_name = most.label.find(in_stage);
  return concat(" Most often it is ", most.label.substr(0, end_of_name), " in ",
                most.label.substr(end_of_name + in_stage.size()), ": ",
                share_sentence(most.counts, all.sampling, report.request.confidence), ".");
}

/// The answer in sentences.
void add_summary(Report& report) {
  const CampaignInfo& c = report.campaign;
  const auto counts = count_outcomes(report.store, c);
  const auto of = [&](CaseClass kind) { return counts[static_cast<std::size_t>(kind)]; };
  const long n_full = of(CaseClass::holds) + of(CaseClass::undecided) + of(CaseClass::slides) +
                      of(CaseClass::event);
  if (n_full == 0) {
    report.page.paragraph(concat("None of the ", count_text(c.n_cases),
                                 " cases has a full history yet: faultsweep run ", c.name),
                          "answer");
    return;
  }
  const auto counts_of = [&](const char* condition) {
    const Probability p = find_probability(
        report.store, c, {.condition = condition, .confidence = report.request.confidence});
    return std::pair(p.shares.front().counts, p.sampling);
  };
  const auto [slides, sampling] = counts_of("slides");
  const ShareCounts jumps = counts_of("jumps").first;
  report.page.paragraph(
      concat("A fault slides in ", share_sentence(slides, sampling, report.request.confidence), ".",
             most_often(report), " ",
             jumps.n_holds + jumps.n_undecided == 0
                 ? std::string("No case has a slip event.")
                 : concat("A slip event happens in ",
                          share_sentence(jumps, sampling, report.request.confidence), "."),
             sampling.is_random ? concat(" Bounds have a confidence of ",
                                         plain_number(100 * report.request.confidence, 4), " %.")
                                : std::string()),
      "answer");
  const long n_left = c.n_cases - n_full;
  if (n_left > 0) {
    report.page.paragraph(
        concat("Left out: ", count_text(of(CaseClass::ended_early)),
               " cases whose history ends early and ",
               count_text(n_left - of(CaseClass::ended_early)), " without a result."),
        "faint");
  }
}

void add_map(Report& report) {
  report.page.section("map", "Where it happens");
  report.page.unless_refused(
      [&] { report.page.chart(draw_outcome_map(report.store, report.campaign, {})); });
}

/// @return the rows that are listed.
std::vector<RankedCase> add_ranking(Report& report) {
  report.page.section("ranking", "Ranking");
  RankRequest request;
  request.top = 0;
  Ranking ranking = make_ranking(report.store, report.campaign, request);
  if (ranking.rows.empty()) {
    report.page.paragraph("No case has a result yet.", "faint");
    return {};
  }
  const auto n = static_cast<long>(ranking.rows.size());
  report.page.paragraph(
      concat("Riskiest first, in the order of faultsweep rank",
             n < report.campaign.n_cases
                 ? concat("; ", count_text(n), " of ", count_text(report.campaign.n_cases),
                          " cases have a result")
                 : std::string(),
             ". Click a heading to sort; type a condition below it: > 50, F2 or !F1."),
      "faint");
  report.page.add(render_html(answer_of_page(ranking)));
  return std::move(ranking.rows);
}

/// Why a picture cannot show them: no folder, as pages are read on other machines.
std::string why_no_fields(const CampaignInfo& campaign, const StoredCase& one) {
  switch (one.fields) {
    case FieldsState::none:
      return "were not kept (keep_fields: stages in the spec keeps those of all cases)";
    case FieldsState::wanted:
      return concat("are not written yet: faultsweep run ", campaign.name, " writes them");
    case FieldsState::failed:
      return concat("could not be written: faultsweep show ", campaign.name, '/', one.position,
                    " shows why");
    case FieldsState::kept:
      break;
  }
  return "are gone";
}

void add_case(Report& report, long position) {
  const StoredCase one = report.store.stored_case(report.campaign.id, std::to_string(position));
  const StoredPicture stored(report.store, report.campaign, one);
  const std::string settings = settings_text(one.parameters, report.campaign.parameters);
  report.page.heading(concat("Case ", position, ": ", settings));
  add_case_part(report.page, stored.picture(), position);
  if (stored.picture().fields != nullptr) return;
  report.page.paragraph(concat("Depth profiles, fault map and stress path are drawn from the fault "
                               "fields of the case, which ",
                               why_no_fields(report.campaign, one), "."),
                        "faint");
}

void add_cases(Report& report, const std::vector<RankedCase>& rows) {
  report.page.section("cases", "The riskiest cases");
  const std::size_t n = std::min(rows.size(), static_cast<std::size_t>(report.request.top));
  if (n == 0) report.page.paragraph("No case has a result yet.", "faint");
  for (std::size_t k = 0; k < n; ++k) {
    report.page.unless_refused([&] { add_case(report, rows[k].position); });
  }
}

void add_answers(Report& report) {
  HtmlPage& page = report.page;
  page.section("how-often", "How often each fault slides");
  page.unless_refused([&] { page.add(render_html(to_answer(sliding_of(report)))); });
  page.section("how-soon", "How soon each fault begins to slide");
  page.unless_refused([&] {
    page.add(render_html(to_answer(
        probability_curves(report.store, report.campaign,
                           {.axis = CurveAxis::time, .confidence = report.request.confidence}))));
  });
  page.section("what-matters", "What matters");
  page.unless_refused([&] {
    page.add(render_html(
        what_matters(report.store, report.campaign, {.confidence = report.request.confidence})));
  });
}

/// Of a campaign that searches limits.
void add_limits(Report& report) {
  const std::string spec = report.store.spec_copies(report.campaign.id).resolved;
  if (!json::parse(spec).contains("limits")) return;
  report.page.section("limits", "Safe limits");
  report.page.unless_refused([&] {
    report.page.add(render_html(to_answer(make_limit_table(report.store, report.campaign), 0)));
  });
}

void add_how_sure(Report& report) {
  report.page.section("how-sure", "How sure");
  report.page.unless_refused([&] {
    report.page.add(
        render_html(how_sure(report.store, report.campaign, report.request.confidence)));
  });
}

AnswerTable outcomes_table(const CampaignInfo& c) {
  AnswerTable table{"outcomes", "", {}};
  std::vector<AnswerCell> row;
  for (const auto& [key, heading, n] :
       std::initializer_list<std::tuple<const char*, const char*, long>>{
           {"cases", "cases", c.n_cases},
           {"converged", "converged", c.n_converged},
           {"events", "with events", c.n_event},
           {"unresolved", "events unresolved", c.n_unresolved},
           {"ended_early", "ended early", c.n_done - c.n_complete()},
           {"failed", "failed", c.n_failed},
           {"waiting", "waiting", c.n_waiting}}) {
    table.columns.push_back({key, heading});
    row.emplace_back(n);
  }
  table.rows.push_back(std::move(row));
  return table;
}

AnswerTable failures_table(const std::vector<FailureCount>& failures) {
  constexpr std::size_t kMostReasons = 20;
  AnswerTable table{
      "failures", "", {{"cases", "cases"}, {"status", "status"}, {"reason", "reason"}}};
  table.most_on_screen = kMostReasons;
  for (const FailureCount& failure : failures)
    table.rows.push_back({failure.count, failure.status, failure.reason});
  return table;
}

void add_outcomes(Report& report) {
  report.page.section("outcomes", "Outcomes and failures");
  Answer answer;
  answer.add(outcomes_table(report.campaign));
  const std::vector<FailureCount> failures = report.store.failure_counts(report.campaign.id);
  if (failures.empty()) {
    answer.note("Nothing failed.");
  } else {
    answer.add(failures_table(failures));
  }
  report.page.add(render_html(answer));
}

void add_provenance(Report& report) {
  report.page.section("provenance", "Where this comes from");
  const Store::SpecCopies spec = report.store.spec_copies(report.campaign.id);
  report.page.paragraph(concat(
      "Campaign ", report.campaign.name, ", spec ",
      std::filesystem::path(report.campaign.source).filename().string(), "; expanded cases ",
      spec.expanded_hash, "; numerics version ", faultsim::kNumericsVersion, "; page by ",
      report.request.program,
      ". Equal cases give equal bits; each result is stored under the identity of its scene."));
  report.page.details("spec as given", spec.given);
  report.page.details("spec with all defaults", spec.resolved);
}

}  // namespace

std::string report_page(const Store& store, const CampaignInfo& campaign,
                        const ReportRequest& request) {
  Report report{store, campaign, request};
  add_summary(report);
  add_map(report);
  const std::vector<RankedCase> rows = add_ranking(report);
  add_cases(report, rows);
  add_limits(report);
  add_answers(report);
  add_how_sure(report);
  add_outcomes(report);
  add_provenance(report);
  return report.page.finish();
}

}  // namespace faultsweep
