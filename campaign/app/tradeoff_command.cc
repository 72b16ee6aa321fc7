#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "campaign/app/child_output.h"
#include "campaign/app/commands.h"
#include "campaign/app/nightly_sample.h"
#include "campaign/app/submission.h"
#include "campaign/report/kendall.h"
#include "campaign/report/text_table.h"
#include "campaign/scheduler/resources.h"
#include "campaign/scheduler/starter.h"
#include "campaign/store/clock.h"
#include "campaign/tradeoff/trade_report.h"
#include "simulator/scene/read_scene.h"

namespace faultsweep {

using faultsim::concat;
using faultsim::InputError;
using faultsim::JsonDocument;
using nlohmann::json;

namespace {

constexpr double kShareOfMemory = 0.8;
constexpr long kTop = 10;  // of a ranking, at most a third of it

void apply(const std::vector<std::string>& settings, JsonDocument& document) {
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos) {
      throw InputError("--set", {{"", 0, concat("'", setting, "' has no '='"),
                                  "write --set /friction/friction_angle=\"25 deg\""}});
    }
    faultsim::set_value(document, setting.substr(0, equals), setting.substr(equals + 1));
  }
}

/// What was asked about: a scene, and cases of it where a spec was given.
struct Question {
  JsonDocument scene;
  std::string name;  ///< of the campaign that answers it.
  std::optional<Expansion> cases;
};

Question read_question(const TradeoffArguments& arguments) {
  Question question{faultsim::read_json_file(arguments.source), "", std::nullopt};
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
    throw InputError(
        "--tiers", {{"", 0, "one tier is nothing to compare", "write --tiers screening,standard"}});
  }
  if (!arguments.settings.empty()) {
    throw InputError("--set", {{"", 0, "a spec has its own \"set\"", "put it there"}});
  }
  question.cases = expand(read_campaign(arguments.source));
  question.scene = {question.cases->spec.scene_source, question.cases->spec.groups[0].scene, {}};
  for (const std::string& tier : arguments.tiers) {
    JsonDocument at_it = question.scene;
    at_it.value["tier"] = tier;
    std::vector<faultsim::Problem> problems;
    faultsim::read_scene(at_it, problems);
    if (!problems.empty()) {
      throw InputError("--tiers", {{"", 0, concat("'", tier, "': ", problems.front().what),
                                    problems.front().cure}});
    }
  }
  return question;
}

/// The case at a tier, as changes of the base scene: what it has differently, without its own mesh.
json at_tier(const json& base, json scene, const std::string& tier) {
  scene["tier"] = tier;
  scene["mesh"] = json::object();
  if (scene.contains("numerics")) scene["numerics"].erase("plane_strain");
  json changes = json::object();
  for (const auto& [key, value] : scene.items()) {
    if (!base.contains(key) || base[key] != value) changes["/" + key] = value;
  }
  return changes;
}

/// A step through n cases that visits all and keeps away from the strides of a grid: near the
/// golden section of n and coprime to it.
long scattering_stride(long n) {
  long stride = std::max(1L, std::lround(0.6180339887 * static_cast<double>(n)));
  while (std::gcd(stride, n) != 1) ++stride;
  return stride;
}

/// Adds a group per tier with the same sample of the campaign's cases.
void add_sample(const Question& question, const TradeoffArguments& arguments, json& spec) {
  const Expansion& all = *question.cases;
  const auto n = static_cast<long>(all.cases.size());
  const long n_sampled = std::min(n, arguments.n_cases);
  const long stride = scattering_stride(n);
  for (const std::string& tier : arguments.tiers) {
    json variants = json::object();
    for (long k = 0; k < n_sampled; ++k) {
      const auto index = static_cast<std::size_t>(k * stride % n);
      variants[concat("case ", index + 1)] =
          at_tier(question.scene.value, scene_of(all, all.cases[index]), tier);
    }
    json parameters;
    parameters["choice"]["variants"] = variants;
    spec["design"]["groups"].push_back(
        {{"name", "ranking, " + tier}, {"design", {{"kind", "grid"}, {"parameters", parameters}}}});
  }
}

double memory_limit(const TradeoffArguments& arguments) {
  if (arguments.memory.empty()) return kShareOfMemory * available_memory();
  return static_cast<double>(parse_size("--memory", arguments.memory));
}

/// The stored results of the ladder's campaign, by group and choice.
class Answers {
 public:
  Answers(const Store& store, const CampaignInfo& campaign, const Expansion& expansion)
      : store_(store), campaign_(campaign), expansion_(expansion) {
    for (const Store::FamilyProgress& family : store.family_progress(campaign.id)) {
      families_.emplace(family.fingerprint, family);
    }
    for (const RankedCase& row : store.ranking(campaign.id, {})) {
      place_.emplace(row.position, static_cast<long>(place_.size()));
    }
  }

