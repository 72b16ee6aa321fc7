// How many results per second the manager dispatches and commits: it must keep hundreds of ranks
// busy. Its workers answer at once with a prepared result; their time (and that of encoding, which
// is a worker's too) does not count, receiving, decoding, planning and committing do.

#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>

#include "tests/benchmarks/clocks.h"
#include "tests/benchmarks/instant_workers.h"
#include "tests/campaign/made_up_result.h"

namespace faultsweep {
namespace {

using benchmarks::InstantWorkers;
using faultsim::benchmarks::wall_seconds;

constexpr int kCases = 20000;

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
      benchmarks::submit(store, kCases);
      InstantWorkers workers(result, wall_seconds);
      const double start = wall_seconds();
      Manager manager(store, workers, silent, {});
      while (manager.turn()) {
      }
      state.SetIterationTime(wall_seconds() - start - workers.seconds());
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
