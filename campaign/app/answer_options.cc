#include <map>

#include "campaign/app/options.h"
#include "simulator/common/version.h"

namespace faultsweep {
namespace {

constexpr const char* kExportFooter =
    "Examples:\n"
    "  faultsweep export -o cases.csv                 a row per case, whatever became of it\n"
    "  faultsweep export --metrics moment,max_slip --where \"friction_angle < 25 deg\"\n"
    "  faultsweep export --histories -o histories.csv a row per case, fault and load step\n"
    "  faultsweep export --format dakota -o points.dat\n"
    "  faultsweep export --format salib -o salib      problem.json, X.txt, Y_METRIC.txt";
constexpr const char* kCompareFooter =
    "Examples:\n"
    "  faultsweep compare coarse fine --tolerance 0.05 --metrics chi_bar,activated_area\n"
    "  faultsweep compare sweep --other-store yesterday/faultsweep-store\n"
    "Cases are matched by identity, then by the parameters that both campaigns have.\n"
    "Exit code 0: all that was compared agrees; 5: something differs, or nothing was compared.";

void add_reading(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* status =
      app.add_subcommand("status", "how a campaign stands: counts, time left, failures");
  add_campaign(status, a.common);
  add_renderings(status, a.common);
  status->add_flag("--verify", a.verify,
                   "read the whole store instead and check it: structure, references,\n"
                   "checksums");
  status->footer(
      "Examples:\n"
      "  faultsweep status my-sweep\n"
      "  faultsweep status --verify\n"
      "  faultsweep status --json");
  status->callback(
      [&] { code = a.verify ? verify_store_command(a.common) : status_command(a.common); });

  CLI::App* rank = app.add_subcommand("rank", "the riskiest configurations first");
  add_campaign(rank, a.common);
  rank->add_option("--by", a.rank.by,
                   "metric or expression; default: the spec's, or the area that slides, then\n"
                   "the area that is open, M0, the pressure margin of inactive cases, and chi");
  add_stage_and_fault(rank, a.rank.stage, a.rank.fault);
  add_where(rank, a.rank.where);
  rank->add_option("--top", a.rank.top, "how many rows; 0 = all")->check(CLI::NonNegativeNumber);
  rank->add_flag("--ascending", a.rank.ascending, "smallest first");
  rank->add_flag("--list-metrics", a.list_metrics, "what can be ranked by");
  rank->add_option("--why", a.why,
                   "CASE: why it stands where it does: what slides first, what matters\n"
                   "near it and over the campaign, which places are not told apart");
  add_renderings(rank, a.common);
  rank->footer(
      "Examples:\n"
      "  faultsweep rank --by moment --top 10\n"
      "  faultsweep rank my-sweep --where \"friction_angle < 25 deg and activated\" --stage "
      "gas_storage\n"
      "  faultsweep rank my-sweep --why 17 --stage gas_storage\n"
      "  faultsweep rank --list-metrics");
  rank->callback([&] {
    code = a.why.empty() ? rank_command(a.common, a.rank, a.list_metrics)
                         : rank_why_command(a.common, a.rank, a.why);
  });

  CLI::App* show =
      app.add_subcommand("show", "one case: parameters, outcome, stages, slip events, chi history");
  add_case(show, a.common, a.case_name);
  show->add_option("--stage", a.show.stage, "only this stage");
  show->add_option("--fault", a.show.fault, "only this fault");
  add_renderings(show, a.common);
  show->footer(
      "Examples:\n"
      "  faultsweep show 17\n"
      "  faultsweep show my-sweep/17 --fault F2 --stage gas_storage\n"
      "  faultsweep show 17 --json");
  show->callback([&] { code = show_command(a.common, a.case_name, a.show); });

  CLI::App* explain = app.add_subcommand("explain", "why a case will run, or will not");
  add_case(explain, a.common, a.case_name);
  add_renderings(explain, a.common);
  explain->footer("Example: faultsweep explain my-sweep/17");
  explain->callback([&] { code = explain_command(a.common, a.case_name); });
}

/// What makes curves, or quantiles, of a table of probabilities.
void add_curves(CLI::App* command, ProbabilityArguments& a, CLI::Option* of, CLI::Option* by) {
  const std::map<std::string, CurveAxis> axes = {
      {"step", CurveAxis::step}, {"time", CurveAxis::time}, {"pressure", CurveAxis::pressure}};
  CLI::Option* against =
      command
          ->add_option("--against", a.against,
                       "step, time or pressure: curves of how likely each fault has begun to\n"
                       "slide by then")
          ->transform(CLI::CheckedTransformer(axes))
          ->option_text("AXIS")
          ->excludes(of)
          ->excludes(by);
  command
      ->add_option("--stage", a.stage,
                   "curves of slip since the start of this stage; default: of the history,\n"
                   "against pressure each stage")
      ->needs(against);
  CLI::Option* quantiles =
      command
          ->add_option("--quantiles", a.quantiles.metrics,
                       "quantiles of these metrics instead, with commas: names of\n"
                       "`rank --list-metrics`, also of a fault and stage")
          ->excludes(of)
          ->excludes(by)
          ->excludes(against);
  command->add_option("--at", a.quantiles.at, "shares of the cases below (default 0.05,0.5,0.95)")
      ->delimiter(',')
      ->needs(quantiles);
}

void add_posterior(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* command = app.add_subcommand(
      "posterior", "parameters and probabilities, given what was seen in the field");
  add_campaign(command, a.common);
  command
      ->add_option("--seen", a.posterior.seen,
                   "a statement; give the option again for each further one:\n"
                   "\"F2 did not slide before 8 yr +- 0.5 yr\", \"event of Mw 3 +- 0.2 on F2\n"
                   "between -120 bar and -80 bar +- 5 bar\", \"max_slip = 20 mm +- 5 mm\",\n"
                   "\"F2.slides in gas_storage, wrong 0.1\"")
      ->required()
      ->allow_extra_args(false);
  command
      ->add_option("--of", a.posterior.conditions,
                   "condition whose probability is wanted, as of `rank --where`; may be given\n"
                   "again; default: that each fault slides, in each stage")
      ->allow_extra_args(false);
  add_where(command, a.posterior.where);
  add_confidence(command, a.posterior.confidence);
  add_renderings(command, a.common);
  command->footer(
      "Examples:\n"
      "  faultsweep posterior my-sweep --seen \"F2 did not slide before 8 yr\"\n"
      "  faultsweep posterior --seen \"F1.max_slip = 20 mm +- 5 mm\" --of \"F2.slides in "
      "gas_storage\"\n"
      "What is given without an error is taken as exact. The cases are what was thought before.");
  command->callback([&] { code = posterior_command(a.common, a.posterior); });
}

void add_samples(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* probability =
      app.add_subcommand("probability", "how likely something is, with exact bounds");
  add_campaign(probability, a.common);
  ProbabilityRequest& request = a.probability.request;
  CLI::Option* of = probability->add_option(
      "--of", request.condition,
      "condition on metrics, as of `rank --where`; default: that each fault\n"
      "slides, in each stage");
  add_where(probability, request.where);
  CLI::Option* by = probability->add_option(
      "--by", request.by, "for each value of this parameter, or ten parts of its range");
  add_curves(probability, a.probability, of, by);
  probability
      ->add_option("--width", request.width,
                   "wanted distance of the bounds, as a share: how many more cases it takes")
      ->check(CLI::Range(1e-4, 1.0));
  add_confidence(probability, request.confidence);
  add_renderings(probability, a.common);
  probability->footer(
      "Examples:\n"
      "  faultsweep probability\n"
      "  faultsweep probability my-sweep --of \"F2.slides in gas_storage\" --by offset\n"
      "  faultsweep probability --of \"chi_bar > 0.9\" --where \"friction_angle < 25 deg\"\n"
      "  faultsweep probability --against time --csv >curves.csv\n"
      "  faultsweep probability --quantiles \"F1.chi_bar, max_slip in gas_storage\" --at 0.5,0.99");
  probability->callback([&] { code = probability_command(a.common, a.probability); });

  add_posterior(app, a, code);
  CLI::App* sensitivity =
      app.add_subcommand("sensitivity", "which parameters a metric depends on, and how surely");
  add_campaign(sensitivity, a.common);
  sensitivity->add_option(
      "--metrics", a.sensitivity.metrics,
      "names of `rank --list-metrics`, with commas, also of a fault and stage:\n"
      "F2.max_slip in gas_storage; default: chi_bar, slip and sliding by fault");
  sensitivity->add_flag("--by-step", a.sensitivity.by_step,
                        "at the end of each load step, and of all steps weighted by variance;\n"
                        "of faults: F2.chi_bar; default: chi_bar of each");
  add_stage_and_fault(sensitivity, a.sensitivity.cases.stage, a.sensitivity.cases.fault);
  add_where(sensitivity, a.sensitivity.cases.where);
  add_confidence(sensitivity, a.sensitivity.confidence);
  add_renderings(sensitivity, a.common);
  sensitivity->footer(
      "Examples:\n"
      "  faultsweep sensitivity\n"
      "  faultsweep sensitivity my-sweep --metrics \"F2.chi_bar in gas_storage, moment\"\n"
      "  faultsweep sensitivity my-sweep --by-step --metrics F2.max_slip");
  sensitivity->callback([&] { code = sensitivity_command(a.common, a.sensitivity); });
}

void add_tiers(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* command =
      app.add_subcommand("tiers", "what an expensive tier says of a sample, from few of its cases");
  TiersArguments& t = a.tiers;
  command->add_option("source", t.source, "spec (JSON) with a monte-carlo design")->required();
  command
      ->add_option("--tier-budget", t.budget,
                   "how many of the samples are run at the expensive tier; all at the cheap one")
      ->required()
      ->check(CLI::Range(20, 100000));
  command
      ->add_option("--tiers", t.tiers,
                   "the cheap one and the expensive one (default screening,standard)")
      ->delimiter(',');
  command->add_option("--metrics", t.request.metrics,
                      "whose means are wanted, with commas; default: chi_bar of each fault");
  command
      ->add_option("--of", t.request.conditions,
                   "condition whose probability is wanted, as of `rank --where`; may be given\n"
                   "again; default: that each fault slides, in each stage")
      ->allow_extra_args(false);
  command->add_option("-w,--workers", t.n_workers, "of the runs; default: the cores available")
      ->check(CLI::Range(1, 10000));
  add_confidence(command, t.request.confidence);
  add_store(command, a.common);
  add_renderings(command, a.common);
  command->footer(
      "Examples:\n"
      "  faultsweep tiers sample.json --tier-budget 40\n"
      "  faultsweep tiers sample.json --tier-budget 100 --tiers screening,demonstration --json\n"
      "Campaigns NAME-screening and NAME-standard are submitted and run; give the command again to "
      "go on.");
  command->callback([&] { code = tiers_command(a.common, t); });
}

void add_seeing(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* plot = app.add_subcommand("plot", "draw a chart as SVG or PNG");
  std::string charts = "of a campaign: map, sensitivity, probability;\nof a case one of:";
  for (const faultsim::CaseChartInfo& info : faultsim::case_charts()) {
    charts += std::string("\n") + info.name + ": " + info.meaning;
  }
  plot->add_option("chart", a.plot.chart, charts)->required();
  plot->add_option("subject", a.plot.subject,
                   "campaign (default: the newest), or a case: number or CAMPAIGN/CASE");
  plot->add_option("-o,--output", a.plot.output, "file to write: *.svg, or *.png by rsvg-convert")
      ->required();
  plot->add_option("--fault", a.plot.fault, "of a case; default: the one with the largest χ̄");
  plot->add_option("--step", a.plot.step, "of a case: load step; default: that of its largest χ̄");
  plot->add_option("--x", a.plot.map.x, "map: parameter along the bottom; default: the first");
  plot->add_option("--y", a.plot.map.y, "map: parameter along the side; default: the next");
  plot->add_option("--metrics", a.plot.sensitivity.metrics, "sensitivity: as of `sensitivity`");
  plot->add_flag("--by-step", a.plot.sensitivity.by_step, "sensitivity: against time");
  plot->add_option("--of", a.plot.probability.condition, "probability: as of `probability`");
  plot->add_option("--by", a.plot.probability.by, "probability: as of `probability`");
  add_store(plot, a.common);
  plot->footer(
      "Examples:\n"
      "  faultsweep plot map my-sweep --x offset --y friction_angle -o map.svg\n"
      "  faultsweep plot sensitivity -o tornado.png\n"
      "  faultsweep plot history my-sweep/17 -o history.svg");
  plot->callback([&] { code = plot_command(a.common, a.plot); });

  CLI::App* report =
      app.add_subcommand("report", "a campaign as one HTML page that needs no network");
  add_campaign(report, a.common);
  report->add_option("-o,--output", a.report.output, "file to write: *.html")->required();
  report->add_option("--top", a.report.request.top, "cases that are drawn (default 3)")
      ->check(CLI::Range(0, 50));
  add_confidence(report, a.report.request.confidence);
  a.report.request.program = faultsim::version_text("faultsweep");
  report->footer("Example: faultsweep report my-sweep -o report.html");
  report->callback([&] { code = report_command(a.common, a.report); });
}

void add_limits(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* command = app.add_subcommand(
      "limits", "up to which pressure a fault is safe, in each configuration of a spec");
  command->add_option("source", a.limits.source,
                      "spec (*.json) with a section limits, which is submitted and run first; or\n"
                      "a campaign of one; default: the newest");
  command
      ->add_option("-w,--workers", a.limits.n_workers, "of the run; default: the cores available")
      ->check(CLI::Range(1, 10000));
  command->add_option("--top", a.limits.top, "how many rows (default 20); 0 = all")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--map", a.limits.map,
                   "A B: the limit as a table, parameter A across and B down")
      ->expected(2);
  add_store(command, a.common);
  add_renderings(command, a.common);
  command->footer(
      "Examples:\n"
      "  faultsweep limits storage-limit.json             search, then the narrowest bands first\n"
      "  faultsweep limits storage-limit --map offset friction_angle\n"
      "  faultsweep limits storage-limit --csv >limits.csv\n"
      "Each limit is a pair of cases that were computed, one on either side of it.");
  command->callback([&] { code = limits_command(a.common, a.limits); });
}

void add_pillars(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* pillars =
      app.add_subcommand("pillars", "a campaign of a table of fault pillars of your own field");
  pillars->add_option("table", a.pillars.table, "CSV, a line for each pillar")->required();
  pillars
      ->add_option("--scene", a.pillars.scene,
                   "a field of two blocks: west is the footwall, east the hanging wall")
      ->required();
  pillars->add_option("-o,--output", a.pillars.folder, "folder for campaign.json and its tables")
      ->required();
  pillars->add_option("--names", a.pillars.names,
                      "JSON: how the table calls the columns, {\"depth\": \"TOP_TVD [m]\"}");
  pillars->add_option("--name", a.pillars.name, "of the campaign (default: as the table's file)");
  CLI::Option* azimuth = pillars->add_option("--stress-azimuth", a.pillars.stress_azimuth,
                                             "\"160 deg\": of the largest horizontal stress");
  pillars
      ->add_option("--stress-ratios", a.pillars.stress_ratios,
                   "largest and smallest effective horizontal stress over the vertical one")
      ->expected(2)
      ->needs(azimuth);
  pillars->footer(
      "Columns: id, fault, x [m], y [m], azimuth [deg], depth [m], offset [m], thickness [m] or\n"
      "thickness_foot [m] and thickness_hanging [m], dip [deg] (from the vertical) or\n"
      "dip_from_horizontal [deg], and any parameter that `faultsim parameters` lists.\n"
      "Examples:\n"
      "  faultsweep pillars pillars.csv --scene section.json -o pillars\n"
      "  faultsweep submit pillars/campaign.json && faultsweep run pillars\n"
      "  faultsweep map pillars/places.csv pillars -o map.vtu      for ParaView");
  pillars->callback([&] { code = pillars_command(a.pillars); });

  CLI::App* map = app.add_subcommand("map", "what became of pillars, on a map");
  map->add_option("places", a.map.places, "places.csv of `faultsweep pillars`")->required();
  add_campaign(map, a.common);
  map->add_option("-o,--output", a.map.output,
                  "file: .csv, .vtu (ParaView) or .ts (GOCAD surfaces with properties)")
      ->required();
  map->footer("Example: faultsweep map pillars/places.csv pillars -o map.csv");
  map->callback([&] { code = map_command(a.common, a.map); });
}

void add_export(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* command = app.add_subcommand("export", "cases as tables: CSV, or for Dakota or SALib");
  add_campaign(command, a.common);
  const std::map<std::string, ExportFormat> formats = {
      {"csv", ExportFormat::csv}, {"dakota", ExportFormat::dakota}, {"salib", ExportFormat::salib}};
  command->add_option("--format", a.exporting.format, "csv (default), dakota or salib")
      ->transform(CLI::CheckedTransformer(formats))
      ->option_text("NAME");
  command->add_option("-o,--output", a.exporting.target,
                      "file, or folder for salib; default: stdout");
  command->add_option("--metrics", a.exporting.metrics,
                      "names of `rank --list-metrics`, with commas, also of a fault and stage:\n"
                      "F2.max_slip in gas_storage; default: all, for dakota and salib those that\n"
                      "every full history has");
  add_stage_and_fault(command, a.exporting.stage, a.exporting.fault);
  add_where(command, a.exporting.where);
  command->add_flag("--histories", a.exporting.histories,
                    "the chi histories instead: a row per case, fault and load step");
  command->footer(kExportFooter);
  command->callback([&] { code = export_command(a.common, a.exporting); });
}

void add_compare(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* command = app.add_subcommand("compare", "two campaigns, case by case");
  command->add_option("A", a.compare.a, "a campaign")->required();
  command->add_option("B", a.compare.b,
                      "another one; default with --other-store: of the same name");
  command->add_option("--other-store", a.compare.other_store, "store folder of B");
  command
      ->add_option("--tolerance", a.compare.request.tolerance,
                   "relative difference of a metric that still agrees (default 1e-9)")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--metrics", a.compare.request.metrics,
                      "names of `rank --list-metrics`, with commas; default: all");
  command->add_option("--stage", a.compare.request.stage,
                      "metrics of this stage; default: the whole history");
  command
      ->add_option("--top", a.compare.request.top,
                   "how many of the worst cases; 0 = all that differ (default 10)")
      ->check(CLI::NonNegativeNumber);
  add_store(command, a.common);
  add_renderings(command, a.common);
  command->footer(kCompareFooter);
  command->callback([&] { code = compare_command(a.common, a.compare); });
}

}  // namespace

void add_answers(CLI::App& app, Arguments& a, ExitCode& code) {
  add_reading(app, a, code);
  add_samples(app, a, code);
  add_tiers(app, a, code);
  add_seeing(app, a, code);
  add_limits(app, a, code);
  add_pillars(app, a, code);
  add_export(app, a, code);
  add_compare(app, a, code);
}

}  // namespace faultsweep
