// (a) building the condensed operator against a plain factorisation of the same matrix, and
// (c) the `standard` 3D reference scene. Arguments: BLAS threads.

#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include "simulator/common/stopwatch.h"
#include "simulator/condensation/condensation.h"
#include "simulator/loading/run_case.h"
#include "tests/benchmarks/plain_bulk.h"
#include "tests/benchmarks/scenes.h"

namespace faultsim::benchmarks {
namespace {

double peak_gigabytes() {
  struct rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1048576.0;
}

/// The standard tier with faster growth away from the faults: about 260 thousand unknowns, 3600
/// jumps.
const PlannedScene& ratio_scene() {
  static const PlannedScene scene = planned(
      "rotliegend.json",
      {{"/tier", "custom"}, {"/mesh", kEven20}, {"/mesh/growth", "1.5"}, {"/mesh/strike", "80 m"}});
  return scene;
}
const PlannedScene& standard_scene() {
  static const PlannedScene scene =
      planned("rotliegend.json", {{"/tier", "custom"}, {"/mesh", kEven20}});
  return scene;
}

void build_operator(benchmark::State& state, const PlannedScene& scene) {
  const BulkProblem problem = bulk_problem(scene.scene, scene.plan);
  SilentMonitor monitor;
  for (auto _ : state) {
    CondensedBulk bulk(problem, {monitor, {}, static_cast<int>(state.range(0))});
    const FaultOperator op = bulk.condense();
    state.counters["unknowns"] = op.n_unknowns;
    state.counters["jump_unknowns"] = op.geometry.n_dofs;
    state.counters["factor_GB"] = op.factor_bytes / 1e9;
    state.counters["peak_GB"] = peak_gigabytes();  // of the process so far
  }
}
void condensed_operator(benchmark::State& state) { build_operator(state, ratio_scene()); }
void standard_operator(benchmark::State& state) { build_operator(state, standard_scene()); }
BENCHMARK(condensed_operator)
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kSecond)
    ->Iterations(1)
    ->UseRealTime();

/// The plain alternative, factorised once.
void plain(benchmark::State& state, const PlannedScene& scene) {
  const BulkProblem problem = bulk_problem(scene.scene, scene.plan);
  set_blas_threads(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    const PlainBulk bulk = plain_bulk(problem);
    TrailingCholesky factor = bulk.factorised();
    // What full-mesh Newton would pay per iteration: a numerical factorisation, or with the factor
    // kept at least one pair of triangular solves.
    const Stopwatch watch;
    benchmark::DoNotOptimize(factor.solve(Eigen::VectorXd::Ones(bulk.dofs.n_unknowns())).norm());
    state.counters["solve_s"] = watch.seconds();
    state.counters["unknowns"] = bulk.dofs.n_unknowns();
    state.counters["factor_GB"] = factor.statistics().bytes / 1e9;
    state.counters["factor_only_s"] = factor.statistics().factor_seconds;
  }
}
void plain_factorisation(benchmark::State& state) { plain(state, ratio_scene()); }
void standard_plain(benchmark::State& state) { plain(state, standard_scene()); }
BENCHMARK(plain_factorisation)
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kSecond)
    ->Iterations(1)
    ->UseRealTime();
BENCHMARK(standard_operator)->Arg(1)->Unit(benchmark::kSecond)->Iterations(1)->UseRealTime();
BENCHMARK(standard_plain)->Arg(1)->Unit(benchmark::kSecond)->Iterations(1)->UseRealTime();

}  // namespace
}  // namespace faultsim::benchmarks

BENCHMARK_MAIN();
