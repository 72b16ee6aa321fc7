#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "campaign/answers/what_matters.h"
#include "campaign/answers/why.h"
#include "campaign/app/commands.h"
#include "campaign/app/print_answer.h"
#include "campaign/render/render_text.h"
#include "campaign/reports/case_report.h"
#include "campaign/reports/explain_report.h"
#include "campaign/reports/status_report.h"
#include "campaign/rounds/next_round.h"
#include "campaign/scheduler/starter.h"
#include "campaign/store/clock.h"
#include "simulator/cache/operator_cache.h"
#include "simulator/files/json_text.h"
#include "simulator/files/output_target.h"
#include "simulator/plan/plan.h"

namespace faultsweep {

using faultsim::concat;
using faultsim::counted;
using faultsim::InputError;
using nlohmann::json;

namespace {

void print(const std::string& text) { std::fputs(text.c_str(), stdout); }
void print(const json& document) { print(faultsim::json_text(document)); }

/// A case addressed as CASE or CAMPAIGN/CASE.
struct NamedCase {
  CampaignInfo campaign;
  StoredCase stored;
};

NamedCase find_case(const Store& store, const StoreArguments& common, const std::string& name) {
  const std::size_t slash = name.rfind('/');
  const bool has_campaign = slash != std::string::npos;
  NamedCase found;
  found.campaign = store.campaign(has_campaign ? name.substr(0, slash) : common.campaign, false);
  found.stored = store.stored_case(found.campaign.id, has_campaign ? name.substr(slash + 1) : name);
  return found;
}

}  // namespace

std::uint64_t parse_size(const std::string& option, const std::string& text) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  std::string unit(end);
  unit.erase(0, unit.find_first_not_of(' ') == std::string::npos ? unit.size()
                                                                 : unit.find_first_not_of(' '));
  const double factor = unit == "GB" ? 1e9 : unit == "MB" ? 1e6 : unit == "kB" ? 1e3 : 1;
  const bool known = factor != 1 || (unit.empty() && number == 0) || unit == "B";
  if (end == text.c_str() || !(number >= 0) || number > 1e9 || !known) {
    throw InputError(option,
                     {{"", 0, concat("\"", text, "\" is not a size"), "write \"20 GB\" or 0"}});
  }
  return static_cast<std::uint64_t>(number * factor);
}

std::filesystem::path simulator_binary() {
  if (const char* given = std::getenv("FAULTSIM_BINARY")) return std::filesystem::absolute(given);
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / "faultsim";
}

ExitCode run_command(const StoreArguments& common, RunOptions options, int argc, char** argv) {
  options.store = common.store;
  options.campaign = common.campaign;
  if (options.simulator.empty()) options.simulator = simulator_binary();
  if (!options.memory.empty()) {
    options.memory_bytes = static_cast<double>(parse_size("--memory", options.memory));
  }
  options.next_round = add_next_round;
  if (is_rank()) return run_ranks(argc, argv, options);
  const ExitCode status = start_ranks(options);
  const std::string name = Store::open_reader(common.store).campaign(options.campaign).name;
  switch (status) {
    case ExitCode::done:
    case ExitCode::incomplete:
      std::fprintf(stderr, "Next: faultsweep rank %s --store %s\n", name.c_str(),
                   common.store.c_str());
      break;
    case ExitCode::interrupted:
      std::fprintf(stderr, "Interrupted, nothing is lost. Next: faultsweep run %s --store %s\n",
                   name.c_str(), common.store.c_str());
      break;
    default:
      break;
  }
  return status;
}

ExitCode slurm_command(const StoreArguments& common, const SlurmRequest& request) {
  const Store store = Store::open_reader(common.store);
  const CampaignInfo campaign = store.campaign(common.campaign, false);
  SlurmCampaign job;
  job.name = campaign.name;
  job.store = std::filesystem::absolute(common.store).lexically_normal();
  job.program = std::filesystem::read_symlink("/proc/self/exe");
  job.simulator = simulator_binary();
  job.waiting = store.waiting_families(campaign.id);
  print(slurm_script(job, request));
  if (job.waiting.empty()) {
    std::fprintf(stderr, "Nothing waits in %s\n", campaign.name.c_str());
  } else {
    std::fprintf(stderr, "Next: faultsweep slurm %s ... | sbatch\n", campaign.name.c_str());
  }
  return ExitCode::done;
}

