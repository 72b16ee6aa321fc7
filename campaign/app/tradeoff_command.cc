#include <algorithm>
#include <memory>

#include "campaign/app/commands.h"
#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/expansion/submission.h"
#include "campaign/render/render.h"
#include "campaign/scheduler/resources.h"
#include "campaign/scheduler/starter.h"
#include "campaign/store/clock.h"
#include "campaign/tradeoff/ladder.h"
#include "campaign/tradeoff/stored_ladder.h"
#include "campaign/tradeoff/trade_report.h"
#include "simulator/files/atomic_file.h"
#include "simulator/files/json_text.h"
#include "simulator/files/output_target.h"
#include "simulator/files/result_folder.h"
#include "simulator/reading/read_scene.h"

namespace faultsweep {

using faultsim::JsonDocument;

namespace {

struct TradeoffArguments {
  std::string source;                 ///< a scene, or a campaign spec.
  std::vector<std::string> settings;  ///< "/json/pointer=value" of a scene.
  double wanted_chi = 0.02;           ///< error of χ̄ to recommend a mesh for.
  double operator_seconds = 300;      ///< dearer choices, by prediction, are left out.
  std::string memory;                 ///< the same: "12 GB"; "" = 0.8 of what is available.
  long n_cases = 32;                  ///< of a spec: that are ranked at every tier.
  std::vector<std::string> tiers = {"screening", "standard"};  ///< the last is the reference.
  std::optional<int> n_workers = 1;  ///< one, so that times are not those of two side by side.
  std::filesystem::path output;      ///< folder for report and figures; "" = none.
  bool dry_run = false;
};

constexpr double kShareOfMemory = 0.8;

void apply(const std::vector<std::string>& settings, JsonDocument& document) {
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos) {
      throw InputError("--set", concat("'", setting, "' has no '='"),
                       "write --set /friction/friction_angle=\"25 deg\"");
    }
    faultsim::set_value(document, setting.substr(0, equals), setting.substr(equals + 1));
  }
}

/// What was asked about: a scene, and cases of it where a spec was given.
struct TradeQuestion {
  JsonDocument scene;
  std::string name;  ///< of the campaign that answers it.
  std::optional<Expansion> cases;
};

TradeQuestion read_question(const TradeoffArguments& arguments) {
  TradeQuestion question{faultsim::read_json_file(arguments.source), "", std::nullopt};
  std::string stem = std::filesystem::path(arguments.source).stem();
  for (char& c : stem) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '.' && c != '_') c = '-';
  }
  question.name = "tradeoff-" + stem;
  if (!question.scene.value.is_object() || !question.scene.value.contains("design")) {
    apply(arguments.settings, question.scene);
    return question;
  }
  if (arguments.tiers.size() < 2) {
    throw InputError("--tiers", "one tier alone cannot be compared",
                     "write --tiers screening,standard");
  }
  if (!arguments.settings.empty()) {
    throw InputError("--set", "a spec has a \"set\" of its own", "put it there");
  }
  question.cases = expand(read_campaign(arguments.source));
  question.scene = {question.cases->spec.scene_source, question.cases->spec.groups[0].scene, {}};
  for (const std::string& tier : arguments.tiers) {
    JsonDocument at_it = question.scene;
    at_it.value["tier"] = tier;
    std::vector<Problem> problems;
    faultsim::read_scene(at_it, problems);
    if (!problems.empty()) {
      throw InputError("--tiers", concat("'", tier, "': ", problems.front().what),
                       problems.front().cure);
    }
  }
  return question;
}

double memory_limit(const TradeoffArguments& arguments) {
  if (!arguments.memory.empty())
    return static_cast<double>(parse_size("--memory", arguments.memory));
  constexpr double kLeast = 1;  // byte; 0 would mean no limit
  if (const auto available = available_memory())
    return std::max(kLeast, kShareOfMemory * *available);
  const MemoryForOperators assumed = memory_for_operators({}, physical_memory());
  say(assumed.remark);
  return assumed.bytes;
}

void write_report(faultsim::ResultFolder& folder, const TradeReport& report, const json& document) {
  const auto write = [&](const char* name, const std::string& text) {
    faultsim::write_text(folder.path() / name, text);
  };
  write("report.md", trade_to_markdown(report));
  write("trade.json", faultsim::json_text(document));
  const TradeFigures figures = trade_figures(document);
  if (!figures.pareto.series.empty()) write("pareto.svg", draw(figures.pareto));
  if (!figures.convergence.series.empty()) write("convergence.svg", draw(figures.convergence));
  folder.commit();
}

/// The folder that was asked for, before anything is run.
std::unique_ptr<faultsim::ResultFolder> open_output(const TradeoffArguments& arguments,
                                                    const TradeQuestion& question) {
  if (arguments.output.empty() || arguments.dry_run) return nullptr;
  std::vector<std::filesystem::path> inputs =
      faultsim::files_named_in(question.scene.value, question.scene.source);
  inputs.emplace_back(arguments.source);
  return std::make_unique<faultsim::ResultFolder>(faultsim::ResultFolder::Request{
      .option = "-o",
      .folder = arguments.output,
      .made_by = "faultsweep tradeoff",
      .names = {"report.md", "trade.json", "pareto.svg", "convergence.svg"},
      .inputs = std::move(inputs)});
}

