#pragma once

#include <deque>
#include <map>
#include <string>

#include "campaign/scheduler/manager.h"
#include "simulator/result/result_bytes.h"

namespace faultsweep::benchmarks {

/// Workers that have done their work when they get it.
class InstantWorkers final : public Link {
 public:
  /// @param clock  seconds from any origin; by it seconds() counts.
  InstantWorkers(const faultsim::CaseResult& result, double (*clock)())
      : result_(faultsim::result_to_bytes(result)), clock_(clock) {}
  int size() const override { return 65; }
  void send(int to, const Message& message) override {
    const double start = clock_();
    if (const auto* work = std::get_if<message::Work>(&message)) {
      JobEvents events;
      if (const auto [family, is_new] = last_family_.try_emplace(to, work->task.family);
          is_new || family->second != work->task.family) {
        family->second = work->task.family;
        events.operators.push_back({"operator", true, 0.001, 1000, 100, 1000, 1000});
      }
      for (const CaseInput& one : work->cases) {
        RunRecord run;
        run.case_id = one.id;
        run.wall_seconds = 0.001;
        run.status = RunStatus::completed;
        events.completed.push_back({std::move(run), result_});
      }
      inbox_.push_back({to, encode(events)});
    } else if (is(message, message::Signal::drain)) {
      inbox_.push_back({to, encode(message::Signal::drained)});
    } else if (is(message, message::Signal::release)) {
      inbox_.push_back({to, encode(message::Signal::released)});
    }
    seconds_ += clock_() - start;
  }
  std::optional<Received> receive() override {
    if (inbox_.empty()) return std::nullopt;
    auto [from, bytes] = std::move(inbox_.front());
    inbox_.pop_front();
    return Received{from, decode(bytes)};
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
