#include "campaign/common/names.h"
#include "campaign/expansion/expansion.h"
#include "campaign/figures/campaign_figures.h"
#include "campaign/serve/route.h"
#include "campaign/serve/sliders.h"
#include "simulator/files/json_text.h"
#include "simulator/page/case_part.h"

namespace faultsweep::serve {
namespace {

/// Section, histories and the slider over the load steps, as in a report.
HttpResponse steps_of_case(const Store& store, const Asked& asked) {
  const CampaignInfo campaign = asked.campaign(store);
  const StoredCase one = asked.stored_case(store, campaign);
  const StoredPicture stored(store, campaign, one);
  faultsim::HtmlPage part("");
  add_case_steps(part, stored.picture(), one.position);
  return {200, "text/html; charset=utf-8", part.body()};
}

HttpResponse what_may_change(const Store& store, const Asked& asked) {
  const CampaignInfo campaign = asked.campaign(store);
  const StoredCase one = asked.stored_case(store, campaign);
  const BaseScene base = store.base_scene(one.scene);
  return {200, "application/json",
          faultsim::json_text(to_json(sliders_of(scene_from_changes(base.document, one.changes),
                                                 store.spec_copies(campaign.id).resolved)))};
}

}  // namespace

const std::vector<Route>& page_routes() {
  static const std::vector<Route> routes = {
      {"/api/campaigns/{campaign}/cases/{case}/steps",
       "section and history with a slider over the load steps, as part of a page",
       {},
       steps_of_case,
       "text/html; charset=utf-8"},
      {"/api/campaigns/{campaign}/cases/{case}/parameters",
       "what what-if may change of it, and in which ranges",
       {},
       what_may_change}};
  return routes;
}

const Route& what_if_route() {
  static const Route route = {
      "/api/campaigns/{campaign}/cases/{case}/what-if",
      "the case with changes, run by a simulator of this server: state building, running, "
      "done, refused, failed or superseded, as described in schemas/what_if_protocol.md",
      {{"changes", "a JSON object: value by JSON Pointer, of those that .../parameters lists"},
       {"chart", "as for `faultsim plot`; may be repeated", true},
       {"fault", "shown in charts; default: the one with the largest χ̄"},
       {"step", "load step shown in charts"},
       {"show", "of a fault map: chi (default), slip, state or pressure"},
       {"cursor", "yes: histories have a line at the step"},
       {"page", "a word that identifies the asking page; the newest question of any page wins"},
       {"ask", "number of the question, larger than those before; the same number keeps waiting"},
       {"wait", "ms to wait for the answer before reporting progress, 0 to 2000, default 1000"}},
      nullptr};
  return route;
}

json question_body(const Asked& asked) {
  const std::string changes = asked.text("changes");
  json body = {
      {"changes", changes.empty() ? json::object() : json::parse(changes, nullptr, false)}};
  if (!body.at("changes").is_object())
    throw HttpError(400, "changes", "it is not a JSON object",
                    "write changes={\"/friction/friction_angle\": \"25 deg\"}");
  body["charts"] = json::array();
  for (const std::string& name : asked.texts("chart")) body["charts"].push_back(name);
  if (const std::string fault = asked.text("fault"); !fault.empty()) body["fault"] = fault;
  constexpr long kMostSteps = 1000000;
  if (const auto step = asked.whole("step", 0, kMostSteps)) body["step"] = *step;
  static const std::vector<std::string> kShows = {"chi", "slip", "state", "pressure"};
  body["show"] = kShows.at(asked.word("show", kShows));
  if (asked.flag("cursor")) body["cursor"] = true;
  return body;
}

std::vector<const Route*> all_routes() {
  std::vector<const Route*> all;
  for (const auto* some : {&answer_routes(), &drawing_routes(), &page_routes()})
    for (const Route& one : *some) all.push_back(&one);
  all.push_back(&what_if_route());
  return all;
}

}  // namespace faultsweep::serve