ExitCode status_command(const StoreArguments& common) {
  const Store store = Store::open_reader(common.store);
  const StatusReport status = make_status(store, common.campaign);
  print_answer(to_answer(status), common);
  if (common.json) return ExitCode::done;
  const CampaignInfo& c = status.campaign;
  if (!status.manager && c.n_waiting > 0 && !c.cancelled) {
    std::fprintf(stderr, "Next: faultsweep run %s\n", c.name.c_str());
  } else if (c.cancelled && c.n_waiting > 0) {
    std::fprintf(stderr, "Next: faultsweep submit %s, which reopens it\n", c.source.c_str());
  } else if (c.n_done > 0) {
    std::fprintf(stderr, "Next: faultsweep rank %s\n", c.name.c_str());
  }
  return ExitCode::done;
}

ExitCode verify_store_command(const StoreArguments& common) {
  const std::vector<std::string> problems = Store::open_reader(common.store).integrity_problems();
  if (common.json) {
    print(json{{"sound", problems.empty()}, {"problems", problems}});
  } else if (problems.empty()) {
    print(std::string("the store is sound: structure, references, checksums\n"));
  } else {
    for (const std::string& problem : problems) print(problem + "\n");
  }
  if (problems.empty()) return ExitCode::done;
  throw faultsim::StorageError(concat("the store ", common.store.string(), " has ",
                                      counted(problems.size(), "problem", "problems"), "; ",
                                      kDamageCure));
}

ExitCode rank_command(const StoreArguments& common, const RankRequest& request, bool list_metrics) {
  if (list_metrics) {
    print_answer(metrics_answer(), common);
    return ExitCode::done;
  }
  const Store store = Store::open_reader(common.store);
  const CampaignInfo c = store.campaign(common.campaign, store.lacks_results());
  const Ranking ranking = make_ranking(store, c, request);
  print_answer(to_answer(ranking), common);
  if (common.json) return ExitCode::done;
  const long n_failed = c.n_failed - c.n_fields_failed;
  const long n_waiting = c.n_waiting - c.n_fields_waiting;
  if (n_waiting + n_failed > 0) {
    std::fprintf(stderr, "%ld of %ld cases have no result yet (%ld failed)\n", n_waiting + n_failed,
                 c.n_cases, n_failed);
  }
  if (!ranking.rows.empty()) {
    std::fprintf(stderr, "Next: faultsweep show %s/%ld\n", c.name.c_str(),
                 ranking.rows[0].position);
  }
  return ExitCode::done;
}

ExitCode rank_why_command(const StoreArguments& common, const RankRequest& request,
                          const std::string& name) {
  const Store store = Store::open_reader(common.store);
  const NamedCase found = find_case(store, common, name);
  print_answer(to_answer(explain_rank(store, found.campaign, found.stored, request)), common);
  return ExitCode::done;
}

ExitCode show_command(const StoreArguments& common, const std::string& name,
                      const ShowRequest& request) {
  const Store store = Store::open_reader(common.store);
  const NamedCase found = find_case(store, common, name);
  print_answer(to_answer(shown_case(store, found.campaign, found.stored, request)), common);
  return ExitCode::done;
}

namespace {

ExitCode curves_command(const StoreArguments& common, const Store& store,
                        const ProbabilityArguments& arguments) {
  const ProbabilityRequest& request = arguments.request;
  const Curves found =
      probability_curves(store, store.campaign(common.campaign, false),
                         {*arguments.against, request.where, arguments.stage, request.confidence});
  print_answer(to_answer(found), common);
  return ExitCode::done;
}

}  // namespace

