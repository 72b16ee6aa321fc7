#include "campaign/answers/what_matters.h"
#include "campaign/app/commands.h"
#include "campaign/figures/campaign_figures.h"
#include "campaign/figures/report_page.h"
#include "campaign/render/render_html.h"
#include "simulator/case_figures/picture_file.h"
#include "simulator/common/errors.h"

namespace faultsweep {
namespace {

using faultsim::concat;
using faultsim::InputError;

std::string draw_campaign(const PlotArguments& arguments, const Store& store) {
  const CampaignInfo campaign = store.campaign(arguments.subject, false);
  if (arguments.chart == "map") return draw_outcome_map(store, campaign, arguments.map);
  if (arguments.chart == "sensitivity") {
    const std::string chart = first_chart(what_matters(store, campaign, arguments.sensitivity));
    if (!chart.empty()) return chart;
    throw InputError("sensitivity", {{"", 0, "nothing of this varies", "ask for other --metrics"}});
  }
  if (arguments.chart == "probability") {
    return faultsim::figure::draw(
        chart_of(find_probability(store, campaign, arguments.probability)));
  }
  std::string names = "map, sensitivity, probability";
  for (const faultsim::CaseChartInfo& info : faultsim::case_charts()) {
    names += std::string(", ") + info.name;
  }
  throw InputError("chart", {{"", 0, concat("\"", arguments.chart, "\" is not a chart"),
                              "choose one of " + names}});
}

/// CAMPAIGN/CASE, or CASE of the newest campaign.
std::string draw_case_of(const PlotArguments& arguments, const faultsim::CaseChartInfo& info,
                         const Store& store) {
  const std::size_t slash = arguments.subject.rfind('/');
  const bool has_campaign = slash != std::string::npos;
  const std::string name = has_campaign ? arguments.subject.substr(slash + 1) : arguments.subject;
  if (name.empty()) {
    throw InputError("subject", {{"", 0, concat("a ", info.name, " is of one case"),
                                  "name it: CAMPAIGN/CASE, or its number"}});
  }
  const CampaignInfo campaign =
      store.campaign(has_campaign ? arguments.subject.substr(0, slash) : "", false);
  const StoredCase one = store.stored_case(campaign.id, name);
  const StoredPicture stored(store, campaign, one);
  return draw_case(stored.picture(), {info.chart, arguments.fault, arguments.step, false});
}

}  // namespace

ExitCode plot_command(const StoreArguments& common, const PlotArguments& arguments) {
  faultsim::require_picture_file(arguments.output, {".svg", ".png"}, {});
  const Store store = Store::open_reader(common.store);
  const faultsim::CaseChartInfo* info = faultsim::case_chart_named(arguments.chart);
  faultsim::write_picture(arguments.output, info != nullptr ? draw_case_of(arguments, *info, store)
                                                            : draw_campaign(arguments, store));
  return ExitCode::done;
}

ExitCode report_command(const StoreArguments& common, const ReportArguments& arguments) {
  faultsim::require_picture_file(arguments.output, {".html"}, {});
  const Store store = Store::open_reader(common.store);
  const CampaignInfo campaign = store.campaign(common.campaign);
  faultsim::write_picture(arguments.output, report_page(store, campaign, arguments.request));
  return ExitCode::done;
}

}  // namespace faultsweep
