// How long the contact solve of a plane-strain case takes: a displaced vertical fault that is
// depleted, refilled and cycled; 25 load steps, slip over a third of the nodes, then reversed.
#include <benchmark/benchmark.h>

#include <cmath>

#include "tests/unit/contact/depleted_fault.h"

namespace faultsim {
namespace {

void solve_history(benchmark::State& timing) {
  const DepletedFault fault = depleted_fault(
      static_cast<int>(timing.range(0)), static_cast<int>(timing.range(1)), timing.range(2) != 0);
  SolveCounts counts;
  int slipping = 0;
  for (auto _ : timing) {
    ContactSolver solver(fault.op, fault.laws, {});
    ContactState state = initial_state(fault.op);
    Eigen::VectorXd before = Eigen::VectorXd::Zero(fault.op.geometry.n_dofs);
    counts = {};
    slipping = 0;
    for (const Eigen::VectorXd& locked : fault.locked) {
      const ContactReport report = solver.solve_step(before, locked, state);
      if (report.outcome != Outcome::converged) {
        timing.SkipWithError(report.reason.c_str());
        return;
      }
      counts.newton_iterations += report.counts.newton_iterations;
      counts.sub_steps += report.counts.sub_steps;
      int now = 0;
      for (const FaultState s : state.state) now += s == FaultState::slip;
      slipping = std::max(slipping, now);
      before = locked;
    }
  }
  timing.counters["solves"] = counts.newton_iterations;
  timing.counters["sub_steps"] = counts.sub_steps;
  timing.counters["slipping"] = slipping;
}
BENCHMARK(solve_history)
    ->Unit(benchmark::kMicrosecond)
    ->Args({210, 1, 0})
    ->Args({300, 1, 0})
    ->Args({250, 1, 1})
    ->Args({250, 2, 0});

}  // namespace
}  // namespace faultsim

BENCHMARK_MAIN();
