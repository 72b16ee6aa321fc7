#include "campaign/nightly/night.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/expansion/submission.h"
#include "campaign/nightly/night_report.h"
#include "campaign/nightly/nightly_sample.h"
#include "campaign/nightly/nightly_suite.h"
#include "campaign/scheduler/starter.h"
#include "campaign/store/clock.h"
#include "simulator/common/child_output.h"
#include "simulator/common/exit_code.h"
#include "simulator/common/fingerprint.h"
#include "simulator/common/stopwatch.h"

namespace faultsweep {

using faultsim::ChildOutput;

namespace {

constexpr const char* kVerification = "faultsim-verify";

/// One night at a time in a store; the lock goes with the process.
class NightLock {
 public:
  explicit NightLock(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    const std::filesystem::path file = folder / "nightly.lock";
    descriptor_ = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (descriptor_ < 0) {
      throw StorageError(concat("cannot write ", file.string(), ": ", std::strerror(errno)));
    }
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      throw StorageError(concat("another faultsweep nightly is working in ", folder.string(),
                                "; wait for it, or use another --store"));
    }
  }
  ~NightLock() { close(descriptor_); }
  NightLock(const NightLock&) = delete;
  NightLock& operator=(const NightLock&) = delete;

 private:
  int descriptor_ = -1;
};

ChildOutput run_program(const std::vector<std::string>& command) {
  ChildOutput result = faultsim::run_child(command);
  if (result.start_error == 0) return result;
  throw ResourceError(concat("cannot run ", command[0], ": ", std::strerror(result.start_error),
                             "; set FAULTSIM_BINARY to the faultsim binary"));
}

Environment ask_environment(const std::filesystem::path& simulator) {
  const ChildOutput answer = run_program({simulator.string(), "environment", "--json"});
  try {
    return environment_from_json(json::parse(answer.out));
  } catch (const json::exception&) {
    throw ResourceError(concat(simulator.string(), " did not report its environment (exit code ",
                               answer.code, "); use a faultsim of the same version as faultsweep"));
  }
}

/// One run of a suite.
class Night {
 public:
  Night(const NightRequest& request, const NightPrograms& programs)
      : request_(request),
        suite_(read_nightly_suite(request.suite)),
        simulator_(programs.simulator),
        environment_(ask_environment(simulator_)) {
    record_.at = seconds_since_1970();
    record_.suite = suite_.name;
    record_.environment = environment_.fingerprint;
    record_.environment_fields = environment_.fields;
    record_.program_version = programs.version;
    record_.numerics_version = environment_.numerics_version;
  }

  /// False (and why, on stderr) when there is nothing to compare with, so that nothing need run.
  bool find_something_to_compare() {
    if (suite_.is_empty()) {
      return refuse("the suite names no campaign, no verification problem and no sample");
    }
    if (suite_.campaigns.empty()) return true;
    const std::string cure =
        concat("check --baselines, or make one: faultsweep nightly ", request_.suite,
               " --bless --reason \"why these results are right\"");
    try {
      baseline_ = find_baseline(request_.baselines, suite_.name, environment_);
    } catch (const StorageError& error) {
      return request_.bless ? true : refuse(concat(error.what(), "; ", cure));
    }
    if (!baseline_ && !request_.bless) {
      return refuse(concat("there is no baseline of this suite in ",
                           (request_.baselines / suite_.name).string(), "; ", cure));
    }
    if (baseline_)
      same_environment_ = baseline_->environment.fingerprint == environment_.fingerprint;
    return true;
  }

  void run() {
    const faultsim::Stopwatch watch;
    check_verification();
    forget_last_night();
    for (const std::string& spec : suite_.campaigns) run_campaign(spec);
    judge_lost_campaigns();
    for (const SampleRequest& sample : suite_.samples) run_sample(sample);
    if (!suite_.verification.empty()) run_verification();
    record_.wall_seconds = watch.seconds();
    for (const NightCaseRecord& one : record_.cases) {
      record_.n_compared += one.verdict != to_string(Verdict::unblessed) &&
                            one.verdict != to_string(Verdict::missing);
      record_.n_regressed += one.regressed;
    }
  }

