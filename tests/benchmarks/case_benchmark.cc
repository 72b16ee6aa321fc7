// (b) cases per second once the operator exists, metrics included: a plane-strain reference scene whose
// faults slip in production and slip back in storage; (c) the same for the standard 3D scene.

#include <benchmark/benchmark.h>

#include "simulator/linalg/cholesky.h"
#include "simulator/loading/run_case.h"
#include "tests/benchmarks/scenes.h"

namespace faultsim::benchmarks {
namespace {

void run_cases(benchmark::State& state, const PlannedScene& planned_scene) {
  set_blas_threads(static_cast<int>(state.range(0)));
  SilentMonitor monitor;
  const PreparedOperator prepared =
      prepare_operator(planned_scene.scene, planned_scene.plan, {}, false, monitor);
  set_blas_threads(static_cast<int>(state.range(0)));
  CaseResult result;
  for (auto _ : state) {
    result = run_case(planned_scene.scene, *prepared.op, monitor);
    benchmark::DoNotOptimize(result.whole.moment);
  }
  const auto n_nodes = static_cast<double>(prepared.op->geometry.nodes.size());
  const StepResult& last = result.steps.back();
  int slipped_back = 0;  // nodes in slip in any storage step: slip has reversed there
  for (const StepResult& step : result.steps) {
    if (step.stage == "gas_storage") slipped_back = std::max(slipped_back, step.n_slip);
  }
  double slipped = 0;
  for (const FaultMetrics& fault : last.faults) slipped += fault.max_slip > 0;
  state.counters["converged"] = result.outcome == Outcome::converged;
  state.counters["node_pairs"] = n_nodes;
  state.counters["load_steps"] = static_cast<double>(result.steps.size());
  state.counters["most_nodes_in_slip_in_storage"] = slipped_back;
  state.counters["newton_iterations"] = result.counts.newton_iterations;
  state.counters["cases_per_s"] = benchmark::Counter(static_cast<double>(state.iterations()),
                                                     benchmark::Counter::kIsRate);
}

void plane_strain_case(benchmark::State& state) {
  static const PlannedScene scene =
      planned("rotliegend.json", {{"/tier", "screening"},
                                  {"/geometry/blocks/1/offset", "100 m"},
                                  {"/friction/friction_angle", "12 deg"},
                                  {"/initial_state/ratio_across", "0.6"}});
  run_cases(state, scene);
}
BENCHMARK(plane_strain_case)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

void standard_case(benchmark::State& state) {
  static const PlannedScene scene =
      planned("rotliegend.json", {{"/tier", "standard"},
                                  {"/geometry/blocks/1/offset", "100 m"},
                                  {"/friction/friction_angle", "20 deg"}});
  run_cases(state, scene);
}
BENCHMARK(standard_case)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace faultsim::benchmarks

BENCHMARK_MAIN();