ExitCode probability_command(const StoreArguments& common, const ProbabilityArguments& arguments) {
  const Store store = Store::open_reader(common.store);
  if (arguments.against) return curves_command(common, store, arguments);
  if (!arguments.quantiles.metrics.empty()) {
    QuantileRequest request = arguments.quantiles;
    request.where = arguments.request.where;
    request.confidence = arguments.request.confidence;
    const Quantiles found = find_quantiles(store, store.campaign(common.campaign, false), request);
    print_answer(to_answer(found), common);
    return ExitCode::done;
  }
  const Probability found =
      find_probability(store, store.campaign(common.campaign, false), arguments.request);
  print_answer(to_answer(found), common);
  return ExitCode::done;
}

ExitCode posterior_command(const StoreArguments& common, const PosteriorRequest& request) {
  const Store store = Store::open_reader(common.store);
  const Posterior found = find_posterior(store, store.campaign(common.campaign, false), request);
  print_answer(to_answer(found), common);
  return ExitCode::done;
}

ExitCode sensitivity_command(const StoreArguments& common, const SensitivityRequest& request) {
  const Store store = Store::open_reader(common.store);
  print_answer(what_matters(store, store.campaign(common.campaign, false), request), common);
  return ExitCode::done;
}

ExitCode export_command(const StoreArguments& common, ExportRequest request) {
  if (faultsim::is_standard_output(request.target) && request.format != ExportFormat::salib) {
    request.target.clear();
  }
  const Store store = Store::open_reader(common.store);
  const CampaignInfo campaign = store.campaign(common.campaign, false);
  std::fputs(export_campaign(store, campaign, request).c_str(), stderr);
  return ExitCode::done;
}