  /// Positions of the group's cases by the name of the choice.
  std::map<std::string, long> positions(const std::string& group) const {
    std::map<std::string, long> all;
    for (std::size_t g = 0; g < expansion_.spec.groups.size(); ++g) {
      if (expansion_.spec.groups[g].name != group) continue;
      const Parameter& choice = expansion_.spec.groups[g].parameters.at(0);
      for (std::size_t row = 0; row < choice.choices.size(); ++row) {
        const int index = expansion_.case_of_row[g].at(row);
        if (index >= 0) all.emplace(choice.choices[row].text, index + 1);
      }
    }
    return all;
  }

  TradeRun run(long position) const {
    const StoredCase stored = store_.stored_case(campaign_.id, std::to_string(position));
    TradeRun run;
    const auto family = families_.find(stored.family);
    if (family != families_.end()) {
      run.operator_seconds = family->second.build_seconds.value_or(kUnknown);
      if (family->second.peak_bytes)
        run.peak_bytes = static_cast<double>(*family->second.peak_bytes);
    }
    if (stored.has_result) {
      run.result = stored.result;
      run.case_seconds = stored.result.seconds;
    } else if (!stored.runs.empty()) {
      run.trouble = concat(stored.runs.back().status, ": ", stored.runs.back().reason);
    } else {
      run.trouble = "not run";
    }
    return run;
  }

  std::vector<TradeRun> runs(const TradeAxis& axis) const {
    const auto where = positions(axis.name);
    std::vector<TradeRun> all;
    for (const TradeChoice& choice : axis.choices) {
      const auto position = where.find(choice.name);
      all.push_back(position == where.end() ? TradeRun() : run(position->second));
    }
    return all;
  }

  RankingTrade rank(const std::string& tier, const std::string& reference,
                    std::vector<ErrorBar>& bars) const {
    const auto a = positions("ranking, " + tier), b = positions("ranking, " + reference);
    RankingTrade trade;
    trade.choice = tier;
    trade.reference = reference;
    std::map<std::string, double> chi, slip;  // differences
    std::vector<std::pair<long, long>> places;
    std::map<std::string, double> operators_a, operators_b;
    for (const auto& [name, position] : a) {
      const TradeRun one = run(position), other = run(b.at(name));
      add_cost(position, one, operators_a, trade.seconds);
      add_cost(b.at(name), other, operators_b, trade.reference_seconds);
      if (!is_complete(one) || !is_complete(other)) continue;
      places.emplace_back(place_.at(position), place_.at(b.at(name)));
      chi[name] = one.result->whole.chi_bar - other.result->whole.chi_bar;
      slip[name] = one.result->whole.max_slip - other.result->whole.max_slip;
      trade.n_flips += one.result->whole.activated != other.result->whole.activated;
    }
    trade.n_cases = static_cast<long>(places.size());
    for (const auto& [fingerprint, seconds] : operators_a) trade.seconds += seconds;
    for (const auto& [fingerprint, seconds] : operators_b) trade.reference_seconds += seconds;
    if (places.empty()) return trade;
    compare_places(places, trade);
    bars.push_back(bar(trade, "chi_bar", chi));
    bars.push_back(bar(trade, "max_slip", slip));
    trade.chi_rms = bars[bars.size() - 2].rms;
    trade.chi_max = bars[bars.size() - 2].largest;
    return trade;
  }

 private:
  static bool is_complete(const TradeRun& run) {
    return run.result && faultsim::in_equilibrium(run.result->outcome);
  }

  void add_cost(long position, const TradeRun& run, std::map<std::string, double>& operators,
                double& seconds) const {
    if (!std::isnan(run.case_seconds)) seconds += run.case_seconds;
    const std::size_t index = static_cast<std::size_t>(position - 1);
    const Family& family =
        expansion_.families[static_cast<std::size_t>(expansion_.cases[index].family)];
    if (!std::isnan(run.operator_seconds)) operators[family.fingerprint] = run.operator_seconds;
  }

  /// Kendall's τ and how many of the first are the same.
  static void compare_places(const std::vector<std::pair<long, long>>& places,
                             RankingTrade& trade) {
    std::vector<long> first, second;
    for (const auto& [a, b] : places) {
      first.push_back(a);
      second.push_back(b);
    }
    trade.tau = kendall_tau_b(first, second);
    trade.n_top = std::min(kTop, std::max(1L, trade.n_cases / 3));
    const auto is_top = [&](const std::vector<long>& all, std::size_t k) {
      return std::count_if(all.begin(), all.end(), [&](long other) { return other < all[k]; }) <
             trade.n_top;
    };
    for (std::size_t k = 0; k < places.size(); ++k) {
      trade.n_top_common += is_top(first, k) && is_top(second, k);
    }
  }

