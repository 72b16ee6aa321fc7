
#include "campaign/answers/tiers.h"
#include "campaign/app/commands.h"
#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/expansion/submission.h"
#include "campaign/scheduler/starter.h"

namespace faultsweep {

namespace {

struct TiersArguments {
  std::string source;                                          ///< spec.
  std::vector<std::string> tiers = {"screening", "standard"};  ///< cheap and expensive.
  long budget = 0;                                             ///< samples at the expensive one.
  RunOptions run;
  TierRequest request;
};

/// The spec at a tier, with the tier's own mesh: its first samples where some are asked for.
ordered_json spec_at(const ordered_json& given, const std::string& tier, long most_samples) {
  ordered_json spec = given;
  spec["name"] = concat(given.at("name").get<std::string>(), "-", tier);
  ordered_json& set = spec["set"];
  if (set.is_null()) set = ordered_json::object();
  for (auto key = set.begin(); key != set.end();)
    key = key.key().starts_with("/mesh") || key.key() == "/tier" ? set.erase(key) : std::next(key);
  set["/tier"] = tier;
  set["/mesh"] = ordered_json::object();
  long& samples = *spec["design"]["samples"].get_ptr<ordered_json::number_integer_t*>();
  if (most_samples > 0) {  // the expensive tier, which is what is to be right
    samples = std::min(samples, most_samples);
    spec.erase("operators");
  }
  return spec;
}

/// The spec that was given, unless its design cannot be run at two tiers.
ordered_json read_spec(const TiersArguments& arguments) {
  const CampaignSpec spec = read_campaign(arguments.source);
  const bool is_sample = spec.groups.size() == 1 && spec.groups[0].designs.size() == 1 &&
                         spec.groups[0].designs[0].kind == DesignKind::monte_carlo;
  std::vector<Problem> problems;
  if (!is_sample) {
    problems.push_back(
        {"/design", spec.document.line_of("/design"),
         "the spec is not a single monte-carlo design, whose first samples both tiers share",
         "make it one; the first rows of other designs are not a random sample"});
  }
  if (spec.staged_sample || !spec.limits.empty()) {
    problems.push_back({"/", 0, "a spec with rounds or limits chooses further cases itself",
                        "remove that section"});
  }
  if (arguments.tiers.size() != 2 || arguments.tiers[0] == arguments.tiers[1]) {
    problems.push_back({"--tiers", 0, "these are not two different tiers",
                        "write --tiers screening,standard: the cheap one first"});
  }
  if (!problems.empty()) throw InputError(arguments.source, problems);
  return ordered_json::parse(spec.given);
}

ExitCode tiers(const StoreArguments& common, const TiersArguments& arguments) {
  const ordered_json given = read_spec(arguments);
  std::vector<std::string> names;
  ExitCode worst = ExitCode::done;
  std::vector<Submission> submissions;
  for (const bool is_high : {false, true}) {  // both are checked before anything runs
    const ordered_json spec =
        spec_at(given, arguments.tiers[is_high ? 1 : 0], is_high ? arguments.budget : 0);
    submissions.push_back(without_shown_fields(
        make_submission(expand(parse_campaign(spec.dump(), arguments.source)))));
  }
  for (const Submission& one : submissions) {
    RunOptions options = arguments.run;
    options.store = common.store;
    options.simulator = simulator_binary();
    const SubmittedRun run = submit_and_run(one, options);
    names.push_back(run.campaign);
    if (!has_results(run.status)) return run.status;
    if (run.status == ExitCode::incomplete) worst = run.status;
  }
  const Store store = Store::open_reader(common.store);
  const Tiers found =
      compare_tiers(store, store.campaign(names[0]), store.campaign(names[1]), arguments.request);
  print_answer(to_answer(found), common);
  return worst;
}

}  // namespace

void add_tiers(Program& program) {
  auto [command, t] = program.add(
      "tiers", "answers of an expensive tier from a cheap sample and few expensive cases", tiers);
  command->add_option("source", t.source, "spec (JSON) with a monte-carlo design")->required();
  command
      ->add_option("--tier-budget", t.budget,
                   "how many samples are run at the expensive tier; all run at the cheap one")
      ->required()
      ->check(CLI::Range(20, 100000));
  command
      ->add_option("--tiers", t.tiers,
                   "the cheap and the expensive tier (default screening,standard)")
      ->delimiter(',');
  command->add_option("--metrics", t.request.metrics,
                      "metrics whose means are wanted, comma-separated; default, without\n"
                      "--quantiles: chi_bar of each fault");
  command
      ->add_option("--of", t.request.conditions,
                   "condition whose probability is wanted, as for `rank --where`; may be\n"
                   "repeated; default, without --quantiles: each fault slides, in each stage")
      ->allow_extra_args(false);
  CLI::Option* quantiles = command->add_option(
      "--quantiles", t.request.quantiles,
      "metrics whose quantiles are wanted, comma-separated, as for `probability`");
  command->add_option("--at", t.request.at, "levels of the quantiles (default 0.05,0.5,0.95)")
      ->delimiter(',')
      ->needs(quantiles);
  command
      ->add_option("--width", t.request.width,
                   "wanted distance of the bounds of probabilities, as a share: says which\n"
                   "numbers of cases reach it, its half and its quarter in the least time;\n"
                   "for other answers, half and a quarter of the present distance")
      ->check(CLI::Range(1e-4, 1.0))
      ->check(not_nan());
  add_workers(command, t.run.n_workers, "of the runs; default: the cores available");
  add_build_limits(command, t.run);
  add_confidence(command, t.request.confidence);
  add_store(command, program.common);
  add_renderings(command, program.common);
  command->footer(
      "Examples:\n"
      "  faultsweep tiers sample.json --tier-budget 40\n"
      "  faultsweep tiers sample.json --tier-budget 100 --tiers screening,demonstration --json\n"
      "  faultsweep tiers sample.json --tier-budget 60 --quantiles F2.chi_bar --at 0.5,0.95\n"
      "  faultsweep tiers sample.json --tier-budget 60 --of F2.slides --width 0.02\n"
      "Campaigns NAME-screening and NAME-standard are submitted and run; to continue, give the\n"
      "command again.");
}

}  // namespace faultsweep
