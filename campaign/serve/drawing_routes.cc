#include "campaign/answers/probability.h"
#include "campaign/answers/sensitivity.h"
#include "campaign/common/names.h"
#include "campaign/figures/campaign_figures.h"
#include "campaign/render/render.h"
#include "campaign/serve/route.h"

namespace faultsweep::serve {
namespace {

HttpResponse svg(std::string drawing) { return {200, "image/svg+xml", std::move(drawing)}; }

HttpResponse outcome_map(const Store& store, const Asked& asked) {
  return svg(draw_outcome_map(store, asked.campaign(store), {asked.text("x"), asked.text("y")}));
}

HttpResponse sensitivity_chart(const Store& store, const Asked& asked) {
  SensitivityRequest request;
  request.metrics = asked.text("metrics");
  request.by_step = asked.flag("by_step");
  std::string drawing = first_chart(what_matters(store, asked.campaign(store), request));
  if (drawing.empty())
    throw HttpError(400, "metrics", "none of these metrics varies", "ask for other metrics");
  return svg(std::move(drawing));
}

HttpResponse probability_chart(const Store& store, const Asked& asked) {
  return svg(faultsim::figure::draw(chart_of(find_probability(
      store, asked.campaign(store), {asked.text("of"), asked.text("where"), asked.text("by")}))));
}

template <faultsim::CaseChart chart>
HttpResponse case_chart(const Store& store, const Asked& asked) {
  constexpr long kMostSteps = 1000000;
  const CampaignInfo campaign = asked.campaign(store);
  const StoredPicture stored(store, campaign, asked.stored_case(store, campaign));
  std::optional<int> step;
  if (const auto given = asked.whole("step", 0, kMostSteps)) step = static_cast<int>(*given);
  faultsim::CaseChartRequest request{chart, asked.text("fault"), step, asked.flag("cursor")};
  if constexpr (chart == faultsim::CaseChart::fault_map)
    request.show =
        static_cast<faultsim::MapField>(asked.word("show", {"chi", "slip", "state", "pressure"}));
  return svg(draw_case(stored.picture(), request));
}

template <faultsim::CaseChart chart>
Route case_route(const char* path, const char* meaning) {
  Route route{path,
              meaning,
              {{"fault", "default: the one with the largest χ̄"},
               {"step", "load step; default: that of its largest χ̄"},
               {"cursor", "yes: mark the step in histories by a line"}},
              case_chart<chart>,
              "image/svg+xml"};
  if (chart == faultsim::CaseChart::fault_map)
    route.parameters.push_back({"show", "chi (default), slip, state or pressure"});
  return route;
}

}  // namespace

const std::vector<Route>& drawing_routes() {
  using faultsim::CaseChart;
  static const std::vector<Route> routes = {
      {"/api/campaigns/{campaign}/map.svg",
       "outcomes of the cases, against two parameters",
       {{"x", "along the bottom; default: the first"}, {"y", "along the side; default: the next"}},
       outcome_map,
       "image/svg+xml"},
      {"/api/campaigns/{campaign}/sensitivity.svg",
       "which parameters matter",
       {{"metrics", "comma-separated names"}, {"by_step", "yes: against time"}},
       sensitivity_chart,
       "image/svg+xml"},
      {"/api/campaigns/{campaign}/probability.svg",
       "how likely something is",
       {{"of", "condition"}, {"where", "only these cases"}, {"by", "a parameter"}},
       probability_chart,
       "image/svg+xml"},
      case_route<CaseChart::history>("/api/campaigns/{campaign}/cases/{case}/history.svg",
                                     "χ̄ of each fault and Δp against time"),
      case_route<CaseChart::thickness>("/api/campaigns/{campaign}/cases/{case}/thickness.svg",
                                       "down-dip length with χ > 0.8 against time"),
      case_route<CaseChart::slip>("/api/campaigns/{campaign}/cases/{case}/slip.svg",
                                  "largest slip of each fault against time"),
      case_route<CaseChart::section>("/api/campaigns/{campaign}/cases/{case}/section.svg",
                                     "cut across a field, faults coloured by χ"),
      case_route<CaseChart::profiles>("/api/campaigns/{campaign}/cases/{case}/profiles.svg",
                                      "pressure, tractions, χ and slip down a fault; needs fields"),
      case_route<CaseChart::fault_map>("/api/campaigns/{campaign}/cases/{case}/fault-map.svg",
                                       "χ, slip, state or pressure on a fault; needs fields"),
      case_route<CaseChart::stress_path>(
          "/api/campaigns/{campaign}/cases/{case}/stress-path.svg",
          "traction at a fault's most critical point; needs fields")};
  return routes;
}

}  // namespace faultsweep::serve
