// What creeping salt costs: cases and accepted time steps against the elastic case on the same
// mesh, (a) for the plane-strain reference scene, (b) for the standard 3D scene, whose ladder of
// operators is the largest thing we hold: seconds to build it and peak memory. One BLAS thread.

#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include "simulator/common/stopwatch.h"
#include "simulator/loading/run_case.h"
#include "tests/benchmarks/scenes.h"

namespace faultsim::benchmarks {
namespace {

double peak_gigabytes() {
  struct rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss) / 1e9;
}

/// The scene with its ladder, built when first asked for and kept for the benchmarks that share it.
struct Prepared {
  explicit Prepared(const PlannedScene& given) : planned_scene(given) {
    SilentMonitor monitor;
    const Stopwatch watch;
    op = prepare_operator(given.scene, given.plan, {}, false, monitor);
    build_seconds = watch.seconds();
    build_peak = peak_gigabytes();
  }
  PlannedScene planned_scene;
  PreparedOperator op;
  double build_seconds = 0, build_peak = 0;
};

void count(benchmark::State& state, const CaseResult& result) {
  int time_steps = 0;
  for (const StepResult& step : result.steps) time_steps += step.creep ? step.creep->time_steps : 0;
  state.counters["in_equilibrium"] = in_equilibrium(result.outcome);
  state.counters["load_steps"] = static_cast<double>(result.steps.size());
  state.counters["max_slip_mm"] = 1000 * result.whole.max_slip;
  state.counters["slip_events"] = static_cast<double>(result.events.size());
  state.counters["newton_iterations"] = result.counts.newton_iterations;
  state.counters["wasted_newton_iterations"] = result.counts.wasted_newton_iterations;
  if (time_steps == 0) return;
  state.counters["accepted_time_steps"] = time_steps;
  state.counters["s_per_accepted_step"] = benchmark::Counter(
      time_steps, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void creeping(benchmark::State& state, const Prepared& prepared) {
  SilentMonitor monitor;
  CaseResult result;
  for (auto _ : state) result = run_case(prepared.planned_scene.scene, prepared.op, monitor);
  count(state, result);
  const FaultOperator& op = *prepared.op.op;
  state.counters["operators"] = prepared.op.bulk->n_rungs();
  state.counters["build_s"] = prepared.build_seconds;
  state.counters["factors_GB"] = op.factor_bytes / 1e9;
  state.counters["peak_GB_build"] = prepared.build_peak;
  state.counters["peak_GB"] = peak_gigabytes();
  state.counters["predicted_GB"] = prepared.planned_scene.plan.memory_bytes / 1e9;
  state.counters["unknowns"] = op.n_unknowns;
  state.counters["jump_unknowns"] = op.geometry.n_dofs;
}

/// The same scene with elastic salt, on the elastic operator of the ladder.
void elastic(benchmark::State& state, const Prepared& prepared) {
  SilentMonitor monitor;
  CaseResult result;
  for (auto _ : state)
    result = run_case(prepared.planned_scene.scene, *prepared.op.op,
                      elastic_steps(*prepared.op.op, nullptr), monitor);
  count(state, result);
}

const Prepared& plane_strain_scene() {
  static const Prepared prepared(
      planned("rotliegend-salt.json", {{"/tier", "custom"},
                                       {"/mesh", kEven10},
                                       {"/numerics/plane_strain", "on"},
                                       {"/geometry/blocks/1/offset", "200 m"},
                                       {"/friction/friction_angle", "20 deg"}}));
  return prepared;
}
const Prepared& standard_scene() {
  static const Prepared prepared(
      planned("rotliegend-salt.json",
              {{"/tier", "custom"}, {"/mesh", kEven20}, {"/friction/friction_angle", "20 deg"}}));
  return prepared;
}

void plane_strain_creeping(benchmark::State& state) { creeping(state, plane_strain_scene()); }
void plane_strain_elastic(benchmark::State& state) { elastic(state, plane_strain_scene()); }
void standard_creeping(benchmark::State& state) { creeping(state, standard_scene()); }
void standard_elastic(benchmark::State& state) { elastic(state, standard_scene()); }
BENCHMARK(plane_strain_creeping)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(plane_strain_elastic)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(standard_creeping)->Unit(benchmark::kMillisecond)->Iterations(1)->UseRealTime();
BENCHMARK(standard_elastic)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace faultsim::benchmarks

BENCHMARK_MAIN();
