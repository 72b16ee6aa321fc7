// (b) cases per second once the operator exists, metrics included: a plane-strain reference scene
// whose faults slip in production and slip back in storage; (c) the same for the standard 3D scene.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <functional>

#include "simulator/linalg/cholesky.h"
#include "simulator/loading/run_case.h"
#include "tests/benchmarks/scenes.h"

namespace faultsim::benchmarks {
namespace {

/// What a case did, so that the figure is seen to belong to work: nodes that slipped at all, and
/// nodes that slid back in storage against their slip so far.
class SlipWitness {
 public:
  void operator()(const StepResult& step, const FaultFields& fields) {
    if (jump_.cols() == 0) jump_ = Eigen::Matrix3Xd::Zero(3, fields.jump.cols());
    if (reversed_.empty()) reversed_.assign(static_cast<std::size_t>(fields.jump.cols()), false);
    for (Eigen::Index k = 0; k < jump_.cols(); ++k) {
      const double against =
          (fields.jump.col(k) - jump_.col(k)).tail<2>().dot(jump_.col(k).tail<2>());
      if (step.stage == "gas_storage" && against < 0) reversed_[static_cast<std::size_t>(k)] = true;
    }
    jump_ = fields.jump;
  }
  double slipped() const {
    return static_cast<double>((jump_.bottomRows<2>().colwise().norm().array() > 0).count()) /
           static_cast<double>(jump_.cols());
  }
  double reversed() const {
    return static_cast<double>(std::count(reversed_.begin(), reversed_.end(), true)) /
           static_cast<double>(reversed_.size());
  }

 private:
  Eigen::Matrix3Xd jump_;
  std::vector<bool> reversed_;
};

void run_cases(benchmark::State& state, const PlannedScene& planned_scene) {
  SilentMonitor monitor;
  const PreparedOperator prepared =
      prepare_operator(planned_scene.scene, planned_scene.plan, {}, false, monitor);
  set_blas_threads(static_cast<int>(state.range(0)));
  SlipWitness witness;
  const CaseResult result = run_case(planned_scene.scene, prepared, monitor, {{std::ref(witness)}});
  for (auto _ : state) {
    benchmark::DoNotOptimize(run_case(planned_scene.scene, prepared, monitor).whole.moment);
  }
  state.counters["converged"] = result.outcome == Outcome::converged;
  state.counters["node_pairs"] = static_cast<double>(prepared.op->geometry.nodes.size());
  state.counters["load_steps"] = static_cast<double>(result.steps.size());
  state.counters["share_slipped_at_end"] = witness.slipped();
  state.counters["share_slid_back_in_storage"] = witness.reversed();
  state.counters["newton_iterations"] = result.counts.newton_iterations;
  state.counters["operator_s"] = prepared.op->build_seconds;
  state.counters["cases_per_s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void plane_strain_case(benchmark::State& state) {
  static const PlannedScene scene =
      planned("rotliegend.json", {{"/tier", "custom"},
                                  {"/mesh", kEven10},
                                  {"/numerics/plane_strain", "on"},
                                  {"/mesh/dip", "7 m"},
                                  {"/geometry/blocks/1/offset", "200 m"},
                                  {"/friction/friction_angle", "18 deg"},
                                  {"/stages/2/pressure_between", "[\"-120 bar\", \"-20 bar\"]"}});
  run_cases(state, scene);
}
BENCHMARK(plane_strain_case)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

void standard_case(benchmark::State& state) {
  static const PlannedScene scene =
      planned("rotliegend.json", {{"/tier", "custom"},
                                  {"/mesh", kEven20},
                                  {"/geometry/blocks/1/offset", "100 m"},
                                  {"/friction/friction_angle", "20 deg"}});
  run_cases(state, scene);
}
BENCHMARK(standard_case)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace faultsim::benchmarks

BENCHMARK_MAIN();
