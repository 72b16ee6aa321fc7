#include "tests/verification/closed_forms/verify.h"

#include <algorithm>
#include <cctype>
#include <iostream>
#include <nlohmann/json.hpp>

#include "simulator/common/errors.h"
#include "simulator/common/interrupt.h"
#include "simulator/common/stopwatch.h"
#include "simulator/files/json_text.h"
#include "simulator/linalg/blas_start.h"
#include "tests/verification/closed_forms/verify_cases.h"

namespace faultsim {

const std::vector<VerifyCase>& verify_cases() {
  static const std::vector<VerifyCase> cases = [] {
    std::vector<VerifyCase> all;
    for (auto part :
         {patch_cases(), depletion_cases(), displaced_cases(), crack_cases(), penny_cases(),
          slider_cases(), creep_cases(), fluid_slip_cases(), thermal_cases()})
      all.insert(all.end(), part.begin(), part.end());
    return all;
  }();
  return cases;
}

VerifyReport run_verify_case(const VerifyCase& verify_case, const RunContext& context) {
  VerifyReport report;
  report.name = verify_case.name;
  report.title = verify_case.title;
  report.scenes = verify_case.scenes;
  try {
    SceneRunner runner(context);
    verify_case.evaluate(runner, report);
    if (report.rows.empty()) report.failure = "nothing was compared";
  } catch (const Interrupted&) {
    throw;
  } catch (const Error& error) {
    report.failure = error.what();
  }
  return report;
}

namespace {

/// Progress lines on stderr; only stages worth waiting for.
class StderrMonitor final : public Monitor {
 public:
  void progress(double, const std::string&) override {}
  void note(const std::string& text) override { std::cerr << "  note: " << text << "\n"; }
};

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string problem_of(const VerifyCase& verify_case) {
  return verify_case.name.substr(0, verify_case.name.find('-'));
}

std::vector<const VerifyCase*> select_cases(const std::vector<std::string>& names, bool slow) {
  std::vector<const VerifyCase*> selected;
  std::vector<Problem> unknown;
  std::vector<char> used(names.size(), 0);
  for (const VerifyCase& verify_case : verify_cases()) {
    bool wanted = names.empty() && (slow || !verify_case.slow);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const bool exact = lower(names[i]) == lower(verify_case.name);
      const bool problem = lower(names[i]) == lower(problem_of(verify_case));
      if (exact || problem) used[i] = 1;
      wanted = wanted || exact || (problem && (slow || !verify_case.slow));
    }
    if (wanted) selected.push_back(&verify_case);
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!used[i]) {
      unknown.push_back({"", 0, "there is no verification problem \"" + names[i] + "\"",
                         "faultsim verify --list names them"});
    }
  }
  if (!unknown.empty()) throw InputError("verify", unknown);
  return selected;
}

void print_list(const std::vector<const VerifyCase*>& cases, bool json) {
  nlohmann::json list = nlohmann::json::array();
  for (const VerifyCase* c : cases) {
    if (json) {
      list.push_back(
          {{"name", c->name}, {"title", c->title}, {"scenes", c->scenes}, {"slow", c->slow}});
    } else {
      std::cout << c->name << std::string(c->name.size() < 24 ? 24 - c->name.size() : 1, ' ')
                << c->title << (c->slow ? "  (slow)" : "") << "\n";
    }
  }
  if (json) std::cout << json_text(nlohmann::json{{"problems", std::move(list)}});
}

}  // namespace

ExitCode verify_command(const std::vector<std::string>& names, bool list, bool json, bool slow,
                        bool markdown) {
  const std::vector<const VerifyCase*> cases = select_cases(names, slow || list);
  if (list) {
    print_list(cases, json);
    return ExitCode::done;
  }
  take_blas_buffer();
  StderrMonitor monitor;
  const RunContext context(monitor, stop_on_signals());
  nlohmann::json reports = nlohmann::json::array();
  std::size_t passed = 0, compared = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    std::cerr << "[" << i + 1 << "/" << cases.size() << "] " << cases[i]->name << " ..."
              << std::flush;
    const Stopwatch watch;
    const VerifyReport report = run_verify_case(*cases[i], context);
    std::cerr << (report.passed() ? " pass, " : " MISS, ") << watch.seconds() << " s\n";
    passed += report.passed() ? 1 : 0;
    compared += report.rows.size();
    if (json) reports.push_back(report_to_json(report));
    if (!json)
      std::cout << (markdown ? report_to_markdown(report) : report_to_text(report) + "\n")
                << std::flush;
  }
  const bool good = passed == cases.size() && compared > 0;
  const std::string summary =
      concat(passed, " of ", cases.size(), " cases passed, ", compared, " comparisons");
  if (json) {
    std::cout << json_text(
        nlohmann::json{{"cases", reports}, {"passed", good}, {"summary", summary}});
  } else if (!markdown) {
    std::cout << summary << (compared == 0 ? ": nothing was compared" : "") << "\n";
  }
  return good ? ExitCode::done : ExitCode::regress;
}

}  // namespace faultsim
