#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "campaign/common/json.h"
#include "campaign/scheduler/simulator_process.h"
#include "simulator/files/temporary_folder.h"

/// Inside of the room: questions of pages to one resident simulator.
namespace faultsweep::serve {

/// What a page wants to know of a case with changes.
struct WhatIfQuestion {
  std::string page;   ///< a word by which the page is known.
  long number = 0;    ///< of the page's own questions: each is larger than those before it.
  std::string scene;  ///< the case's document, as text.
  std::string source;
  json body;  ///< "changes", "charts", "fault", "step", ...: schemas/what_if_protocol.md.
};

/// Keeps one `faultsim what-if` (schemas/what_if_protocol.md), which has one operator at hand. The
/// newest question of any page wins; those before it are called off. Operators are found among
/// those of the store, and others are kept as long as the desk: nothing is written into the store.
class WhatIfDesk {
 public:
  struct Settings {
    std::filesystem::path simulator;  ///< the faultsim binary.
    std::filesystem::path operators;  ///< of the store.
    int threads = 1;                  ///< of building an operator.
    double rest_seconds = 600;        ///< without a question it gives its memory back.
  };
  explicit WhatIfDesk(Settings settings);
  ~WhatIfDesk();  ///< ends what is under way.
  WhatIfDesk(const WhatIfDesk&) = delete;
  WhatIfDesk& operator=(const WhatIfDesk&) = delete;

  /// Asks the question, unless it is being asked already, and waits for its answer, at most so
  /// long.
  /// @return the simulator's reply (what_if_protocol.md), in JSON, or how far it has come. Safe
  /// from several threads.
  std::string ask(const WhatIfQuestion& question, std::chrono::milliseconds longest);
  /// Where operators are kept that the store has not: gone with the desk.
  const std::filesystem::path& cache() const { return cache_.path(); }
  /// Nobody waits any more, and nothing is begun.
  void close();

 private:
  void live();
  void start();
  void exchange();
  void take(const std::string& reply);
  void fail(const std::string& why);
  void link_operators();
  bool is_at(const WhatIfQuestion& question) const {
    return question.page == page_ && question.number == number_;
  }
  std::string told(const WhatIfQuestion& question) const;

  const Settings settings_;
  const faultsim::TemporaryFolder cache_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;  ///< a question is there, or its answer.
  std::deque<std::string> outgoing_;
  std::string page_;      ///< of the newest question.
  long number_ = 0;       ///< of the page.
  long asked_ = 0;        ///< its number for the simulator.
  bool is_open_ = false;  ///< the newest question has no answer yet.
  std::string reply_;     ///< the newest of the newest question.
  std::string scene_;     ///< that the simulator has.
  bool is_ending_ = false;
  int n_waiting_ = 0;                          ///< for an answer.
  std::unique_ptr<SimulatorProcess> process_;  ///< of the thread alone.
  std::thread thread_;                         ///< the last member: it uses all others.
};

}  // namespace faultsweep::serve
