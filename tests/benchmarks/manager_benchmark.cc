// How many results per second the manager dispatches and commits: it must keep hundreds of ranks
// busy. Its workers answer at once with a prepared result; their time (and that of encoding, which
// is a worker's too) does not count, receiving, decoding, planning and committing do.

#include <benchmark/benchmark.h>
#include <unistd.h>

#include <deque>
#include <filesystem>

#include "campaign/scheduler/manager.h"
#include "simulator/common/stopwatch.h"
#include "tests/campaign/made_up_result.h"

namespace faultsweep {
namespace {

constexpr int kCases = 20000, kFamilies = 20, kWorkers = 64;

/// Workers that have done their work when they get it.
class InstantWorkers final : public WorkerLink {
 public:
  explicit InstantWorkers(faultsim::CaseResult result) : result_(std::move(result)) {}
  int n_workers() const override { return kWorkers; }
  void send(int worker, const Message& message) override {
    const faultsim::Stopwatch watch;
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
        run.result = result_;
        events.events.completed.push_back(std::move(run));
      }
      inbox_.push_back({worker, encode(events)});
    } else if (std::holds_alternative<message::Drain>(message)) {
      inbox_.push_back({worker, encode(message::Drained{})});
    } else if (std::holds_alternative<message::Release>(message)) {
      inbox_.push_back({worker, encode(message::Released{})});
    }
    seconds_ += watch.seconds();
  }
  std::optional<Received> receive() override {
    if (inbox_.empty()) return std::nullopt;
    auto [worker, bytes] = std::move(inbox_.front());
    inbox_.pop_front();
    return Received{worker, decode(bytes)};
  }
  double seconds() const { return seconds_; }

 private:
  faultsim::CaseResult result_;
  std::deque<std::pair<int, std::string>> inbox_;
  std::map<int, int> last_family_;
  double seconds_ = 0;
};

void submit(Store& store) {
  Submission s;
  s.name = "sweep";
  s.parameters = R"([{"name": "strength", "dimension": "number"}])";
  s.rank_by = "activated_area";
  s.scenes = {{"scene.json", "{}"}};
  for (int k = 0; k < kFamilies; ++k)
    s.families.push_back({"family-" + std::to_string(k), 1000, 100, 1, 1});
  for (int k = 0; k < kCases; ++k) {
    const std::string number = std::to_string(k);
    s.cases.push_back({"identity-" + number, k % kFamilies, 0, "{\"/strength\": " + number + "}",
                       "[" + number + "]", "[\"" + number + "\"]"});
  }
  store.submit(s);
}

/// @param state  range(0): load steps of each result, on 2 faults; 0 = a result without histories.
void manager(benchmark::State& state) {
  faultsim::CaseResult result =
      testing::made_up_result(0.9, std::max(1, static_cast<int>(state.range(0))));
  if (state.range(0) == 0) result.steps.clear();
  ProgressDisplay silent(ProgressDisplay::Style::silent);
  double bytes = 0;
  for (auto _ : state) {
    std::string name = (std::filesystem::temp_directory_path() / "manager-XXXXXX").string();
    const std::filesystem::path folder = mkdtemp(name.data());
    {
      Store store = Store::open_owner(folder);
      submit(store);
      InstantWorkers workers(result);
      const faultsim::Stopwatch watch;
      Manager manager(store, workers, silent, {});
      while (manager.turn()) {
      }
      state.SetIterationTime(watch.seconds() - workers.seconds());
      if (manager.status() != faultsim::ExitCode::done) state.SkipWithError("not all cases done");
      store.checkpoint();
    }
    bytes = static_cast<double>(std::filesystem::file_size(folder / "campaign.sqlite")) / kCases;
    std::filesystem::remove_all(folder);
  }
  state.counters["results_per_s"] =
      benchmark::Counter(kCases, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["bytes_per_case"] = bytes;
}
BENCHMARK(manager)->Arg(0)->Arg(25)->Unit(benchmark::kMillisecond)->UseManualTime();

}  // namespace
}  // namespace faultsweep

BENCHMARK_MAIN();
