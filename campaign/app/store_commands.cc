#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "campaign/answers/why.h"
#include "campaign/app/certify.h"
#include "campaign/app/commands.h"
#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/render/render.h"
#include "campaign/reports/case_report.h"
#include "campaign/reports/ranking_answer.h"
#include "campaign/reports/status_report.h"
#include "campaign/store/clock.h"
#include "simulator/cache/operator_cache.h"
#include "simulator/files/output_target.h"

namespace faultsweep {

NamedCase find_case(const Store& store, const std::string& campaign, const std::string& name) {
  const std::size_t slash = name.rfind('/');
  const bool has_campaign = slash != std::string::npos;
  NamedCase found;
  found.campaign = store.campaign(has_campaign ? name.substr(0, slash) : campaign, false);
  found.stored = store.stored_case(found.campaign.id, has_campaign ? name.substr(slash + 1) : name);
  return found;
}

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

namespace {

/// Prints what is answered of a case.
template <typename AnswerOf>
ExitCode answer_case(const StoreArguments& common, const std::string& name,
                     const AnswerOf& answer) {
  const Store store = Store::open_reader(common.store);
  print_answer(answer(store, find_case(store, common.campaign, name)), common);
  return ExitCode::done;
}

ExitCode verify_store(const StoreArguments& common) {
  const std::vector<std::string> problems = Store::open_reader(common.store).integrity_problems();
  if (common.json) {
    print_json({{"sound", problems.empty()}, {"problems", problems}});
  } else if (problems.empty()) {
    print_text("the store is sound: structure, references, checksums\n");
  } else {
    for (const std::string& problem : problems) print_text(problem + "\n");
  }
  if (problems.empty()) return ExitCode::done;
  throw StorageError(concat("the store ", common.store.string(), " has ",
                            counted(problems.size(), "problem", "problems"), "; ", kDamageCure));
}

struct StatusArguments {
  bool verify = false;
  bool all = false;
};

ExitCode status(const StoreArguments& common, const StatusArguments& arguments) {
  if (arguments.verify) return verify_store(common);
  const Store store = Store::open_reader(common.store);
  if (arguments.all) {
    print_answer(campaigns_answer(store), common);
    return ExitCode::done;
  }
  const StatusReport report = make_status(store, common.campaign);
  print_answer(to_answer(report), common);
  if (common.json) return ExitCode::done;
  const CampaignInfo& c = report.campaign;
  if (!report.manager && c.n_waiting > 0 && !c.cancelled) {
    say("Next: faultsweep run ", c.name);
  } else if (c.cancelled && c.n_waiting > 0) {
    say("Next: faultsweep submit ", c.source, ", which reopens it");
  } else if (c.n_done > 0) {
    say("Next: faultsweep rank ", c.name);
  }
  return ExitCode::done;
}

struct RankArguments {
  RankRequest request = {};
  std::string why = {};
  bool list_metrics = false;
  CertifyRequest certify = {};
};

ExitCode rank(const StoreArguments& common, const RankArguments& arguments) {
  if (!arguments.why.empty()) {
    return answer_case(common, arguments.why, [&](const Store& store, const NamedCase& found) {
      return to_answer(explain_rank(store, found.campaign, found.stored, arguments.request));
    });
  }
  if (arguments.list_metrics) {
    print_answer(metrics_answer(), common);
    return ExitCode::done;
  }
  if (arguments.certify.n > 0) {
    CertifyRequest request = arguments.certify;
    request.ranking = arguments.request;
    return request.tier.empty() ? certify(common, request) : certify_at_tier(common, request);
  }
  const Store store = Store::open_reader(common.store);
  const CampaignInfo c = store.campaign(common.campaign, store.lacks_results());
  const Ranking ranking = make_ranking(store, c, arguments.request);
  print_answer(to_answer(ranking), common);
  if (common.json) return ExitCode::done;
  const long n_failed = c.n_failed - c.n_fields_failed;
  const long n_waiting = c.n_waiting - c.n_fields_waiting;
  if (n_waiting + n_failed > 0) {
    say(n_waiting + n_failed, " of ", c.n_cases, " cases have no result yet (", n_failed,
        " failed)");
  }
  if (!ranking.rows.empty()) say("Next: faultsweep show ", c.name, "/", ranking.rows[0].position);
  return ExitCode::done;
}

struct ShowArguments {
  std::string name;  ///< case number, beginning of an identity, or CAMPAIGN/either.
  ShowRequest request = {};
};

ExitCode show(const StoreArguments& common, const ShowArguments& arguments) {
  return answer_case(common, arguments.name, [&](const Store& store, const NamedCase& found) {
    return to_answer(shown_case(store, found.campaign, found.stored, arguments.request));
  });
}

ExitCode explain(const StoreArguments& common, const std::string& name) {
  return answer_case(common, name, [](const Store& store, const NamedCase& found) {
    return explanation(store, found.campaign, found.stored);
  });
}

struct RetryArguments {
  bool unconverged = false;
  std::optional<long> position;
};

/// Why `retry` found nothing to do.
std::string nothing_to_retry(const Store& store, const CampaignInfo& campaign,
                             const RetryArguments& arguments) {
  if (!arguments.position) {
    const long n_early = campaign.n_done - campaign.n_complete();
    if (n_early == 0 || arguments.unconverged) return "no case of " + campaign.name + " failed";
    return concat("no case of ", campaign.name, " failed; ", n_early,
                  " have a history that ends early: add --unconverged to run them again");
  }
  const StoredCase one = store.stored_case(campaign.id, std::to_string(*arguments.position));
  const std::string name = concat("case ", one.position);
  if (one.state == "waiting") return name + " is waiting already";
  if (faultsim::in_equilibrium(one.result.outcome)) {
    return concat(name, " has a full result (", to_string(one.result.outcome),
                  "): a second run would give the same numbers");
  }
  return concat(name, " has a history that ends early (", to_string(one.result.outcome),
                "): add --unconverged to run it again");
}

ExitCode retry(const StoreArguments& common, const RetryArguments& arguments) {
  Store::open_reader(common.store);
  Store store = Store::open_writer(common.store);
  const CampaignInfo campaign = store.campaign(common.campaign);
  if (const auto owner = store.owner(); owner && owner->alive && owner->campaign == campaign.id) {
    throw StorageError(concat(campaign.name, " is running; stop it, or wait until it ends"));
  }
  // Throws where there is no such case.
  if (arguments.position) store.stored_case(campaign.id, std::to_string(*arguments.position));
  const long count = store.retry(campaign.id, arguments.unconverged, arguments.position);
  if (common.json) {
    print_json({{"campaign", campaign.name}, {"retried", count}});
  } else {
    std::printf("%ld\n", count);
  }
  if (count == 0) {
    say(nothing_to_retry(store, campaign, arguments));
    return ExitCode::done;
  }
  const std::string next = campaign.cancelled
                               ? concat("submit ", campaign.source, ", which reopens it")
                               : "run " + campaign.name;
  say(counted(count, "case", "cases"), " of ", campaign.name, count == 1 ? " waits" : " wait",
      " again. Next: faultsweep ", next);
  return ExitCode::done;
}

ExitCode cancel(const StoreArguments& common) {
  Store::open_reader(common.store);
  Store store = Store::open_writer(common.store);
  const CampaignInfo campaign = store.campaign(common.campaign);
  const bool was_cancelled = campaign.cancelled;
  if (!was_cancelled) store.cancel(campaign.id);
  say(campaign.name, was_cancelled ? " was already" : " is", " cancelled with ", campaign.n_waiting,
      " of ", campaign.n_cases, " cases waiting; results stay");
  if (common.json) {
    print_json({{"campaign", campaign.name},
                {"was_cancelled", was_cancelled},
                {"cases", campaign.n_cases},
                {"waiting", campaign.n_waiting}});
  }
  const auto owner = store.owner();
  if (owner && owner->alive && owner->campaign == campaign.id) {
    say("Its manager hands out no more cases and ends when those in progress are done.");
  }
  say("faultsweep submit ", campaign.source, " reopens it.");
  return ExitCode::done;
}

ExitCode cache_list(const StoreArguments& common) {
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
    print_json({{"operators", document}});
  } else {
    print_text(entries.empty() ? "the cache is empty\n" : render_text(table, screen_width()));
  }
  return ExitCode::done;
}

ExitCode cache_verify(const StoreArguments& common) {
  const std::filesystem::path folder = common.store / "operators";
  bool sound = true;
  json checked = json::array();
  const auto report = [&](const std::string& name, const std::string& problem) {
    sound = sound && problem.empty();
    checked.push_back({{"name", name}, {"sound", problem.empty()}, {"problem", problem}});
    if (!common.json) print_text(concat(name, "  ", problem.empty() ? "sound" : problem, "\n"));
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
  if (common.json) print_json({{"sound", sound}, {"checked", checked}});
  return sound ? ExitCode::done : ExitCode::world;
}

ExitCode cache_prune(const StoreArguments& common, const std::string& size) {
  const auto freed =
      faultsim::prune_operators(common.store / "operators", parse_size("--max-size", size), "");
  if (common.json) {
    print_json({{"bytes_freed", freed}});
    return ExitCode::done;
  }
  std::printf("%llu\n", static_cast<unsigned long long>(freed));
  say("bytes freed; operators that are missing are built again when needed");
  return ExitCode::done;
}

ExitCode backup(const StoreArguments& common, const std::filesystem::path& target) {
  const Store store = Store::open_reader(common.store);
  faultsim::require_writable_file("file", target, faultsim::FileKind::database, {});
  store.backup_to(target);
  say("backup written to ", target.string());
  return ExitCode::done;
}

}  // namespace

void add_reading(Program& program) {
  auto [status_command, asked] =
      program.add("status", "the state of a campaign: counts, time left, failures", status);
  add_campaign(status_command, program.common);
  add_renderings(status_command, program.common);
  CLI::Option* verify =
      status_command->add_flag("--verify", asked.verify,
                               "check the whole store instead: structure, references,\n"
                               "checksums");
  status_command->add_flag("--all", asked.all, "all campaigns of the store, one line each")
      ->excludes(verify);
  status_command->footer(
      "Examples:\n"
      "  faultsweep status my-sweep\n"
      "  faultsweep status --all\n"
      "  faultsweep status --verify\n"
      "  faultsweep status --json");

  auto [command, a] = program.add("rank", "the riskiest configurations first", rank);
  add_campaign(command, program.common);
  command->add_option(
      "--by", a.request.by,
      "metric or expression; default: the spec's, or sliding area, then open area,\n"
      "M0, the pressure margin of inactive cases, and chi");
  add_stage_and_fault(command, a.request.stage, a.request.fault);
  add_where(command, a.request.where);
  command->add_option("--top", a.request.top, "how many rows (default 20); 0 = all")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--skip", a.request.skip,
                   "how many rows to skip first, to read a ranking in pages of --top")
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--ascending", a.request.ascending, "smallest first");
  command->add_flag("--list-metrics", a.list_metrics, "what can be ranked by");
  command->add_option("--why", a.why,
                      "CASE: why it ranks where it does: what slides first, what matters near\n"
                      "it and over the campaign, which places cannot be told apart");
  CLI::Option* certified =
      command
          ->add_option("--certify", a.certify.n,
                       "run those of the first N cases that have interpolated operators on exact\n"
                       "ones, as campaign NAME-exact, and compare both")
          ->check(CLI::Range(1, 10000));
  command
      ->add_option("--tolerance", a.certify.tolerance,
                   "relative difference up to which certified cases agree (default 0.01)")
      ->check(CLI::PositiveNumber)
      ->check(not_nan())
      ->needs(certified);
  command
      ->add_option("--tier", a.certify.tier,
                   "certify at this tier: run the first N cases by --by there, as campaign\n"
                   "NAME-first-TIER, and say which come first and how surely")
      ->check(CLI::IsMember(tier_names()))
      ->needs(certified)
      ->excludes("--tolerance");
  add_workers(command, a.certify.n_workers, "of --certify; default: the cores available");
  add_renderings(command, program.common);
  command->footer(
      "Examples:\n"
      "  faultsweep rank --by moment --top 10\n"
      "  faultsweep rank my-sweep --where \"friction_angle < 25 deg and activated\" --stage "
      "gas_storage\n"
      "  faultsweep rank my-sweep --why 17 --stage gas_storage\n"
      "  faultsweep rank my-sweep --by chi_bar --certify 20\n"
      "  faultsweep rank my-sweep --by chi_bar --certify 20 --tier standard\n"
      "  faultsweep rank --list-metrics");