  NightOutcome finish() {
    if (baseline_) record_.baseline_environment = baseline_->environment.fingerprint;
    ExitCode code =
        record_.n_regressed > 0 || record_.n_compared == 0 ? ExitCode::regress : ExitCode::done;
    if (request_.bless) code = bless();
    record_.exit_code = static_cast<int>(code);
    Store store = Store::open_owner(request_.store);
    const std::vector<std::string> advice =
        night_advice(record_, store.nights(suite_.name, kNightsShown));
    store.record_night(record_);
    store.checkpoint();
    return {record_, remarks(), advice};
  }

 private:
  std::filesystem::path cold_store() const { return request_.store / "last"; }

  /// Its results and its operators.
  void forget_last_night() const {
    std::error_code error;
    std::filesystem::remove_all(cold_store(), error);
    if (error) {
      throw StorageError(concat("cannot remove ", cold_store().string(), ": ", error.message()));
    }
  }

  bool refuse(const std::string& why) const {
    std::fprintf(stderr, "faultsweep: nothing was compared: %s\n", why.c_str());
    return false;
  }

  /// Submits to the cold store, runs, and reads back all cases.
  NightCampaign run_submission(const Submission& submission) {
    const SubmitOutcome outcome = Store::open_writer(cold_store()).submit(submission);
    if (outcome.existed) {
      throw InputError(suite_.source, concat("the suite has ", outcome.name, " twice"),
                       "remove one");
    }
    const ExitCode status = start_ranks({.store = cold_store(),
                                         .campaign = outcome.name,
                                         .n_workers = request_.n_workers,
                                         .simulator = simulator_,
                                         .node_cache = "none"});  // it would outlive the night
    if (status == ExitCode::interrupted) {
      throw faultsim::Interrupted("interrupted: this night does not count");
    }
    if (!has_results(status)) {
      throw ResourceError(concat("the campaign ", outcome.name, " ended with exit code ",
                                 static_cast<int>(status)));
    }
    const Store store = Store::open_reader(cold_store());
    return stored_night(store, store.campaign(outcome.name));
  }

  void judge(const NightCampaign* baseline, const NightCampaign& tonight, bool same_environment) {
    auto records = judge_campaign(baseline, tonight, same_environment, suite_.tolerances);
    record_.cases.insert(record_.cases.end(), records.begin(), records.end());
  }

  void run_campaign(const std::string& spec) {
    tonight_.push_back(
        run_submission(without_shown_fields(make_submission(expand(read_campaign(spec))))));
    for (const NightCase& one : tonight_.back().cases) {
      if (!one.result) {
        in_the_way_.push_back(
            concat(tonight_.back().name, "/", one.position, " has no result: ", one.trouble));
      }
    }
    judge(baseline_ ? baseline_->find(tonight_.back().name) : nullptr, tonight_.back(),
          same_environment_);
  }

  /// Campaigns that only the baseline has: a gate must not lose cases silently.
  void judge_lost_campaigns() {
    if (!baseline_) return;
    for (const NightCampaign& one : baseline_->campaigns) {
      if (std::ranges::find(tonight_, one.name, &NightCampaign::name) == tonight_.end())
        judge(&one, {one.name, {}}, same_environment_);
    }
  }

  void run_sample(const SampleRequest& request) {
    StoredSample sample = take_sample(request);
    if (sample.submission.cases.empty()) {  // a gate must not lose its cases silently
      NightCaseRecord record;
      record.campaign = sample.submission.name;
      record.identity = "(no case)";
      record.verdict = to_string(Verdict::missing);
      record.regressed = true;
      record.remark = concat("the campaign in ", request.store, " has no result to sample");
      record_.cases.push_back(record);
      return in_the_way_.push_back(record.remark);
    }
    const NightCampaign tonight = run_submission(sample.submission);
    std::erase_if(sample.baseline.cases, [&](const NightCase& one) {
      return one.result->numerics_version != environment_.numerics_version;
    });
    judge(&sample.baseline, tonight, request.same_environment);
    for (const NightCaseRecord& one : record_.cases) {
      if (one.campaign == tonight.name && one.regressed) {
        in_the_way_.push_back(
            concat(one.campaign, "/", one.position, " differs from what is stored: ", one.remark));
      }
    }
  }

  std::vector<std::string> verify_command(const std::vector<std::string>& options) const {
    std::vector<std::string> command = {(simulator_.parent_path() / kVerification).string(),
                                        "--json"};
    command.insert(command.end(), options.begin(), options.end());
    command.insert(command.end(), suite_.verification.begin(), suite_.verification.end());
    return command;
  }

