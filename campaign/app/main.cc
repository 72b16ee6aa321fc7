#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <limits>
#include <map>
#include <new>

#include "campaign/app/commands.h"
#include "campaign/app/print_answer.h"
#include "simulator/common/errors.h"
#include "simulator/common/version.h"

namespace faultsweep {
namespace {

constexpr const char* kFooter =
    "Examples:\n"
    "  faultsweep init my-sweep                      write a starter spec and scene\n"
    "  faultsweep submit my-sweep/campaign.json --dry-run\n"
    "  faultsweep submit my-sweep/campaign.json      check, expand, store\n"
    "  faultsweep run --workers 2                    start, or go on where it stopped\n"
    "  faultsweep run --hostfile hosts               on the hosts of a file, as mpirun takes it\n"
    "  faultsweep slurm --workers 31 --nodes 2 | sbatch      as a job of a cluster\n"
    "  faultsweep status                             from another terminal: time left, failures\n"
    "  faultsweep rank --by moment --where \"friction_angle < 25 deg\" --top 10\n"
    "  faultsweep rank --fault F2 --stage gas_storage --by slip\n"
    "  faultsweep rank --where \"F2.slides in gas_storage and not F1.slides\"\n"
    "  faultsweep show 17                            one case: stages, faults, chi history\n"
    "  faultsweep report -o report.html              all of it on one page, with pictures\n"
    "  faultsweep export -o cases.csv                all cases, for pandas or a spreadsheet\n"
    "  faultsweep compare coarse fine                two campaigns, case by case\n"
    "  faultsweep limits campaign.json               up to which pressure a fault is safe\n"
    "  faultsweep pillars pillars.csv --scene section.json -o pillars     your own faults\n"
    "  faultsweep tradeoff scene.json                what each choice costs, in accuracy and time\n"
    "Campaigns are addressed by name, the newest by default; cases by number, or CAMPAIGN/NUMBER.\n"
    "Exit codes: 0 done, 1 done with some cases without a full result, 2 input, 4 disk or memory,\n"
    "            5 compared and different, or nothing compared, 70 bug,\n"
    "            75 interrupted: run again to continue.";
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

std::filesystem::path default_store() {
  const char* given = std::getenv("FAULTSWEEP_STORE");
  return given != nullptr && *given != '\0' ? given : "faultsweep-store";
}

void add_store(CLI::App* command, StoreArguments& common) {
  command->add_option("--store", common.store,
                      "store folder (default FAULTSWEEP_STORE or ./faultsweep-store)");
}
void add_campaign(CLI::App* command, StoreArguments& common) {
  command->add_option("campaign", common.campaign, "its name; default: the newest");
  add_store(command, common);
}
void add_case(CLI::App* command, StoreArguments& common, std::string& name) {
  command->add_option("case", name, "number, beginning of its identity, or CAMPAIGN/either")
      ->required();
  command->add_option("--campaign", common.campaign, "default: the newest");
  add_store(command, common);
}
void add_where(CLI::App* command, std::string& where) {
  command->add_option(
      "--where", where,
      "only cases where this holds of metrics and parameters: \"offset > 50 m and\n"
      "slides\"; of a fault, a stage, or both: \"F2.max_slip in gas_storage > 10 mm\"");
}
void add_stage_and_fault(CLI::App* command, std::string& stage, std::string& fault) {
  command->add_option("--stage", stage, "metrics of this stage; default: the whole history");
  command->add_option("--fault", fault,
                      "metrics of this fault; default: of all faults of a case together");
}
void add_json(CLI::App* command, StoreArguments& common) {
  command->add_flag("--json", common.json, "machine-readable output on stdout");
}

void add_wide(CLI::App* command) {
  command->add_flag_callback(
      "--wide",
      [] {
        constexpr std::size_t kWithoutEnd = 100000;
        set_screen_width(kWithoutEnd);
      },
      "all columns, however wide");
}

/// The renderings of an answer.
void add_renderings(CLI::App* command, StoreArguments& common) {
  add_json(command, common);
  command
      ->add_option("--csv", common.csv,
                   "a table of the answer as CSV, SI units, all digits: its key in --json;\n"
                   "default: the first")
      ->expected(0, 1)
      ->default_str("");
  add_wide(command);
}

/// All arguments of all commands; CLI11 fills them.
struct Arguments {
  StoreArguments common;
  std::string init_folder = "campaign", case_name, cache_size = "20 GB", backup_target;
  SubmitArguments submit;
  RunOptions run;
  SlurmRequest slurm;
  RankRequest rank;
  ProbabilityArguments probability;
  PosteriorRequest posterior;
  TiersArguments tiers;
  SensitivityRequest sensitivity;
  LimitsArguments limits;
  PillarArguments pillars;
  MapArguments map;
  PlotArguments plot;
  ReportArguments report;
  ShowRequest show;
  std::string why;
  bool list_metrics = false, verify = false;
  ExportRequest exporting;
  CompareArguments compare;
  RetryArguments retry;
  NightRequest nightly;
  bool nightly_json = false;
  TradeoffArguments tradeoff;
  bool nightly_history = false;
};

void add_running(CLI::App& app, Arguments& a, ExitCode& code, int argc, char** argv) {
  CLI::App* init = app.add_subcommand("init", "write a starter spec and its scene");
  init->add_option("folder", a.init_folder, "where (default ./campaign)");
  init->footer(
      "Example: faultsweep init my-sweep    my-sweep/campaign.json and my-sweep/scene.json");
  init->callback([&] { code = init_command(a.init_folder); });

  CLI::App* submit = app.add_subcommand("submit", "check and expand a spec and store its cases");
  submit->add_option("spec", a.submit.spec, "spec file (JSON)")->required();
  submit->add_flag("--dry-run", a.submit.dry_run, "only show what it would be");
  add_store(submit, a.common);
  add_json(submit, a.common);
  add_wide(submit);
  submit->footer(
      "Examples:\n"
      "  faultsweep submit my-sweep/campaign.json --dry-run    cases, families, time; nothing is "
      "stored\n"
      "  faultsweep submit my-sweep/campaign.json --store runs/store");
  submit->callback([&] { code = submit_command(a.common, a.submit); });

  CLI::App* run = app.add_subcommand("run", "run a campaign, or continue it, under mpirun");
  add_campaign(run, a.common);
  run->add_option("-w,--workers", a.run.n_workers,
                  "workers beside the manager; default: the cores available, or in a Slurm job\n"
                  "its tasks less one")
      ->check(CLI::Range(1, 10000));
  run->add_option("--hostfile", a.run.hostfile,
                  "mpirun's list of hosts; without --workers as many ranks as it has slots")
      ->check(CLI::ExistingFile);
  const std::map<std::string, ProgressDisplay::Style> styles = {
      {"none", ProgressDisplay::Style::silent},
      {"lines", ProgressDisplay::Style::lines},
      {"bar", ProgressDisplay::Style::bar}};
  a.run.progress =
      isatty(STDERR_FILENO) != 0 ? ProgressDisplay::Style::bar : ProgressDisplay::Style::lines;
  run->add_option("--progress", a.run.progress, "none, lines or bar; default: bar on a terminal")
      ->transform(CLI::CheckedTransformer(styles));
  run->add_option("--simulator", a.run.simulator,
                  "the faultsim binary; default FAULTSIM_BINARY, or beside faultsweep");
  run->add_option("--memory", a.run.memory,
                  "of each host, for operators that are built or held together: \"12 GB\",\n"
                  "0 = no limit; default: 0.9 of what is available");
  run->add_option("--threads", a.run.threads,
                  "for building an operator; default: the cores of its host that are idle.\n"
                  "Results are the same with any number")
      ->check(CLI::Range(1, 1024));
  run->add_option("--node-cache", a.run.node_cache,
                  "copies of operators on each host's own disk, or none; default: none if the\n"
                  "store is on a local disk, else a folder in SLURM_TMPDIR, TMPDIR or /tmp");
  run->add_option("--status-file", a.run.status_file)->group("");
  run->footer(
      "Examples:\n"
      "  faultsweep run                       the newest campaign, on all cores\n"
      "  faultsweep run my-sweep --workers 2\n"
      "  faultsweep run --hostfile hosts --memory \"12 GB\"\n"
      "Interrupted, it goes on where it stopped: give the same command again.");
  run->callback([&, argc, argv] { code = run_command(a.common, a.run, argc, argv); });
}

void add_slurm(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* slurm = app.add_subcommand("slurm", "print a script for sbatch that runs a campaign");
  add_campaign(slurm, a.common);
  slurm
      ->add_option("-w,--workers", a.slurm.n_workers,
                   "tasks beside the manager's; default: enough for half an hour, at most 15")
      ->check(CLI::Range(1, 10000));
  slurm->add_option("--nodes", a.slurm.nodes, "default 1")->check(CLI::Range(1, 10000));
  slurm->add_option("--time", a.slurm.time,
                    "as sbatch takes it: 12:00:00; default: twice the time predicted");
  slurm->add_option("--memory-per-node", a.slurm.memory_per_node,
                    "as sbatch takes it: 64G; default: as predicted");
  slurm->add_option("--partition", a.slurm.partition, "default: the cluster's");
  slurm->add_option("--account", a.slurm.account, "default: yours");
  slurm
      ->add_option("--resubmit", a.slurm.resubmit,
                   "how often the job queues itself again when its time was over; default: never")
      ->check(CLI::Range(0, 1000));
  slurm->footer("Example: faultsweep slurm my-sweep --workers 31 --nodes 2 --resubmit 3 | sbatch");
  slurm->callback([&] { code = slurm_command(a.common, a.slurm); });
}

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

CLI::Option* add_confidence(CLI::App* command, double& confidence) {
  return command->add_option("--confidence", confidence, "of the intervals (default 0.95)")
      ->check(CLI::Range(0.5, 0.9999));
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

void add_answers(CLI::App& app, Arguments& a, ExitCode& code) {
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

void add_nightly(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* nightly = app.add_subcommand(
      "nightly", "run a suite from scratch and compare it with its baseline, bit for bit");
  NightRequest& n = a.nightly;
  nightly->add_option("suite", n.suite, "suite file (default nightly.json)");
  nightly->add_option("--baselines", n.baselines,
                      "folder of the baselines (default results/baselines)");
  nightly->add_option("--store", n.store, "store of the nights (default ./faultsweep-nightly)");
  nightly->add_option("-w,--workers", n.n_workers, "as for run")->check(CLI::Range(1, 10000));
  CLI::Option* bless = nightly->add_flag("--bless", n.bless, "make tonight's results the baseline");
  CLI::Option* reason = nightly->add_option("--reason", n.reason, "why; kept in the baseline");
  bless->needs(reason);
  reason->needs(bless);
  nightly->add_flag("--history", a.nightly_history, "only print the nights so far")
      ->excludes(bless);
  nightly->add_flag("--json", a.nightly_json, "machine-readable output on stdout");
  add_wide(nightly);
  nightly->footer(
      "Examples:\n"
      "  faultsweep nightly nightly.json\n"
      "  faultsweep nightly --bless --reason \"finer cells at the corners\"\n"
      "Exit codes: 0 no regress, 5 a regress, or nothing was compared.");
  nightly->callback([&] {
    code = a.nightly_history ? nightly_history_command(n.store, a.nightly_json)
                             : nightly_command(n, a.nightly_json);
  });
}

void add_tradeoff(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* command = app.add_subcommand(
      "tradeoff", "measure on a scene what each choice costs in accuracy and in time");
  TradeoffArguments& t = a.tradeoff;
  command->add_option("source", t.source, "scene, or campaign spec (JSON)")->required();
  command->add_option("--set", t.settings, "/json/pointer=value of the scene");
  command
      ->add_option("--error", t.wanted_chi,
                   "of the critical index, to recommend a mesh for (default 0.02)")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--operator-limit", t.operator_seconds,
                   "s; choices whose operator is predicted to take longer are left out\n"
                   "(default 300)")
      ->check(CLI::PositiveNumber);
  command->add_option("--memory", t.memory,
                      "the same for memory: \"12 GB\"; default: 0.8 of what is available");
  command
      ->add_option("--cases", t.n_cases, "of a spec: how many are ranked at each tier (default 32)")
      ->check(CLI::Range(2, 100000));
  command
      ->add_option("--tiers", t.tiers,
                   "with commas, the last is the reference (default screening,standard)")
      ->delimiter(',');
  command->add_option("-w,--workers", t.n_workers, "default 1: two disturb each other's times")
      ->check(CLI::Range(1, 10000));
  command->add_option("-o,--output", t.output, "folder for report.md, trade.json and figures");
  command->add_flag("--dry-run", t.dry_run, "only show the choices and their predicted cost");
  add_store(command, a.common);
  add_json(command, a.common);
  add_wide(command);
  command->footer(
      "Examples:\n"
      "  faultsweep tradeoff scene.json --dry-run\n"
      "  faultsweep tradeoff scene.json --error 0.01 -o trade\n"
      "  faultsweep tradeoff campaign.json --cases 16 --tiers screening,demonstration\n"
      "Interrupted, it goes on where it stopped: give the same command again.");
  command->callback([&] { code = tradeoff_command(a.common, t); });
}

void add_caring(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* retry = app.add_subcommand("retry", "let failed cases run again");
  add_campaign(retry, a.common);
  retry->add_option("--case", a.retry.position, "only this case number");
  retry->add_flag("--unconverged", a.retry.unconverged, "also cases whose history ended early");
  add_json(retry, a.common);
  retry->footer(
      "Examples:\n"
      "  faultsweep retry my-sweep\n"
      "  faultsweep retry --case 17 --unconverged");
  retry->callback([&] { code = retry_command(a.common, a.retry); });

  CLI::App* cancel = app.add_subcommand("cancel", "hand out no more cases of a campaign");
  add_campaign(cancel, a.common);
  add_json(cancel, a.common);
  cancel->footer(
      "Example: faultsweep cancel my-sweep    results stay; submit the spec again to reopen it");
  cancel->callback([&] { code = cancel_command(a.common); });

  CLI::App* cache = app.add_subcommand("cache", "the operators kept in STORE/operators");
  cache->footer("Example: faultsweep cache list");
  cache->require_subcommand(1);
  CLI::App* list = cache->add_subcommand("list", "operators, most recently used first");
  add_store(list, a.common);
  add_json(list, a.common);
  list->footer("Example: faultsweep cache list --json");
  list->callback([&] { code = cache_list_command(a.common); });
  CLI::App* verify =
      cache->add_subcommand("verify", "checksums of the operators and integrity of the store");
  add_store(verify, a.common);
  add_json(verify, a.common);
  verify->footer("Example: faultsweep cache verify --store runs/store");
  verify->callback([&] { code = cache_verify_command(a.common); });
  CLI::App* prune = cache->add_subcommand("prune", "remove least recently used operators");
  prune->add_option("--max-size", a.cache_size, "what may stay (default 20 GB)");
  add_store(prune, a.common);
  add_json(prune, a.common);
  prune->footer("Example: faultsweep cache prune --max-size \"5 GB\"");
  prune->callback([&] { code = cache_prune_command(a.common, a.cache_size); });

  CLI::App* backup =
      app.add_subcommand("backup", "copy the store's database, also while it is in use");
  backup->add_option("file", a.backup_target, "new file")->required();
  add_store(backup, a.common);
  backup->footer("Example: faultsweep backup before.sqlite");
  backup->callback([&] { code = backup_command(a.common, a.backup_target); });
}

/// Reads the command line and returns the chosen command's exit code.
ExitCode faultsweep_main(int argc, char** argv) {
  CLI::App app{"faultsweep: campaigns of fault reactivation cases", "faultsweep"};
  app.require_subcommand(1);
  app.get_formatter()->column_width(24);  // texts of up to 76 columns stand beside it
  app.footer(kFooter);
  app.set_version_flag("--version", faultsim::version_text("faultsweep"));
  Arguments arguments;
  arguments.common.store = default_store();
  ExitCode code = ExitCode::done;
  add_running(app, arguments, code, argc, argv);
  add_slurm(app, arguments, code);
  add_reading(app, arguments, code);
  add_answers(app, arguments, code);
  add_tiers(app, arguments, code);
  add_seeing(app, arguments, code);
  add_limits(app, arguments, code);
  add_pillars(app, arguments, code);
  add_export(app, arguments, code);
  add_compare(app, arguments, code);
  add_nightly(app, arguments, code);
  add_tradeoff(app, arguments, code);
  add_caring(app, arguments, code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? ExitCode::done : ExitCode::input;
  } catch (const faultsim::Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {  // impossible: unless what was read had been damaged
    for (const auto& store : {arguments.common.store, arguments.compare.other_store,
                              std::filesystem::path(arguments.nightly.store)}) {
      if (store.empty()) continue;
      if (const auto damage = Store::damage_of(store)) throw faultsim::StorageError(*damage);
    }
    throw;
  }
  return code;
}

}  // namespace
}  // namespace faultsweep

int main(int argc, char** argv) {
  return static_cast<int>(
      faultsim::run_program("faultsweep", faultsweep::faultsweep_main, argc, argv));
}