/// The ladder before anything is run.
AnswerTable ladder_table(const std::vector<TradeAxis>& axes) {
  const Need all = Need::always;
  AnswerTable table{"choices",
                    "",
                    {{"axis", "axis", {}, 4, all},
                     {"choice", "choice", {}, 4, all},
                     {"unknowns", "unknowns", {}, 4, all},
                     {"jump_unknowns", "jumps", {}, 4, all},
                     {"predicted_operator_s", "operator", seconds(), 3, all},
                     {"predicted_memory_bytes", "memory", gigabytes(), 3, all},
                     {"left_out", "left out", {}, 4, all}}};
  for (const TradeAxis& axis : axes) {
    for (const TradeChoice& choice : axis.choices) {
      table.rows.push_back({axis.name, choice.name, choice.n_unknowns, choice.n_jump,
                            choice.predicted_seconds, choice.predicted_bytes, choice.left_out});
    }
  }
  return table;
}

ExitCode tradeoff(const StoreArguments& common, const TradeoffArguments& arguments) {
  const TradeQuestion question = read_question(arguments);
  const std::unique_ptr<faultsim::ResultFolder> output = open_output(arguments, question);
  const std::vector<TradeAxis> axes =
      make_ladder(question.scene, {arguments.operator_seconds, memory_limit(arguments)});
  json spec = ladder_spec(question.name, question.scene, axes);
  if (question.cases) {
    add_sample(*question.cases, question.scene.value, arguments.n_cases, arguments.tiers, spec);
  }
  const Expansion expansion = expand(parse_campaign(spec.dump(), question.scene.source));
  if (arguments.dry_run) {
    const AnswerTable ladder = ladder_table(axes);
    const std::size_t n_cases = expansion.cases.size(), n_families = expansion.families.size();
    if (common.json) {
      print_json({{"choices", json_rows(ladder)}, {"cases", n_cases}, {"families", n_families}});
    } else {
      print_text(render_text(ladder, screen_width()));
    }
    say(n_cases, " cases in ", n_families, " families");
    return ExitCode::done;
  }
  const auto [name, status] = submit_and_run(
      without_shown_fields(make_submission(expansion)),
      {.store = common.store, .n_workers = arguments.n_workers, .simulator = simulator_binary()});
  if (!has_results(status)) return status;

  Store store = Store::open_writer(common.store);
  const CampaignInfo campaign = store.campaign(name);
  const StoredLadder answers(store, campaign, expansion);
  TradeReport report;
  report.title = question.scene.value.value("title", std::string("untitled"));
  report.source = std::filesystem::path(arguments.source).filename();
  report.wanted_chi = arguments.wanted_chi;
  std::vector runs = mapped(axes, [&](const TradeAxis& axis) { return answers.runs(axis); });
  report.trade = make_trade(axes, runs);
  TradeRecord record{seconds_since_1970(), report.source, name, FAULTSIM_VERSION, "", {}};
  if (question.cases) {
    for (std::size_t k = 0; k + 1 < arguments.tiers.size(); ++k) {
      report.rankings.push_back(
          answers.rank(arguments.tiers[k], arguments.tiers.back(), record.error_bars));
    }
    for (ErrorBar& bar : record.error_bars) bar.campaign = question.cases->spec.name;
  }
  const json document = trade_to_json(report);
  record.report = document.dump();
  store.record_trade(record);
  if (output) write_report(*output, report, document);
  print_text(common.json ? faultsim::json_text(document) : trade_to_text(report, screen_width()));
  return status;
}

}  // namespace

void add_tradeoff(Program& program) {
  auto [command, t] = program.add(
      "tradeoff", "measure what each modelling choice costs in accuracy and time on a scene",
      tradeoff);
  command->add_option("source", t.source, "scene, or campaign spec (JSON)")->required();
  command->add_option("--set", t.settings, "/json/pointer=value of the scene");
  command
      ->add_option("--error", t.wanted_chi,
                   "error of the critical index to recommend a mesh for (default 0.02)")
      ->check(CLI::PositiveNumber)
      ->check(not_nan());
  command
      ->add_option("--operator-limit", t.operator_seconds,
                   "in s; choices whose operator is predicted to take longer are left out\n"
                   "(default 300)")
      ->check(CLI::PositiveNumber)
      ->check(not_nan());
  command->add_option("--memory", t.memory,
                      "the same for memory: \"12 GB\"; default: 0.8 of the memory available");
  command
      ->add_option("--cases", t.n_cases, "of a spec: how many are ranked at each tier (default 32)")
      ->check(CLI::Range(2, 100000));
  command
      ->add_option("--tiers", t.tiers,
                   "comma-separated, the last is the reference (default screening,standard)")
      ->delimiter(',');
  add_workers(command, t.n_workers, "default 1: two would distort each other's times");
  command->add_option("-o,--output", t.output, "folder for report.md, trade.json and figures");
  command->add_flag("--dry-run", t.dry_run, "only show the choices and their predicted cost");
  add_store(command, program.common);
  add_json(command, program.common);
  add_wide(command);
  command->footer(
      "Examples:\n"
      "  faultsweep tradeoff scene.json --dry-run\n"
      "  faultsweep tradeoff scene.json --error 0.01 -o trade\n"
      "  faultsweep tradeoff campaign.json --cases 16 --tiers screening,demonstration\n"
      "If interrupted, give the same command again: it continues where it stopped.");
}

}  // namespace faultsweep
