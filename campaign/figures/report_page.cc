#include "campaign/figures/report_page.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "campaign/answers/probability.h"
#include "campaign/answers/sensitivity.h"
#include "campaign/common/names.h"
#include "campaign/figures/campaign_figures.h"
#include "campaign/query/parameters.h"
#include "campaign/render/render.h"
#include "campaign/reports/ranking_answer.h"
#include "report_css.h"
#include "report_js.h"
#include "simulator/common/base64.h"
#include "simulator/common/fingerprint.h"
#include "simulator/figure/axis.h"
#include "simulator/figure/svg.h"

namespace faultsweep {
namespace {

using faultsim::figure::CaseClass;
using faultsim::figure::escape_xml;
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

/// The page as it is written.
struct Page {
  const Store& store;
  const CampaignInfo& campaign;
  const ReportRequest& request;
  std::string html = {};

  void section(const std::string& id, const std::string& title) {
    html += concat("<h2 id=\"", id, "\">", escape_xml(title), "</h2>\n");
  }
  void paragraph(const std::string& text, const char* kind = "") {
    html += concat("<p", *kind != '\0' ? concat(" class=\"", kind, "\"") : "", ">",
                   escape_xml(text), "</p>\n");
  }
  /// What body adds, or, where the campaign does not have it, the reason: an empty state says why.
  void unless_refused(const std::function<void()>& body) {
    try {
      body();
    } catch (const InputError& error) {
      paragraph(error.problems().front().what + "; " + error.problems().front().cure, "faint");
    }
  }
};

/// The answer in sentences.
void add_summary(Page& page) {
  const CampaignInfo& c = page.campaign;
  const auto counts = count_outcomes(page.store, c);
  const auto of = [&](CaseClass kind) { return counts[static_cast<std::size_t>(kind)]; };
  const long n_full = of(CaseClass::holds) + of(CaseClass::undecided) + of(CaseClass::slides) +
                      of(CaseClass::event);
  if (n_full == 0) {
    page.paragraph(concat("None of the ", count_text(c.n_cases),
                          " cases has a full history yet: faultsweep run ", c.name),
                   "answer");
    return;
  }
  const auto counts_of = [&](const char* condition) {
    const Probability p = find_probability(
        page.store, c, {.condition = condition, .confidence = page.request.confidence});
    return std::pair(p.shares.front().counts, p.sampling);
  };
  const auto [slides, sampling] = counts_of("slides");
  const ShareCounts jumps = counts_of("jumps").first;
  page.paragraph(
      concat("A fault slides in ", share_sentence(slides, sampling, page.request.confidence), ". ",
             jumps.n_holds + jumps.n_undecided == 0
                 ? std::string("No case has a slip event.")
                 : concat("A slip event happens in ",
                          share_sentence(jumps, sampling, page.request.confidence), "."),
             sampling.is_random ? concat(" Bounds have a confidence of ",
                                         plain_number(100 * page.request.confidence, 4), " %.")
                                : std::string()),
      "answer");
  const long n_left = c.n_cases - n_full;
  if (n_left > 0) {
    page.paragraph(concat("Left out: ", count_text(of(CaseClass::ended_early)),
                          " cases whose history ends early and ",
                          count_text(n_left - of(CaseClass::ended_early)), " without a result."),
                   "faint");
  }
}

void add_map(Page& page) {
  page.section("map", "Where it happens");
  page.unless_refused([&] { page.html += draw_outcome_map(page.store, page.campaign, {}); });
}

void add_head(Page& page, const std::vector<std::string>& names) {
  page.html += "<thead><tr>";
  for (const std::string& name : names) page.html += "<th>" + escape_xml(name) + "</th>";
  page.html += "</tr></thead>\n<tbody>\n";
}

std::string cell(const std::string& text) { return "<td>" + escape_xml(text) + "</td>"; }

/// @return the rows that are listed.
std::vector<RankedCase> add_ranking(Page& page) {
  page.section("ranking", "Ranking");
  RankRequest request;
  request.top = kMostRanked;
  Ranking ranking = make_ranking(page.store, page.campaign, request);
  if (ranking.rows.empty()) {
    page.paragraph("No case has a result yet.", "faint");
    return {};
  }
  const auto n = static_cast<long>(ranking.rows.size());
  page.paragraph(concat("Riskiest first, in the order of faultsweep rank",
                        n < page.campaign.n_cases ? concat("; the first ", count_text(n), " of ",
                                                           count_text(page.campaign.n_cases))
                                                  : std::string(),
                        ". A click on a head sorts; below it conditions such as > 50, F2 or !F1."),
                 "faint");
  page.html += render_html(to_answer(ranking));
  return std::move(ranking.rows);
}

/// The steps of a case for the slider, without a "<" that could end the script.
std::string steps_json(const std::vector<faultsim::StepLook>& looks) {
  nlohmann::json steps = nlohmann::json::array();
  for (const faultsim::StepLook& look : looks) {
    nlohmann::json notes = nlohmann::json::object();
    for (const auto& [name, note] : look.notes) notes[name] = note;
    steps.push_back(
        {{"time", look.time}, {"says", look.says}, {"colours", look.colours}, {"notes", notes}});
  }
  std::string text = steps.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at)) {
    text.replace(at, 1, "\\u003c");
  }
  return text;
}

