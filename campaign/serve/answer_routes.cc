#include <filesystem>

#include "campaign/answers/curves.h"
#include "campaign/answers/limit_table.h"
#include "campaign/answers/posterior.h"
#include "campaign/answers/probability.h"
#include "campaign/answers/quantiles.h"
#include "campaign/answers/sensitivity.h"
#include "campaign/answers/why.h"
#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/render/render.h"
#include "campaign/reports/case_report.h"
#include "campaign/reports/ranking_answer.h"
#include "campaign/reports/status_report.h"
#include "campaign/serve/route.h"
#include "simulator/files/json_text.h"

namespace faultsweep::serve {
namespace {

constexpr long kUsualRows = 20, kMostRows = 1000, kMostPages = 1000000;

constexpr Parameter kAs = {"as", "json (default): as the command prints it with --json; or html"};

/// An answer in the rendering that was asked for.
template <Answer (*find)(const Store&, const Asked&)>
HttpResponse rendered(const Store& store, const Asked& asked) {
  const bool as_html = asked.word("as", {"json", "html"}) == 1;
  const Answer answer = find(store, asked);
  if (as_html) return {200, "text/html; charset=utf-8", render_html(answer)};
  return {200, "application/json", faultsim::json_text(render_json(answer))};
}

Answer campaigns(const Store& store, const Asked&) { return campaigns_answer(store); }

Answer metrics(const Store&, const Asked&) { return metrics_answer(); }

Answer status(const Store& store, const Asked& asked) {
  StatusReport report = make_status(store, asked.campaign(store).name);
  std::string& source = report.campaign.source;
  source = std::filesystem::path(source).filename().string();  // where it was is nobody's business
  return to_answer(report);
}

RankRequest ranked(const Asked& asked) {
  RankRequest request;
  request.by = asked.text("by");
  request.where = asked.text("where");
  request.stage = asked.text("stage");
  request.fault = asked.text("fault");
  request.ascending = asked.word("order", {"descending", "ascending"}) == 1;
  return request;
}

Answer ranking(const Store& store, const Asked& asked) {
  RankRequest request = ranked(asked);
  request.top = asked.whole("rows", 1, kMostRows).value_or(kUsualRows);
  request.skip = request.top * (asked.whole("page", 1, kMostPages).value_or(1) - 1);
  return to_answer(make_ranking(store, asked.campaign(store), request));
}

Answer one_case(const Store& store, const Asked& asked) {
  const CampaignInfo campaign = asked.campaign(store);
  return to_answer(shown_case(store, campaign, asked.stored_case(store, campaign),
                              {asked.text("stage"), asked.text("fault")}));
}

Answer why_ranked(const Store& store, const Asked& asked) {
  const CampaignInfo campaign = asked.campaign(store);
  return to_answer(
      explain_rank(store, campaign, asked.stored_case(store, campaign), ranked(asked)));
}

Answer explained(const Store& store, const Asked& asked) {
  const CampaignInfo campaign = asked.campaign(store);
  return explanation(store, campaign, asked.stored_case(store, campaign));
}

Answer probability(const Store& store, const Asked& asked) {
  ProbabilityRequest request{asked.text("of"), asked.text("where"), asked.text("by"),
                             asked.confidence()};
  request.width = asked.number("width", 1e-4, 1).value_or(0);
  return to_answer(find_probability(store, asked.campaign(store), request));
}

Answer curves(const Store& store, const Asked& asked) {
  const auto axis = static_cast<CurveAxis>(asked.word("against", {"step", "time", "pressure"}));
  return to_answer(
      probability_curves(store, asked.campaign(store),
                         {axis, asked.text("where"), asked.text("stage"), asked.confidence()}));
}

Answer quantiles(const Store& store, const Asked& asked) {
  QuantileRequest request;
  request.metrics = asked.text("metrics");
  if (request.metrics.empty())
    throw HttpError(400, "metrics", "it is missing",
                    "write metrics=chi_bar; GET /api/metrics lists them");
  request.where = asked.text("where");
  request.confidence = asked.confidence();
  return to_answer(find_quantiles(store, asked.campaign(store), request));
}

Answer posterior(const Store& store, const Asked& asked) {
  PosteriorRequest request{asked.texts("seen"), asked.texts("of"), asked.text("where"),
                           asked.confidence()};
  if (request.seen.empty())
    throw HttpError(400, "seen", "it is missing", "write seen=F2 did not slide before 8 yr");
  return to_answer(find_posterior(store, asked.campaign(store), request));
}

Answer sensitivity(const Store& store, const Asked& asked) {
  SensitivityRequest request;
  request.cases = {asked.text("where"), asked.text("stage"), asked.text("fault")};
  request.metrics = asked.text("metrics");
  request.by_step = asked.flag("by_step");
  request.confidence = asked.confidence();
  return what_matters(store, asked.campaign(store), request);
}

Answer limits(const Store& store, const Asked& asked) {
  return to_answer(make_limit_table(store, asked.campaign(store, true)), 0);
}

std::vector<Route> with_rendering(std::vector<Route> routes) {
  for (Route& one : routes) one.parameters.push_back(kAs);
  return routes;
}

const Parameter kWhere = {"where", "only cases where this holds, as for `rank --where`"};
const Parameter kBy = {"by", "metric or expression; default: the spec's, or the riskiest first"};
const Parameter kOrder = {"order", "descending (default) or ascending"};
const Parameter kStage = {"stage", "default: the whole history"};
const Parameter kFault = {"fault", "default: all faults of a case together"};
const Parameter kConfidence = {"confidence", "of the intervals: 0.5 to 0.9999, default 0.95"};

}  // namespace

const std::vector<Route>& answer_routes() {
  static const std::vector<Route> routes = with_rendering(
      {{"/api/campaigns",
        "the campaigns of the store, as in `status --all`",
        {},
        rendered<campaigns>},
       {"/api/metrics",
        "what can be ranked and filtered by, as in `rank --list-metrics`",
        {},
        rendered<metrics>},
       {"/api/campaigns/{campaign}", "its state, as in `status`", {}, rendered<status>},
       {"/api/campaigns/{campaign}/ranking",
        "as in `rank --skip N --top N`",
        {kBy,
         kWhere,
         kOrder,
         {"page", "from 1"},
         {"rows", "of a page, 1 to 1000, default 20"},
         kStage,
         kFault},
        rendered<ranking>},
       {"/api/campaigns/{campaign}/cases/{case}",
        "as in `show`",
        {kStage, kFault},
        rendered<one_case>},
       {"/api/campaigns/{campaign}/cases/{case}/why",
        "why it ranks where it does, as in `rank --why`",
        {kBy, kWhere, kOrder, kStage, kFault},
        rendered<why_ranked>},
       {"/api/campaigns/{campaign}/cases/{case}/explanation",
        "whether it will run, as in `explain`",
        {},
        rendered<explained>},
       {"/api/campaigns/{campaign}/probability",
        "as in `probability`",
        {{"of", "condition; default: that each fault slides, in each stage"},
         {"by", "a parameter: for each of its values, or ten parts of its range"},
         {"width", "wanted distance of the bounds, as a share"},
         kWhere,
         kConfidence},
        rendered<probability>},
       {"/api/campaigns/{campaign}/curves",
        "as in `probability --against`",
        {{"against", "step (default), time or pressure"}, kWhere, kStage, kConfidence},
        rendered<curves>},
       {"/api/campaigns/{campaign}/quantiles",
        "as in `probability --quantiles`",
        {{"metrics", "comma-separated names"}, kWhere, kConfidence},
        rendered<quantiles>},
       {"/api/campaigns/{campaign}/posterior",
        "as in `posterior`",
        {{"seen", "a statement; may be repeated", true},
         {"of", "condition; may be repeated", true},
         kWhere,
         kConfidence},
        rendered<posterior>},
       {"/api/campaigns/{campaign}/sensitivity",
        "as in `sensitivity`",
        {{"metrics", "comma-separated names; default: chi_bar, slip and sliding by fault"},
         {"by_step", "yes: at the end of each load step"},
         kWhere,
         kStage,
         kFault,
         kConfidence},
        rendered<sensitivity>},
       {"/api/campaigns/{campaign}/limits", "as in `limits`", {}, rendered<limits>}});
  return routes;
}

}  // namespace faultsweep::serve
