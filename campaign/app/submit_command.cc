#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>

#include "campaign/app/commands.h"
#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/expansion/submission.h"
#include "campaign/query/parameters.h"
#include "campaign/render/render.h"
#include "campaign/render/shown.h"
#include "campaign/reports/case_report.h"
#include "campaign/rounds/next_round.h"
#include "campaign/scheduler/resources.h"
#include "campaign/store/clock.h"
#include "simulator/common/process_memory.h"
#include "simulator/files/atomic_file.h"
#include "simulator/files/json_text.h"
#include "simulator/files/output_target.h"
#include "simulator/reading/read_scene.h"
#include "starter_campaign.h"

namespace faultsweep {

namespace {

void require_new(const std::filesystem::path& path) {
  if (std::filesystem::exists(std::filesystem::symlink_status(path))) {
    throw InputError(path.string(), "the file exists already", "choose another folder");
  }
}

/// What a submission would do, or did.
struct SubmitReport {
  Expansion expansion;
  Submission submission;
  SubmitOutcome outcome;

  double operator_seconds() const {
    double sum = 0;
    for (const FamilyRecord& one : submission.families) sum += one.operator_seconds;
    return sum;
  }
};

/// What differs where salt creeps; "" where it does not.
std::string creep_text(const std::vector<FamilyRecord>& families) {
  long n_creeping = 0;
  double memory = 0;
  for (const FamilyRecord& family : families) {
    if (!family.creeps()) continue;
    ++n_creeping;
    memory = std::max(memory, family.memory_bytes);
  }
  if (n_creeping == 0) return "";
  constexpr double kGigabyte = 1e9;
  return concat(
      "salt creeps in ", counted(n_creeping, "family", "families"),
      ": each worker that runs one builds its operators, does not cache them, and keeps them in "
      "memory, at most ",
      format_number(memory / kGigabyte, 2), " GB per worker\n");
}

/// Of a ladder, or of a surface with its check points.
int operators_of(const FamilyRecord& record, const Family& family) {
  return std::max(record.n_operators, family.plan->n_operators);
}

/// What is predicted of operators; beside surfaces, what exact ones alone would take.
std::string predicted_text(const SubmitReport& report) {
  long n_operators = 0, n_exact = 0;
  double exact_seconds = 0;
  for (std::size_t k = 0; k < report.submission.families.size(); ++k) {
    const FamilyRecord& one = report.submission.families[k];
    const Family& family = report.expansion.families[k];
    const int n = operators_of(one, family);
    const long alone = family.plan->n_operators > 1 ? std::ssize(family.cases) : n;
    n_operators += n;
    n_exact += alone;
    exact_seconds += one.operator_seconds / n * static_cast<double>(alone);
  }
  const std::string all =
      concat("predicted: ", counted(n_operators, "operator", "operators"), ", ",
             format_duration(report.operator_seconds()), " for those not cached, on one core\n");
  if (n_exact == n_operators) return all;
  return concat(all, "with exact operators alone: ", counted(n_exact, "operator", "operators"),
                ", ", format_duration(exact_seconds), "\n");
}

/// The first families on the screen, all of them in JSON.
AnswerTable families_table(const SubmitReport& report) {
  constexpr std::size_t kShown = 20;
  const Need all = Need::always, data = Need::data;
  AnswerTable table{"families",
                    "",
                    {{"family", "family", {}, 4, all},
                     {"cases", "cases", {}, 4, all},
                     {"unknowns", "unknowns", {}, 4, all},
                     {"jump_unknowns", "on faults", {}, 4, all},
                     {"creeps", "creeps", {}, 4, data},
                     {"n_operators", "operators", {}, 4, all},
                     {"predicted_operator_s", "build", seconds(), 2, all},
                     {"predicted_memory_bytes", "memory", gigabytes(), 2, all}}};
  table.most_on_screen = kShown;
  for (std::size_t k = 0; k < report.submission.families.size(); ++k) {
    const FamilyRecord& one = report.submission.families[k];
    const Family& family = report.expansion.families[k];
    table.rows.push_back({one.fingerprint, family.cases.size(), one.unknowns, one.jump_unknowns,
                          one.creeps(), operators_of(one, family), one.operator_seconds,
                          one.memory_bytes});
  }
  return table;
}

std::string report_to_text(const SubmitReport& report) {
  const Submission& s = report.submission;
  std::string text =
      concat(s.name, ": ", counted(s.cases.size(), "case", "cases"), " in ",
             counted(s.families.size(), "family", "families"), "; ", report.expansion.n_designed,
             " designed, ", s.n_excluded, " excluded, ", s.n_merged, " merged as identical, ",
             report.outcome.n_cached, " have a result already\n");
  if (const KeepFields keep = report.outcome.keep_fields; keep != KeepFields::none) {
    text += kept_fields_text(keep);
    if (are_of_all_cases(keep) && report.outcome.n_fields > 0) {
      text += concat("; ", report.outcome.n_fields,
                     " cases with a result lack them and are run again just for these");
    }
    text += "\n";
  }
  for (const ExcludedCases& excluded : report.expansion.excluded) {
    text += concat("  excluded ", excluded.n_cases, ": ", excluded.reason, "\n");
  }
  text += render_text(families_table(report), screen_width());
  return text + predicted_text(report) + creep_text(s.families);
}

json report_to_json(const SubmitReport& report) {
  const Submission& s = report.submission;
  json excluded = json::array();
  for (const ExcludedCases& one : report.expansion.excluded) {
    excluded.push_back({{"expression", one.reason}, {"cases", one.n_cases}});
  }
  return {{"campaign", s.name},
          {"cases", s.cases.size()},
          {"designed", report.expansion.n_designed},
          {"excluded_cases", s.n_excluded},
          {"excluded", excluded},
          {"merged", s.n_merged},
          {"cached", report.outcome.n_cached},
          {"keep_fields", to_string(report.outcome.keep_fields)},
          {"for_fields_only", report.outcome.n_fields},
          {"parameters", json::parse(parameters_to_json(s.parameters))},
          {"families", json_rows(families_table(report))},
          {"predicted_operator_s", report.operator_seconds()},
          {"notes", report.expansion.notes}};
}

/// Operators that the memory limit leaves no room for: all of them is a problem, some are a note.
void check_memory_limit(const std::string& spec, SubmitReport& report) {
  const auto& limit = report.submission.policy.memory_limit;
  if (!limit) return;
  long n_too_large = 0;
  double least = 0, most = 0;  // bytes
  for (const FamilyRecord& family : report.submission.families) {
    const double needed = family.memory_bytes + faultsim::kBlasBufferBytes;
    if (needed > *limit) ++n_too_large;
    least = least == 0 ? needed : std::min(least, needed);
    most = std::max(most, needed);
  }
  if (n_too_large == 0) return;
  constexpr double kMegabyte = 1e6;
  const auto megabytes = [](double bytes) { return std::lround(std::ceil(bytes / kMegabyte)); };
  if (n_too_large == static_cast<long>(report.submission.families.size())) {
    throw InputError(
        spec, {{"/policy/memory_limit", 0,
                concat("no operator of this campaign fits into ", megabytes(*limit), " MB"),
                concat("the smallest is predicted to need ", megabytes(least), " MB, the largest ",
                       megabytes(most), " MB")}});
  }
  report.expansion.notes.push_back(concat("/policy/memory_limit: ", n_too_large, " of ",
                                          report.submission.families.size(),
                                          " families are predicted to need more, up to ",
                                          megabytes(most), " MB, and their cases to fail"));
}

struct SubmitArguments {
  std::string spec;
  bool dry_run = false;
};

SubmitOutcome preview(const std::filesystem::path& store, const Submission& submission) {
  if (std::filesystem::exists(store / "campaign.sqlite"))
    return Store::open_reader(store).preview(submission);
  SubmitOutcome outcome;
  outcome.keep_fields = submission.keep_fields;
  return outcome;
}

SubmitOutcome stored(const std::filesystem::path& folder, const Submission& submission) {
  Store store = Store::open_writer(folder);
  if (!store.remark().empty()) say(store.remark());
  SubmitOutcome outcome = store.submit(submission);
  if (outcome.existed) {
    say(outcome.name, " is in the store already: nothing was added; `faultsweep run` resumes it");
  } else if (outcome.name != submission.name) {
    say("another campaign is called ", submission.name, ": this one becomes ", outcome.name);
  }
  return outcome;
}

ExitCode init(const StoreArguments&, const std::filesystem::path& folder) {
  faultsim::require_writable_folder("folder", folder);
  const std::filesystem::path scene = folder / "scene.json", spec = folder / "campaign.json";
  require_new(scene);
  require_new(spec);
  faultsim::create_folders(folder);
  faultsim::write_text(scene, faultsim::starter_scene("field"));
  faultsim::write_text(spec, std::string(faultsim::embedded::starter_campaign));
  std::printf("%s\n%s\n", scene.c_str(), spec.c_str());
  say("Next: faultsweep submit ", spec.string(), " --dry-run");
  return ExitCode::done;
}

ExitCode submit(const StoreArguments& common, const SubmitArguments& arguments) {
  constexpr std::size_t kPlannedForALook = 500;  // a millisecond each
  const std::size_t most_planned =
      arguments.dry_run ? kPlannedForALook : std::numeric_limits<std::size_t>::max();
  SubmitReport report{expand(read_campaign(arguments.spec), most_planned), {}, {}};
  check_rounds(report.expansion);
  report.submission = make_submission(report.expansion,
                                      arguments.dry_run ? CaseDetail::identity : CaseDetail::whole);
  if (report.submission.cases.empty()) {
    throw InputError(arguments.spec,
                     {{"/exclude", 0, "every case is excluded", "relax a condition"}});
  }
  check_memory_limit(arguments.spec, report);
  if (arguments.dry_run) {
    report.outcome = preview(common.store, report.submission);
  } else {
    report.outcome = stored(common.store, report.submission);
    report.submission.name = report.outcome.name;
  }
  for (const std::string& note : report.expansion.notes) say("note: ", note);
  print_text(common.json ? faultsim::json_text(report_to_json(report)) : report_to_text(report));
  if (arguments.dry_run) {
    say("Nothing was stored. Next: faultsweep submit ", arguments.spec);
  } else {
    say("Next: faultsweep run ", report.submission.name, " --workers ", available_cores(),
        " --store ", common.store.string());
  }
  return ExitCode::done;
}

}  // namespace

void add_submitting(Program& program) {
  auto [init_command, folder] = program.add("init", "write a starter spec and its scene", init);
  folder = "campaign";
  init_command->add_option("folder", folder, "where (default ./campaign)");
  init_command->footer(
      "Example: faultsweep init my-sweep    my-sweep/campaign.json and my-sweep/scene.json");

  auto [submit_command, a] =
      program.add("submit", "check and expand a spec and store its cases", submit);
  submit_command->add_option("spec", a.spec, "spec file (JSON)")->required();
  submit_command->add_flag("--dry-run", a.dry_run, "only show what would be stored");
  add_store(submit_command, program.common);
  add_json(submit_command, program.common);
  add_wide(submit_command);
  submit_command->footer(
      "Examples:\n"
      "  faultsweep submit my-sweep/campaign.json --dry-run    cases, families, time; nothing is "
      "stored\n"
      "  faultsweep submit my-sweep/campaign.json --store runs/store");
}

}  // namespace faultsweep
