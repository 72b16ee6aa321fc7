#include "campaign/answers/probability.h"
#include "campaign/answers/sensitivity.h"
#include "campaign/app/commands.h"
#include "campaign/common/names.h"
#include "campaign/figures/campaign_figures.h"
#include "campaign/figures/report_page.h"
#include "campaign/render/render.h"
#include "simulator/case_figures/picture_file.h"
#include "simulator/common/errors.h"
#include "simulator/common/version.h"

namespace faultsweep {
namespace {

struct PlotArguments {
  std::string chart;             ///< of case_charts(), or map, sensitivity, probability.
  std::string subject;           ///< campaign, or CAMPAIGN/CASE; "" = the newest campaign.
  std::filesystem::path output;  ///< .svg or .png.
  std::string fault;             ///< of charts of a case; "" = the most critical one.
  std::optional<int> step;       ///< the same; none = the most critical one.
  MapRequest map = {};
  SensitivityRequest sensitivity = {};
  ProbabilityRequest probability = {};
};

struct ReportArguments {
  std::filesystem::path output;  ///< .html.
  ReportRequest request;
};

std::string draw_campaign(const PlotArguments& arguments, const Store& store) {
  const CampaignInfo campaign = store.campaign(arguments.subject, false);
  if (arguments.chart == "map") return draw_outcome_map(store, campaign, arguments.map);
  if (arguments.chart == "sensitivity") {
    const std::string chart = first_chart(what_matters(store, campaign, arguments.sensitivity));
    if (!chart.empty()) return chart;
    throw InputError("sensitivity", "nothing of this varies", "ask for other --metrics");
  }
  if (arguments.chart == "probability") {
    return faultsim::figure::draw(
        chart_of(find_probability(store, campaign, arguments.probability)));
  }
  std::string names = "map, sensitivity, probability";
  for (const faultsim::CaseChartInfo& info : faultsim::case_charts()) {
    names += std::string(", ") + info.name;
  }
  throw InputError("chart", concat("\"", arguments.chart, "\" is not a chart"),
                   "choose one of " + names);
}

std::string draw_case_of(const PlotArguments& arguments, const faultsim::CaseChartInfo& info,
                         const Store& store) {
  if (arguments.subject.empty() || arguments.subject.ends_with('/')) {
    throw InputError("subject", concat("a ", info.name, " is of one case"),
                     "name it: CAMPAIGN/CASE, or its number");
  }
  const NamedCase found = find_case(store, "", arguments.subject);
  const StoredPicture stored(store, found.campaign, found.stored);
  return draw_case(stored.picture(), {info.chart, arguments.fault, arguments.step, false});
}

ExitCode plot(const StoreArguments& common, const PlotArguments& arguments) {
  faultsim::require_picture_file(arguments.output, {".svg", ".png"}, {});
  const Store store = Store::open_reader(common.store);
  const faultsim::CaseChartInfo* info = faultsim::case_chart_named(arguments.chart);
  faultsim::write_picture(arguments.output, info != nullptr ? draw_case_of(arguments, *info, store)
                                                            : draw_campaign(arguments, store));
  return ExitCode::done;
}

ExitCode report(const StoreArguments& common, const ReportArguments& arguments) {
  faultsim::require_picture_file(arguments.output, {".html"}, {});
  const Store store = Store::open_reader(common.store);
  const CampaignInfo campaign = store.campaign(common.campaign);
  faultsim::write_picture(arguments.output, report_page(store, campaign, arguments.request));
  return ExitCode::done;
}

}  // namespace

void add_pictures(Program& program) {
  std::string charts = "of a campaign: map, sensitivity, probability;\nof a case one of:";
  for (const faultsim::CaseChartInfo& info : faultsim::case_charts()) {
    charts += std::string("\n") + info.name + ": " + info.meaning;
  }
  auto [command, a] = program.add("plot", "draw a chart as SVG or PNG", plot);
  command->add_option("chart", a.chart, charts)->required();
  command->add_option("subject", a.subject,
                      "campaign (default: the newest), or a case: number or CAMPAIGN/CASE");
  command->add_option("-o,--output", a.output, "file to write: *.svg, or *.png by rsvg-convert")
      ->required();
  command->add_option("--fault", a.fault, "of a case; default: the one with the largest χ̄");
  command->add_option("--step", a.step, "of a case: load step; default: that of its largest χ̄");
  command->add_option("--x", a.map.x, "map: parameter along the bottom; default: the first");
  command->add_option("--y", a.map.y, "map: parameter along the side; default: the next");
  command->add_option("--metrics", a.sensitivity.metrics, "sensitivity: as of `sensitivity`");
  command->add_flag("--by-step", a.sensitivity.by_step, "sensitivity: against time");
  command->add_option("--of", a.probability.condition, "probability: as of `probability`");
  command->add_option("--by", a.probability.by, "probability: as of `probability`");
  add_store(command, program.common);
  command->footer(
      "Examples:\n"
      "  faultsweep plot map my-sweep --x offset --y friction_angle -o map.svg\n"
      "  faultsweep plot sensitivity -o tornado.png\n"
      "  faultsweep plot history my-sweep/17 -o history.svg");

  auto [report_command, page] =
      program.add("report", "a campaign as one HTML page that needs no network", report);
  add_campaign(report_command, program.common);
  report_command->add_option("-o,--output", page.output, "file to write: *.html")->required();
  report_command->add_option("--top", page.request.top, "cases that are drawn (default 3)")
      ->check(CLI::Range(0, 50));
  add_confidence(report_command, page.request.confidence);
  page.request.program = faultsim::version_text("faultsweep");
  report_command->footer("Example: faultsweep report my-sweep -o report.html");
}

}  // namespace faultsweep
