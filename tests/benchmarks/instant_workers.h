#pragma once

#include <deque>
#include <map>
#include <string>

#include "campaign/scheduler/manager.h"
#include "simulator/result/result_bytes.h"

namespace faultsweep::benchmarks {

/// Workers that have done their work when they get it.
class InstantWorkers final : public WorkerLink {
 public:
  /// @param clock  seconds from any origin; by it seconds() counts.
  InstantWorkers(const faultsim::CaseResult& result, double (*clock)())
      : result_(faultsim::result_to_bytes(result)), clock_(clock) {}
  int n_workers() const override { return 64; }
  void send(int worker, const Message& message) override {
    const double start = clock_();
    if (const auto* work = std::get_if<message::Work>(&message)) {
      message::Events events;
      if (const auto [family, is_new] = last_family_.try_emplace(worker, work->task.family);
          is_new || family->second != work->task.family) {
        family->second = work->task.family;
        events.events.operators.push_back({"operator", true, 0.001, 1000, 100, 1000, 1000});
      }
      for (const auto& item : work->items) {
        RunRecord run;
        run.case_id = item.case_id;
        run.wall_seconds = 0.001;
        run.status = RunStatus::completed;
        events.events.completed.push_back({std::move(run), result_});
      }
      inbox_.push_back({worker, encode(events)});
    } else if (std::holds_alternative<message::Drain>(message)) {
      inbox_.push_back({worker, encode(message::Drained{})});
    } else if (std::holds_alternative<message::Release>(message)) {
      inbox_.push_back({worker, encode(message::Released{})});
    }
    seconds_ += clock_() - start;
  }
  std::optional<Received> receive() override {
    if (inbox_.empty()) return std::nullopt;
    auto [worker, bytes] = std::move(inbox_.front());
    inbox_.pop_front();
    return Received{worker, decode(bytes)};
  }
  /// What the workers took.
  double seconds() const { return seconds_; }

 private:
  std::string result_;  ///< as bytes.
  double (*clock_)();
  std::deque<std::pair<int, std::string>> inbox_;
  std::map<int, int> last_family_;
  double seconds_ = 0;
};

/// A campaign of 20 families.
inline void submit(Store& store, int n_cases) {
  constexpr int kFamilies = 20;
  Submission s;
  s.name = "sweep";
  s.parameters = {{"strength", faultsim::Dimension::number, false}};
  s.rank_by = "activated_area";
  s.scenes = {{"scene.json", "{}"}};
  for (int k = 0; k < kFamilies; ++k)
    s.families.push_back({"family-" + std::to_string(k), 1000, 100, 1, 1});
  for (int k = 0; k < n_cases; ++k) {
    const std::string number = std::to_string(k);
    s.cases.push_back({"identity-" + number,
                       k % kFamilies,
                       0,
                       "{\"/strength\": " + number + "}",
                       {{0, std::stod(number), number}}});
  }
  store.submit(s);
}

}  // namespace faultsweep::benchmarks
