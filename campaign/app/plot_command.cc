#include <map>

#include "campaign/answers/curves.h"
#include "campaign/answers/limit_table.h"
#include "campaign/answers/probability.h"
#include "campaign/answers/sensitivity.h"
#include "campaign/app/commands.h"
#include "campaign/common/names.h"
#include "campaign/figures/campaign_figures.h"
#include "campaign/figures/report_page.h"
#include "campaign/render/render.h"
#include "campaign/tradeoff/stored_trade.h"
#include "simulator/case_figures/picture_file.h"
#include "simulator/common/errors.h"
#include "simulator/common/version.h"

namespace faultsweep {
namespace {

constexpr const char* kCampaignCharts = "map, sensitivity, probability, curves, limits, trade";

struct PlotArguments {
  std::string chart;             ///< of case_charts(), or of kCampaignCharts.
  std::string subject;           ///< campaign, or CAMPAIGN/CASE; "" = the newest campaign.
  std::filesystem::path output;  ///< .svg or .png.
  std::string fault;             ///< of charts of a case; "" = the most critical one.
  std::optional<int> step;       ///< the same; none = the most critical one.
  std::string show = "chi";      ///< of a fault map: a word of MapField.
  std::string before = {};       ///< of a case: another, drawn as thin lines; "" = none.
  MapRequest map = {};
  SensitivityRequest sensitivity = {};
  ProbabilityRequest probability = {};
  CurveRequest curves = {};
};

struct ReportArguments {
  std::filesystem::path output;  ///< .html.
  ReportRequest request;
};

std::string draw_curves(const PlotArguments& arguments, const Store& store,
                        const CampaignInfo& campaign) {
  if (arguments.curves.axis == CurveAxis::pressure) {
    throw InputError("--against",
                     "there is no chart against pressure: it runs differently in each stage",
                     "choose step or time; for the numbers: faultsweep probability "
                     "--against pressure");
  }
  const std::string chart =
      first_chart(to_answer(probability_curves(store, campaign, arguments.curves)));
  if (!chart.empty()) return chart;
  throw InputError("curves", "the cases have no faults", "plot another campaign");
}

std::string draw_limits(const Store& store, const CampaignInfo& campaign) {
  const std::string chart = first_chart(to_answer(make_limit_table(store, campaign), 0));
  if (!chart.empty()) return chart;
  throw InputError("limits", "nothing of " + campaign.name + " has been searched yet",
                   "run it: faultsweep run " + campaign.name);
}

std::string draw_trade(const Store& store, const CampaignInfo& campaign) {
  const std::optional<TradeRecord> trade = trade_of(store, campaign);
  if (!trade) {
    throw InputError("trade", "the cost of the cells of " + campaign.name + " was not measured",
                     "measure it: faultsweep tradeoff SPEC.json");
  }
  const std::string chart = first_chart(to_answer(*trade));
  if (!chart.empty()) return chart;
  throw InputError("trade", "no mesh has both an error and a cost",
                   "allow more: faultsweep tradeoff --operator-limit, --memory");
}

std::string draw_campaign(const PlotArguments& arguments, const Store& store) {
  const CampaignInfo campaign = store.campaign(arguments.subject, false);
  if (arguments.chart == "map") return draw_outcome_map(store, campaign, arguments.map);
  if (arguments.chart == "sensitivity") {
    const std::string chart = first_chart(what_matters(store, campaign, arguments.sensitivity));
    if (!chart.empty()) return chart;
    throw InputError("sensitivity", "none of these metrics varies", "ask for other --metrics");
  }
  if (arguments.chart == "probability") {
    return faultsim::figure::draw(
        chart_of(find_probability(store, campaign, arguments.probability)));
  }
  if (arguments.chart == "curves") return draw_curves(arguments, store, campaign);
  if (arguments.chart == "limits") return draw_limits(store, campaign);
  if (arguments.chart == "trade") return draw_trade(store, campaign);
  std::string names = kCampaignCharts;
  for (const faultsim::CaseChartInfo& info : faultsim::case_charts()) {
    names += std::string(", ") + info.name;
  }
  throw InputError("chart", concat("\"", arguments.chart, "\" is not a chart"),
                   "choose one of " + names);
}

std::string draw_case_of(const PlotArguments& arguments, const faultsim::CaseChartInfo& info,
                         const Store& store) {
  if (arguments.subject.empty() || arguments.subject.ends_with('/')) {
    throw InputError("subject", concat("a ", info.name, " shows one case"),
                     "name it: CAMPAIGN/CASE, or its number");
  }
  const faultsim::MapField show = faultsim::field_shown("--show", arguments.show);
  require_shows(info, show);
  const NamedCase found = find_case(store, "", arguments.subject);
  const StoredPicture stored(store, found.campaign, found.stored);
  faultsim::CasePicture picture = stored.picture();
  std::optional<StoredPicture> earlier;
  std::optional<faultsim::CasePicture> original;
  if (!arguments.before.empty()) {
    require_draws_original(info);
    const NamedCase other = find_case(store, found.campaign.name, arguments.before);
    original.emplace(earlier.emplace(store, other.campaign, other.stored).picture());
    picture.original = &*original;
  }
  return draw_case(picture, {info.chart, arguments.fault, arguments.step, false, show});
}

ExitCode plot(const StoreArguments& common, const PlotArguments& arguments) {
  faultsim::require_picture_file(arguments.output, {".svg", ".png"}, {});
  const Store store = Store::open_reader(common.store);
  const faultsim::CaseChartInfo* info = faultsim::case_chart_named(arguments.chart);
  if (info == nullptr && !arguments.before.empty()) {
    throw InputError("--before", "is for charts of one case, which " + arguments.chart + " is not",
                     "leave it out, or compare campaigns: faultsweep compare");
  }
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
  std::string charts = concat("of a campaign: ", kCampaignCharts, ";\nof a case one of:");
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
  command->add_option("--show", a.show, "of a fault-map: chi (default), slip, state, pressure");
  command->add_option("--before", a.before,
                      "of a case: another (a number: of the same campaign), as thin lines");
  command->add_option("--x", a.map.x, "map: parameter along the bottom; default: the first");
  command->add_option("--y", a.map.y, "map: parameter along the side; default: the next");
  command->add_option("--metrics", a.sensitivity.metrics, "sensitivity: as for `sensitivity`");
  command->add_flag("--by-step", a.sensitivity.by_step, "sensitivity: against time");
  command->add_option("--of", a.probability.condition, "probability: as for `probability`");
  command->add_option("--by", a.probability.by, "probability: as for `probability`");
  const std::map<std::string, CurveAxis> axes = {
      {"step", CurveAxis::step}, {"time", CurveAxis::time}, {"pressure", CurveAxis::pressure}};
  command->add_option("--against", a.curves.axis, "curves: step (default) or time")
      ->transform(CLI::CheckedTransformer(axes))
      ->option_text("AXIS");
  command->add_option("--stage", a.curves.stage,
                      "curves: slip since its start; default: since\nthe start of the history");
  add_store(command, program.common);
  command->footer(
      "Examples:\n"
      "  faultsweep plot map my-sweep --x offset --y friction_angle -o map.svg\n"
      "  faultsweep plot sensitivity -o tornado.png\n"
      "  faultsweep plot curves my-sweep --against time -o curves.svg\n"
      "  faultsweep plot limits storage-limit -o limits.svg\n"
      "  faultsweep plot history my-sweep/17 --before 3 -o history.svg");

  auto [report_command, page] =
      program.add("report", "a campaign as one HTML page that needs no network", report);
  add_campaign(report_command, program.common);
  report_command->add_option("-o,--output", page.output, "file to write: *.html")->required();
  report_command->add_option("--top", page.request.top, "how many cases are drawn (default 3)")
      ->check(CLI::Range(0, 50));
  add_confidence(report_command, page.request.confidence);
  page.request.program = faultsim::version_text("faultsweep");
  report_command->footer("Example: faultsweep report my-sweep -o report.html");
}

}  // namespace faultsweep