void add_case(Page& page, long position) {
  const StoredCase one = page.store.stored_case(page.campaign.id, std::to_string(position));
  const StoredPicture stored(page.store, page.campaign, one);
  const faultsim::CasePicture picture = stored.picture();
  const std::string settings = settings_of(one.parameters, page.campaign.parameters, short_label);
  page.html += concat("<h3>Case ", position, ": ", escape_xml(settings), "</h3>\n<div data-case=\"",
                      position, "\">\n");
  const bool is_field = picture.scene.geometry_kind == faultsim::GeometryKind::field;
  if (is_field) {
    const std::vector<faultsim::StepLook> looks = step_looks(picture);
    const std::size_t critical = faultsim::critical_moment(one.result).step;
    page.html += concat("<script type=\"application/json\">", steps_json(looks), "</script>\n",
                        "<div class=\"slider\" hidden><label>load step <input type=\"range\" "
                        "min=\"0\" max=\"",
                        looks.size() - 1, "\" value=\"", critical,
                        "\" aria-label=\"load step\"></label><output></output></div>\n");
    page.html += draw_case(picture, {faultsim::CaseChart::section, {}, {}, true});
  }
  page.html += draw_case(picture, {faultsim::CaseChart::history, {}, {}, is_field});
  page.html += "</div>\n";
  if (picture.fields == nullptr) return;
  for (const auto chart : {faultsim::CaseChart::profiles, faultsim::CaseChart::fault_map,
                           faultsim::CaseChart::stress_path}) {
    page.html += draw_case(picture, {chart, {}, {}, false});
  }
}

void add_cases(Page& page, const std::vector<RankedCase>& rows) {
  page.section("cases", "The riskiest cases");
  const std::size_t n = std::min(rows.size(), static_cast<std::size_t>(page.request.top));
  if (n == 0) page.paragraph("No case has a result yet.", "faint");
  for (std::size_t k = 0; k < n; ++k) {
    page.unless_refused([&] { add_case(page, rows[k].position); });
  }
}

void add_answers(Page& page) {
  page.section("how-often", "How often each fault slides");
  page.unless_refused([&] {
    page.html += render_html(to_answer(
        find_probability(page.store, page.campaign, {.confidence = page.request.confidence})));
  });
  page.section("what-matters", "What matters");
  page.unless_refused([&] {
    page.html += render_html(
        what_matters(page.store, page.campaign, {.confidence = page.request.confidence}));
  });
}

