#pragma once

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "campaign/store/store.h"
#include "simulator/common/stopwatch.h"

namespace faultsweep::testing {

struct ProgramEnd {
  int code = -1;  ///< exit code; 128 + n for signal n; -1 = did not end in time.
  std::string out, err;
};

/// The real faultsweep binary with the fake simulator (or another one), in a folder of its own.
class CampaignTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "campaign_XXXXXX";
    folder_ = mkdtemp(name.data());
    store_ = folder_ / "store";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Cases by title (see fake_simulator.cc), in two families; each takes `seconds`.
  std::int64_t submit(const std::vector<std::string>& titles, double seconds = 0,
                      Policy policy = {}) {
    Submission s;
    s.name = "sweep";
    s.source = "sweep.json";
    s.spec_given = "{}";
    s.spec_resolved = R"({"groups": [{"parameters": [{"name": "strength"}]}]})";
    s.parameters = {{"strength", faultsim::Dimension::number, false}};
    s.rank_by = "activated_area";
    s.policy = policy;
    s.scenes = {
        {"scene.json", "{\"title\": \"\", \"strength\": 0, \"family\": \"\", \"seconds\": " +
                           std::to_string(seconds) + "}"}};
    s.families = {{"family-a", 1000, 100, 1, 1e8}, {"family-b", 1000, 100, 1, 1e8}};
    for (std::size_t k = 0; k < titles.size(); ++k) {
      const std::string strength = std::to_string(static_cast<double>(k % 97) / 97);
      s.cases.push_back({"identity-" + std::to_string(k),
                         static_cast<int>(k % 2),
                         0,
                         R"({"/title": ")" + titles[k] + R"(", "/strength": )" + strength +
                             R"(, "/family": ")" + (k % 2 == 0 ? "a" : "b") + "\"}",
                         {{0, std::stod(strength), strength}}});
    }
    return Store::open_writer(store_).submit(s).campaign;
  }

  /// Starts faultsweep; output goes to files. `prepare` runs in the child before exec.
  pid_t start(std::vector<std::string> arguments, const std::function<void()>& prepare = {}) {
    arguments.insert(arguments.begin(), FAULTSWEEP);
    arguments.insert(arguments.end(), {"--store", store_.string()});
    std::vector<char*> words;
    for (std::string& word : arguments) words.push_back(word.data());
    words.push_back(nullptr);
    const std::string out = (folder_ / "out").string(), err = (folder_ / "err").string();
    const pid_t pid = fork();
    if (pid == 0) {
      setenv("FAULTSIM_BINARY", simulator_.c_str(), 1);
      dup2(open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644), 1);
      dup2(open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644), 2);
      if (prepare) prepare();
      execv(FAULTSWEEP, words.data());
      _exit(127);
    }
    return pid;
  }
  ProgramEnd wait(pid_t pid, double seconds = 60) {
    const faultsim::Stopwatch watch;
    int status = 0;
    while (waitpid(pid, &status, WNOHANG) == 0) {
      if (watch.seconds() > seconds) {
        kill(pid, SIGKILL);
        waitpid(pid, &status, 0);
        return {-1, text("out"), text("err")};
      }
      usleep(10000);
    }
    const int code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    return {code, text("out"), text("err")};
  }
  ProgramEnd faultsweep(std::vector<std::string> arguments,
                        const std::function<void()>& prepare = {}) {
    return wait(start(std::move(arguments), prepare));
  }

  /// Waits until so many cases are done (from outside, read-only); false after 30 s.
  bool wait_for_done(long n) {
    const faultsim::Stopwatch watch;
    while (watch.seconds() < 30) {
      if (Store::open_reader(store_).campaign("").n_done >= n) return true;
      usleep(5000);
    }
    return false;
  }
  /// Each case of the campaign has exactly one completed run, and another one for its fields where
  /// they were kept afterwards, and the store is sound.
  void expect_each_case_completed_once(std::int64_t campaign, int n_cases) {
    Store store = Store::open_reader(store_);
    EXPECT_EQ(store.campaign("").n_done, n_cases);
    for (int position = 1; position <= n_cases; ++position) {
      const StoredCase one = store.stored_case(campaign, std::to_string(position));
      const auto n_completed = std::ranges::count(one.runs, "completed", &StoredRun::status);
      EXPECT_EQ(n_completed, one.fields == FieldsState::kept ? 2 : 1) << "case " << position;
    }
    EXPECT_THAT(store.integrity_problems(), ::testing::IsEmpty());
  }

  /// Processes whose parent is pid.
  static std::vector<pid_t> children_of(pid_t pid) {
    std::vector<pid_t> children;
    std::ifstream file("/proc/" + std::to_string(pid) + "/task/" + std::to_string(pid) +
                       "/children");
    for (pid_t child = 0; file >> child;) children.push_back(child);
    return children;
  }
  static bool is_running(pid_t pid) {
    std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
    std::string text((std::istreambuf_iterator<char>(file)), {});
    const std::size_t end = text.rfind(')');
    return end != std::string::npos && text[end + 2] != 'Z';
  }

  /// What the last program wrote: "out" or "err".
  std::string text(const char* name) const {
    std::ifstream file(folder_ / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  std::filesystem::path folder_, store_;
  std::filesystem::path simulator_ = FAKE_SIMULATOR;
};

}  // namespace faultsweep::testing
