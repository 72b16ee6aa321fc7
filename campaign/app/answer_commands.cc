#include <cstdio>
#include <map>

#include "campaign/answers/curves.h"
#include "campaign/answers/posterior.h"
#include "campaign/answers/probability.h"
#include "campaign/answers/quantiles.h"
#include "campaign/answers/sensitivity.h"
#include "campaign/app/commands.h"
#include "campaign/common/names.h"
#include "campaign/reports/compare.h"
#include "campaign/reports/export.h"
#include "simulator/files/output_target.h"

namespace faultsweep {

namespace {

constexpr const char* kExportFooter =
    "Examples:\n"
    "  faultsweep export -o cases.csv                 a row per case, whatever its outcome\n"
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

/// Prints what is answered of the campaign.
template <typename AnswerOf>
ExitCode answer_campaign(const StoreArguments& common, const AnswerOf& answer) {
  const Store store = Store::open_reader(common.store);
  print_answer(answer(store, store.campaign(common.campaign, false)), common);
  return ExitCode::done;
}

struct ProbabilityArguments {
  ProbabilityRequest request = {};
  std::optional<CurveAxis> against = std::nullopt;  ///< curves; none = a table.
  std::string stage = {};                           ///< of curves.
  QuantileRequest quantiles = {};                   ///< with metrics: quantiles instead.
};

ExitCode probability(const StoreArguments& common, const ProbabilityArguments& arguments) {
  const ProbabilityRequest& request = arguments.request;
  return answer_campaign(common, [&](const Store& store, const CampaignInfo& campaign) {
    if (arguments.against) {
      return to_answer(probability_curves(
          store, campaign,
          {*arguments.against, request.where, arguments.stage, request.confidence}));
    }
    if (arguments.quantiles.metrics.empty())
      return to_answer(find_probability(store, campaign, request));
    QuantileRequest quantiles = arguments.quantiles;
    quantiles.where = request.where;
    quantiles.confidence = request.confidence;
    return to_answer(find_quantiles(store, campaign, quantiles));
  });
}

ExitCode posterior(const StoreArguments& common, const PosteriorRequest& request) {
  return answer_campaign(common, [&](const Store& store, const CampaignInfo& campaign) {
    return to_answer(find_posterior(store, campaign, request));
  });
}

ExitCode sensitivity(const StoreArguments& common, const SensitivityRequest& request) {
  return answer_campaign(common, [&](const Store& store, const CampaignInfo& campaign) {
    return what_matters(store, campaign, request);
  });
}

ExitCode export_cases(const StoreArguments& common, const ExportRequest& asked) {
  ExportRequest request = asked;
  if (faultsim::is_standard_output(request.target) && request.format != ExportFormat::salib) {
    request.target.clear();
  }
  const Store store = Store::open_reader(common.store);
  const CampaignInfo campaign = store.campaign(common.campaign, false);
  std::fputs(export_campaign(store, campaign, request).c_str(), stderr);
  return ExitCode::done;
}

struct CompareArguments {
  std::string a, b;                   ///< campaigns; b "" = of a's name, in the other store.
  std::filesystem::path other_store;  ///< where b is; "" = in the same store.
  CompareRequest request;
};

ExitCode compare(const StoreArguments& common, const CompareArguments& arguments) {
  if (arguments.b.empty() && arguments.other_store.empty()) {
    throw InputError("B", {{"", 0, "there is nothing to compare with",
                            "name another campaign, or another store with --other-store"}});
  }
  const Store store_a = Store::open_reader(common.store);
  const Store store_b =
      Store::open_reader(arguments.other_store.empty() ? common.store : arguments.other_store);
  const CampaignInfo a = store_a.campaign(arguments.a);
  const CampaignInfo b = store_b.campaign(arguments.b.empty() ? a.name : arguments.b);
  const Comparison comparison = compare_campaigns(store_a, a, store_b, b, arguments.request);
  print_answer(to_answer(comparison), common);
  return comparison.agrees() ? ExitCode::done : ExitCode::regress;
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
                   "curves: slip since the start of this stage; default: of the history,\n"
                   "against pressure each stage")
      ->needs(against);
  CLI::Option* quantiles =
      command
          ->add_option("--quantiles", a.quantiles.metrics,
                       "quantiles of these metrics instead, comma-separated: names from\n"
                       "`rank --list-metrics`, also of a fault and stage")
          ->excludes(of)
          ->excludes(by)
          ->excludes(against);
  command->add_option("--at", a.quantiles.at, "levels of the quantiles (default 0.05,0.5,0.95)")
      ->delimiter(',')
      ->needs(quantiles);
}

}  // namespace