  void check_verification() const {
    if (suite_.verification.empty() || run_program(verify_command({"--list"})).code == 0) return;
    throw InputError(suite_.source,
                     {{"/verification", 0, "faultsim-verify does not know all of these names",
                       "use those that faultsim-verify --list shows"}});
  }

  /// A problem that meets its closed forms is within its tier.
  void run_verification() {
    const ChildOutput answer = run_program(verify_command({}));
    const json document = json::parse(answer.out, nullptr, false);
    if (!document.is_object()) {
      throw ResourceError(concat("faultsim-verify ended with exit code ", answer.code));
    }
    for (const json& problem : document.at("cases")) {
      const bool passed = problem.at("passed");
      NightCaseRecord record;
      record.campaign = kVerification;
      record.identity = problem.at("name");
      record.label = problem.at("title");
      record.verdict = to_string(passed ? Verdict::within_tier : Verdict::beyond_tier);
      record.regressed = !passed;
      record.digest = faultsim::fingerprint(problem.at("rows").dump());
      if (!passed) {
        record.remark = what_missed(problem);
        in_the_way_.push_back(record.identity + " misses its closed form: " + record.remark);
      }
      record_.cases.push_back(record);
    }
  }
  static std::string what_missed(const json& problem) {
    for (const json& row : problem.at("rows")) {
      if (row.at("pass").get<bool>()) continue;
      return concat(row.at("quantity").get<std::string>(), ": ", row.at("computed").dump(),
                    ", expected ", row.at("expected").dump());
    }
    return problem.at("failure");
  }

  /// Tonight's results become the baseline of this environment.
  ExitCode bless() {
    for (const std::string& one : in_the_way_) {
      std::fprintf(stderr, "faultsweep: not blessed: %s\n", one.c_str());
    }
    if (!in_the_way_.empty()) return ExitCode::regress;
    if (tonight_.empty()) {
      std::fprintf(stderr,
                   "faultsweep: not blessed: the suite has no campaigns, and nothing else "
                   "has a baseline\n");
      return ExitCode::regress;
    }
    Baseline blessed;
    blessed.suite = suite_.name;
    blessed.environment = environment_;
    if (baseline_ && same_environment_) blessed.blessings = baseline_->blessings;
    const std::string today = format_time(seconds_since_1970()).substr(0, 10);
    blessed.blessings.push_back({today, request_.reason, environment_.numerics_version});
    blessed.campaigns = tonight_;
    write_baseline(request_.baselines, blessed);
    record_.blessed = request_.reason;
    return ExitCode::done;
  }

  std::vector<std::string> remarks() const {
    std::vector<std::string> all;
    all.push_back(concat("environment ", environment_.fingerprint, ", numerics version ",
                         environment_.numerics_version));
    if (record_.blessed) {
      all.push_back(
          concat("BLESSED as ",
                 baseline_path(request_.baselines, suite_.name, environment_.fingerprint).string(),
                 ": ", *record_.blessed, "; verdicts are on the baseline before it"));
    }
    if (!baseline_) return all;
    const Blessing& last = baseline_->blessings.back();
    all.push_back(concat("baseline blessed on ", last.date, ": ", last.reason));
    if (baseline_->environment.numerics_version != environment_.numerics_version) {
      all.push_back(concat("THE BASELINE IS OF NUMERICS VERSION ",
                           baseline_->environment.numerics_version,
                           ": its cases are different ones; look at the results, then bless"));
    }
    if (same_environment_) return all;
    all.push_back(concat("ENVIRONMENT DIFFERS FROM THE BASELINE'S (",
                         baseline_->environment.fingerprint,
                         "): numbers are compared within tolerances, not bit for bit"));
    for (const std::string& one : environment_differences(environment_, baseline_->environment)) {
      all.push_back("  " + one);
    }
    return all;
  }

  const NightRequest& request_;
  NightlySuite suite_;
  std::filesystem::path simulator_;
  Environment environment_;
  std::optional<Baseline> baseline_;
  bool same_environment_ = false;
  std::vector<NightCampaign> tonight_;
  std::vector<std::string> in_the_way_;  ///< of blessing: what is wrong whatever the baseline.
  NightRecord record_;
};

}  // namespace

std::optional<NightOutcome> run_night(const NightRequest& request, const NightPrograms& programs) {
  Night night(request, programs);
  if (!night.find_something_to_compare()) return std::nullopt;
  const NightLock lock(request.store);
  night.run();
  return night.finish();
}

}  // namespace faultsweep