void add_outcomes(Page& page) {
  page.section("outcomes", "Outcomes and failures");
  const CampaignInfo& c = page.campaign;
  page.html += "<table>\n";
  add_head(page, {"cases", "converged", "with events", "events unresolved", "ended early", "failed",
                  "waiting"});
  page.html += "<tr>";
  for (const long n : {c.n_cases, c.n_converged, c.n_event, c.n_unresolved,
                       c.n_done - c.n_complete(), c.n_failed, c.n_waiting}) {
    page.html += cell(count_text(n));
  }
  page.html += "</tr>\n</tbody></table>\n";
  constexpr std::size_t kMostReasons = 20;
  const std::vector<FailureCount> failures = page.store.failure_counts(c.id);
  if (failures.empty()) {
    page.paragraph("Nothing failed.", "faint");
    return;
  }
  page.html += "<div class=\"wide\"><table>\n";
  add_head(page, {"cases", "status", "reason"});
  for (std::size_t k = 0; k < std::min(failures.size(), kMostReasons); ++k) {
    page.html += "<tr>" + cell(count_text(failures[k].count)) + cell(failures[k].status) +
                 cell(failures[k].reason) + "</tr>\n";
  }
  page.html += "</tbody></table></div>\n";
  if (failures.size() > kMostReasons) {
    page.paragraph(concat("and ", failures.size() - kMostReasons, " further reasons"), "faint");
  }
}

/// What the page may do: nothing but its own script, known by its hash, its styles and an empty
/// icon. Whatever a name that broke out of the page might ask for, no browser would load or run it.
std::string content_policy() {
  const std::string_view hex = faultsim::embedded::report_js_sha256;
  std::string hash;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    hash += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
  return concat("default-src 'none'; script-src 'sha256-", faultsim::base64(hash),
                "'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'");
}

void add_provenance(Page& page) {
  page.section("provenance", "Where this comes from");
  const Store::SpecCopies spec = page.store.spec_copies(page.campaign.id);
  page.paragraph(concat("Campaign ", page.campaign.name, ", spec ",
                        std::filesystem::path(page.campaign.source).filename().string(),
                        "; expanded cases ", spec.expanded_hash, "; numerics version ",
                        faultsim::kNumericsVersion, "; page by ", page.request.program,
                        ". Equal cases give equal bits; each result is stored under the identity "
                        "of its scene."));
  page.html += "<details><summary>spec as given</summary><pre>" + escape_xml(spec.given) +
               "</pre></details>\n<details><summary>spec with all defaults</summary><pre>" +
               escape_xml(spec.resolved) + "</pre></details>\n";
}

}  // namespace

std::string report_page(const Store& store, const CampaignInfo& campaign,
                        const ReportRequest& request) {
  Page page{store, campaign, request};
  page.html = concat(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"",
      content_policy(),
      "\">\n<meta name=\"viewport\" content=\"width=device-width\">\n"
      "<link rel=\"icon\" href=\"data:,\">\n<title>",
      escape_xml(campaign.name), "</title>\n<style>\n", faultsim::embedded::report_css,
      "</style>\n</head>\n<body>\n<h1>", escape_xml(campaign.name), "</h1>\n");
  page.html +=
      "<nav><a href=\"#map\">map</a><a href=\"#ranking\">ranking</a><a "
      "href=\"#cases\">cases</a><a href=\"#how-often\">how often</a><a "
      "href=\"#what-matters\">what matters</a><a href=\"#outcomes\">outcomes</a><a "
      "href=\"#provenance\">provenance</a></nav>\n";
  add_summary(page);
  add_map(page);
  const std::vector<RankedCase> rows = add_ranking(page);
  add_cases(page, rows);
  add_answers(page);
  add_outcomes(page);
  add_provenance(page);
  page.html += concat("<script>", faultsim::embedded::report_js, "</script>\n</body>\n</html>\n");
  return page.html;
}

}  // namespace faultsweep