  auto [show_command, show_arguments] =
      program.add("show", "one case: parameters, outcome, stages, slip events, chi history", show);
  add_case(show_command, program.common, show_arguments.name);
  show_command->add_option("--stage", show_arguments.request.stage, "only this stage");
  show_command->add_option("--fault", show_arguments.request.fault, "only this fault");
  add_renderings(show_command, program.common);
  show_command->footer(
      "Examples:\n"
      "  faultsweep show 17\n"
      "  faultsweep show my-sweep/17 --fault F2 --stage gas_storage\n"
      "  faultsweep show 17 --json");

  auto [explain_command, name] = program.add("explain", "why a case will run or will not", explain);
  add_case(explain_command, program.common, name);
  add_renderings(explain_command, program.common);
  explain_command->footer("Example: faultsweep explain my-sweep/17");
}

void add_caring(Program& program) {
  StoreArguments& common = program.common;
  auto [retry_command, retry_arguments] = program.add("retry", "run failed cases again", retry);
  add_campaign(retry_command, common);
  retry_command->add_option("--case", retry_arguments.position, "only this case number");
  retry_command->add_flag("--unconverged", retry_arguments.unconverged,
                          "also cases whose history ended early");
  add_json(retry_command, common);
  retry_command->footer(
      "Examples:\n"
      "  faultsweep retry my-sweep\n"
      "  faultsweep retry --case 17 --unconverged");

  CLI::App* cancel_command = program.add("cancel", "stop handing out cases of a campaign", cancel);
  add_campaign(cancel_command, common);
  add_json(cancel_command, common);
  cancel_command->footer(
      "Example: faultsweep cancel my-sweep    results stay; submit the spec again to reopen it");

  CLI::App* cache = program.app.add_subcommand("cache", "the operators kept in STORE/operators");
  cache->footer("Example: faultsweep cache list");
  cache->require_subcommand(1);
  CLI::App* list = program.add("list", "operators, most recently used first", cache_list, cache);
  add_store(list, common);
  add_json(list, common);
  list->footer("Example: faultsweep cache list --json");
  CLI::App* verify = program.add("verify", "checksums of the operators and integrity of the store",
                                 cache_verify, cache);
  add_store(verify, common);
  add_json(verify, common);
  verify->footer("Example: faultsweep cache verify --store runs/store");
  auto [prune, size] =
      program.add("prune", "remove least recently used operators", cache_prune, cache);
  size = "20 GB";
  prune->add_option("--max-size", size, "what may stay (default 20 GB)");
  add_store(prune, common);
  add_json(prune, common);
  prune->footer("Example: faultsweep cache prune --max-size \"5 GB\"");

  auto [backup_command, target] =
      program.add("backup", "copy the store's database, even while it is in use", backup);
  backup_command->add_option("file", target, "new file")->required();
  add_store(backup_command, common);
  backup_command->footer("Example: faultsweep backup before.sqlite");
}

}  // namespace faultsweep