ExitCode compare_command(const StoreArguments& common, const CompareArguments& arguments) {
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

ExitCode explain_command(const StoreArguments& common, const std::string& name) {
  const Store store = Store::open_reader(common.store);
  const NamedCase found = find_case(store, common, name);
  print_answer(explanation(store, found.campaign, found.stored), common);
  return ExitCode::done;
}

namespace {

/// Why `retry` found nothing to do.
std::string nothing_to_retry(const Store& store, const CampaignInfo& campaign,
                             const RetryArguments& arguments) {
  if (!arguments.position) {
    const long n_early = campaign.n_done - campaign.n_complete();
    if (n_early == 0 || arguments.unconverged) return "no case of " + campaign.name + " failed";
    return concat("no case of ", campaign.name, " failed; ", n_early,
                  " have a history that ends early: --unconverged lets them run again");
  }
  const StoredCase one = store.stored_case(campaign.id, std::to_string(*arguments.position));
  const std::string name = concat("case ", one.position);
  if (one.state == "waiting") return name + " waits already";
  if (faultsim::in_equilibrium(one.result.outcome)) {
    return concat(name, " has a full result (", faultsim::to_string(one.result.outcome),
                  "): the same scene gives the same numbers");
  }
  return concat(name, " has a history that ends early (", faultsim::to_string(one.result.outcome),
                "): --unconverged lets it run again");
}

}  // namespace

ExitCode retry_command(const StoreArguments& common, const RetryArguments& arguments) {
  Store::open_reader(common.store);
  Store store = Store::open_writer(common.store);
  const CampaignInfo campaign = store.campaign(common.campaign);
  if (const auto owner = store.owner(); owner && owner->alive && owner->campaign == campaign.id) {
    throw faultsim::StorageError(
        concat(campaign.name, " is running; stop it, or wait for its end"));
  }
  // Throws where there is no such case.
  if (arguments.position) store.stored_case(campaign.id, std::to_string(*arguments.position));
  const long count = store.retry(campaign.id, arguments.unconverged, arguments.position);
  if (common.json) {
    print(json{{"campaign", campaign.name}, {"retried", count}});
  } else {
    std::printf("%ld\n", count);
  }
  if (count == 0) {
    std::fprintf(stderr, "%s\n", nothing_to_retry(store, campaign, arguments).c_str());
    return ExitCode::done;
  }
  const std::string next = campaign.cancelled
                               ? concat("submit ", campaign.source, ", which reopens it")
                               : "run " + campaign.name;
  std::fprintf(stderr, "%ld %s of %s %s again. Next: faultsweep %s\n", count,
               count == 1 ? "case" : "cases", campaign.name.c_str(), count == 1 ? "waits" : "wait",
               next.c_str());
  return ExitCode::done;
}

ExitCode cancel_command(const StoreArguments& common) {
  Store::open_reader(common.store);
  Store store = Store::open_writer(common.store);
  const CampaignInfo campaign = store.campaign(common.campaign);
  const bool was_cancelled = campaign.cancelled;
  if (!was_cancelled) store.cancel(campaign.id);
  std::fprintf(stderr, "%s %s cancelled with %ld of %ld cases waiting; results stay\n",
               campaign.name.c_str(), was_cancelled ? "was already" : "is", campaign.n_waiting,
               campaign.n_cases);
  if (common.json) {
    print(json{{"campaign", campaign.name},
               {"was_cancelled", was_cancelled},
               {"cases", campaign.n_cases},
               {"waiting", campaign.n_waiting}});
  }
  const auto owner = store.owner();
  if (owner && owner->alive && owner->campaign == campaign.id) {
    std::fprintf(stderr, "Its manager hands out nothing more and ends with the cases at work.\n");
  }
  std::fprintf(stderr, "faultsweep submit %s reopens it.\n", campaign.source.c_str());
  return ExitCode::done;
}

ExitCode cache_list_command(const StoreArguments& common) {
  const auto entries = faultsim::list_operators(common.store / "operators");
  json document = json::array();
  AnswerTable table{"operators",
                    "",
                    {{"operator", "operator", {}, 4, Need::always},
                     {"bytes", "size", {"MB", 1e6, "B"}, 4, Need::always},
                     {"last_used", "last used", {}, 4, Need::always}}};
  for (const faultsim::CacheEntry& entry : entries) {
    document.push_back({{"operator", entry.fingerprint},
                        {"bytes", entry.bytes},
                        {"last_used_at", entry.last_used}});
    table.rows.push_back({entry.fingerprint, static_cast<double>(entry.bytes),
                          format_time(static_cast<double>(entry.last_used))});
  }
  if (common.json) {
    print(json{{"operators", document}});
  } else {
    print(entries.empty() ? "the cache is empty\n" : render_text(table, screen_width()));
  }
  return ExitCode::done;
}

ExitCode cache_verify_command(const StoreArguments& common) {
  const std::filesystem::path folder = common.store / "operators";
  bool sound = true;
  json checked = json::array();
  const auto report = [&](const std::string& name, const std::string& problem) {
    sound = sound && problem.empty();
    checked.push_back({{"name", name}, {"sound", problem.empty()}, {"problem", problem}});
    if (!common.json) print(concat(name, "  ", problem.empty() ? "sound" : problem, "\n"));
  };
  for (const faultsim::CacheEntry& entry : faultsim::list_operators(folder)) {
    std::string remark;
    const bool good = faultsim::read_operator(folder, entry.fingerprint, &remark).has_value();
    report(entry.fingerprint, good ? "" : remark.empty() ? "it is gone" : remark);
  }
  if (std::filesystem::exists(common.store / "campaign.sqlite")) {
    for (const std::string& problem : Store::open_reader(common.store).integrity_problems()) {
      report("campaign.sqlite", problem);
    }
  }
  if (common.json) print(json{{"sound", sound}, {"checked", checked}});
  return sound ? ExitCode::done : ExitCode::world;
}

ExitCode cache_prune_command(const StoreArguments& common, const std::string& size) {
  const auto freed =
      faultsim::prune_operators(common.store / "operators", parse_size("--max-size", size), "");
  if (common.json) {
    print(json{{"bytes_freed", freed}});
    return ExitCode::done;
  }
  std::printf("%llu\n", static_cast<unsigned long long>(freed));
  std::fprintf(stderr, "bytes freed; what is missing is built again when it is needed\n");
  return ExitCode::done;
}

ExitCode backup_command(const StoreArguments& common, const std::filesystem::path& target) {
  const Store store = Store::open_reader(common.store);
  faultsim::require_writable_file("file", target, faultsim::FileKind::database, {});
  store.backup_to(target);
  std::fprintf(stderr, "backup written to %s\n", target.c_str());
  return ExitCode::done;
}

}  // namespace faultsweep