void add_samples(Program& program) {
  auto [command, a] =
      program.add("probability", "how likely something is, with exact bounds", probability);
  add_campaign(command, program.common);
  ProbabilityRequest& request = a.request;
  CLI::Option* of =
      command->add_option("--of", request.condition,
                          "condition on metrics, as for `rank --where`; default: that each fault\n"
                          "slides, in each stage");
  add_where(command, request.where);
  CLI::Option* by = command->add_option(
      "--by", request.by, "for each value of this parameter, or ten parts of its range");
  add_curves(command, a, of, by);
  command
      ->add_option("--width", request.width,
                   "wanted distance of the bounds, as a share: says how many more cases it takes")
      ->check(CLI::Range(1e-4, 1.0))
      ->check(not_nan());
  add_confidence(command, request.confidence);
  add_renderings(command, program.common);
  command->footer(
      "Examples:\n"
      "  faultsweep probability\n"
      "  faultsweep probability my-sweep --of \"F2.slides in gas_storage\" --by offset\n"
      "  faultsweep probability --of \"chi_bar > 0.9\" --where \"friction_angle < 25 deg\"\n"
      "  faultsweep probability --against time --csv >curves.csv\n"
      "  faultsweep probability --quantiles \"F1.chi_bar, max_slip in gas_storage\" --at 0.5,0.99");

  auto [posterior_command, seen] = program.add(
      "posterior", "parameters and probabilities, given what was observed in the field", posterior);
  add_campaign(posterior_command, program.common);
  posterior_command
      ->add_option("--seen", seen.seen,
                   "a statement; repeat the option for each further one:\n"
                   "\"F2 did not slide before 8 yr +- 0.5 yr\", \"event of Mw 3 +- 0.2 on F2\n"
                   "between -120 bar and -80 bar +- 5 bar\", \"max_slip = 20 mm +- 5 mm\",\n"
                   "\"F2.slides in gas_storage, wrong 0.1\"")
      ->required()
      ->allow_extra_args(false);
  posterior_command
      ->add_option("--of", seen.conditions,
                   "condition whose probability is wanted, as for `rank --where`; may be\n"
                   "repeated; default: that each fault slides, in each stage")
      ->allow_extra_args(false);
  add_where(posterior_command, seen.where);
  add_confidence(posterior_command, seen.confidence);
  add_renderings(posterior_command, program.common);
  posterior_command->footer(
      "Examples:\n"
      "  faultsweep posterior my-sweep --seen \"F2 did not slide before 8 yr\"\n"
      "  faultsweep posterior --seen \"F1.max_slip = 20 mm +- 5 mm\" --of \"F2.slides in "
      "gas_storage\"\n"
      "A value given without an error is taken as exact. The cases are the prior.");

  auto [sensitivity_command, s] = program.add(
      "sensitivity", "which parameters a metric depends on, and with what certainty", sensitivity);
  add_campaign(sensitivity_command, program.common);
  sensitivity_command->add_option(
      "--metrics", s.metrics,
      "names from `rank --list-metrics`, comma-separated, also of a fault and\n"
      "stage: F2.max_slip in gas_storage; default: chi_bar, slip, sliding by fault");
  sensitivity_command->add_flag(
      "--by-step", s.by_step,
      "at the end of each load step, and over all steps weighted by variance;\n"
      "metrics of faults: F2.chi_bar; default: chi_bar of each");
  add_stage_and_fault(sensitivity_command, s.cases.stage, s.cases.fault);
  add_where(sensitivity_command, s.cases.where);
  add_confidence(sensitivity_command, s.confidence);
  add_renderings(sensitivity_command, program.common);
  sensitivity_command->footer(
      "Examples:\n"
      "  faultsweep sensitivity\n"
      "  faultsweep sensitivity my-sweep --metrics \"F2.chi_bar in gas_storage, moment\"\n"
      "  faultsweep sensitivity my-sweep --by-step --metrics F2.max_slip");
}

void add_tables(Program& program) {
  auto [command, request] =
      program.add("export", "cases as tables: CSV, or for Dakota or SALib", export_cases);
  add_campaign(command, program.common);
  const std::map<std::string, ExportFormat> formats = {
      {"csv", ExportFormat::csv}, {"dakota", ExportFormat::dakota}, {"salib", ExportFormat::salib}};
  command->add_option("--format", request.format, "csv (default), dakota or salib")
      ->transform(CLI::CheckedTransformer(formats))
      ->option_text("NAME");
  command->add_option("-o,--output", request.target, "file, or folder for salib; default: stdout");
  command->add_option("--metrics", request.metrics,
                      "names from `rank --list-metrics`, comma-separated, also of a fault and\n"
                      "stage: F2.max_slip in gas_storage; default: all, for dakota and salib\n"
                      "those that every full history has");
  add_stage_and_fault(command, request.stage, request.fault);
  add_where(command, request.where);
  command->add_flag("--histories", request.histories,
                    "chi histories instead: a row per case, fault and load step");
  command->footer(kExportFooter);

  auto [compare_command, a] = program.add("compare", "two campaigns, case by case", compare);
  program.stores.push_back(&a.other_store);
  compare_command->add_option("A", a.a, "a campaign")->required();
  compare_command->add_option("B", a.b,
                              "another one; default with --other-store: the one of the same name");
  compare_command->add_option("--other-store", a.other_store, "store folder of B");
  compare_command
      ->add_option("--tolerance", a.request.tolerance,
                   "relative difference up to which a metric agrees (default 1e-9)")
      ->check(CLI::NonNegativeNumber)
      ->check(not_nan());
  compare_command->add_option("--metrics", a.request.metrics,
                              "names from `rank --list-metrics`, comma-separated; default: all");
  compare_command->add_option("--stage", a.request.stage,
                              "metrics of this stage; default: the whole history");
  compare_command
      ->add_option("--top", a.request.top,
                   "how many of the worst cases; 0 = all that differ (default 10)")
      ->check(CLI::NonNegativeNumber);
  add_store(compare_command, program.common);
  add_renderings(compare_command, program.common);
  compare_command->footer(kCompareFooter);
}

}  // namespace faultsweep