  static ErrorBar bar(const RankingTrade& trade, const std::string& metric,
                      const std::map<std::string, double>& differences) {
    ErrorBar bar{"", trade.choice, metric, trade.reference, trade.n_cases, 0, 0};
    for (const auto& [name, difference] : differences) {
      bar.rms += difference * difference;
      bar.largest = std::max(bar.largest, std::abs(difference));
    }
    bar.rms = std::sqrt(bar.rms / static_cast<double>(differences.size()));
    return bar;
  }

  const Store& store_;
  const CampaignInfo& campaign_;
  const Expansion& expansion_;
  std::map<std::string, Store::FamilyProgress> families_;
  std::map<long, long> place_;  ///< in the default order of all.
};

void write_file(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw faultsim::StorageError(concat("cannot write ", path.string()));
}

void write_report(const std::filesystem::path& folder, const TradeReport& report) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw faultsim::StorageError(concat("cannot make ", folder.string(), ": ", error.message()));
  write_file(folder / "report.md", trade_to_markdown(report));
  write_file(folder / "trade.json", trade_to_json(report).dump(1) + "\n");
  write_file(folder / "figures.gp", trade_figures(report));
  const std::string draw = concat("cd '", folder.string(), "' && gnuplot figures.gp");
  if (run_child({"/bin/sh", "-c", draw}).code != 0) {
    std::fprintf(stderr,
                 "faultsweep: no figures: gnuplot did not run; install gnuplot-nox, then %s\n",
                 draw.c_str());
  }
}

/// The ladder before anything is run.
std::string ladder_to_text(const std::vector<TradeAxis>& axes) {
  TextTable table({"axis", "choice", "unknowns", "jumps", "operator/s", "memory/GB", "left out"});
  for (const TradeAxis& axis : axes) {
    for (const TradeChoice& choice : axis.choices) {
      table.add_row({axis.name, choice.name, std::to_string(choice.n_unknowns),
                     std::to_string(choice.n_jump), format_number(choice.predicted_seconds, 3),
                     format_number(choice.predicted_bytes / 1e9, 3), choice.left_out});
    }
  }
  return table.text();
}

ExitCode run_ladder(const StoreArguments& common, const TradeoffArguments& arguments,
                    const std::string& campaign) {
  RunOptions options;
  options.store = common.store;
  options.campaign = campaign;
  options.n_workers = arguments.n_workers;
  options.simulator = simulator_binary();
  return start_ranks(options);
}

}  // namespace

ExitCode tradeoff_command(const StoreArguments& common, const TradeoffArguments& arguments) {
  const Question question = read_question(arguments);
  const std::vector<TradeAxis> axes =
      make_ladder(question.scene, {arguments.operator_seconds, memory_limit(arguments)});
  json spec = ladder_spec(question.name, question.scene, axes);
  if (question.cases) add_sample(question, arguments, spec);
  const Expansion expansion = expand(parse_campaign(spec.dump(), question.scene.source));
  if (arguments.dry_run) {
    std::fputs(ladder_to_text(axes).c_str(), stdout);
    std::fprintf(stderr, "%zu cases in %zu families\n", expansion.cases.size(),
                 expansion.families.size());
    return ExitCode::done;
  }
  const SubmitOutcome submitted =
      Store::open_writer(common.store).submit(make_submission(expansion));
  const ExitCode status = run_ladder(common, arguments, submitted.name);
  if (status != ExitCode::done && status != ExitCode::incomplete) return status;

  Store store = Store::open_writer(common.store);
  const CampaignInfo campaign = store.campaign(submitted.name);
  const Answers answers(store, campaign, expansion);
  TradeReport report;
  report.title = question.scene.value.value("title", std::string("untitled"));
  report.source = std::filesystem::path(arguments.source).filename();
  report.wanted_chi = arguments.wanted_chi;
  std::vector<std::vector<TradeRun>> runs;
  for (const TradeAxis& axis : axes) runs.push_back(answers.runs(axis));
  report.trade = make_trade(axes, runs);
  TradeRecord record{seconds_since_1970(), report.source, submitted.name, FAULTSIM_VERSION, "", {}};
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
  if (!arguments.output.empty()) write_report(arguments.output, report);
  std::fputs(common.json ? (document.dump(2) + "\n").c_str() : trade_to_text(report).c_str(),
             stdout);
  return ExitCode::done;
}

}  // namespace faultsweep
