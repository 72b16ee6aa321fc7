// The influence block of a scene's reservoir cells: what it takes against what was predicted, and
// its numbers against those of the bulk. Arguments: SCENE TIER. Prints the table of
// results/influence.

#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <random>

#include "simulator/common/machine.h"
#include "simulator/common/stopwatch.h"
#include "simulator/linalg/blas_start.h"
#include "simulator/operators/influence.h"
#include "simulator/plan/plan.h"
#include "simulator/reading/read_scene.h"

namespace faultsim {
namespace {

/// Processor seconds of this process: other work on the machine does not count.
double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double peak_bytes() {
  struct rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

void row(const char* what, double predicted, double measured, const char* unit) {
  std::printf("| %s | %.3g %s | %.3g %s | %.2f |\n", what, predicted, unit, measured, unit,
              predicted / measured);
}

/// Largest difference of a field's product to the operator's own column, relative to the column.
double uniform_error(const FaultOperator& op, const InfluenceBlock& block) {
  double worst = 0;
  for (std::size_t k = 0; k < op.loads.keys.size(); ++k) {
    const LoadKey& key = op.loads.keys[k];
    Eigen::VectorXd field = Eigen::VectorXd::Zero(block.traction.view().cols());
    for (std::size_t c = 0; c < block.cells.size(); ++c) {
      const InfluenceCell& cell = block.cells[c];
      const bool own = key.kind == LoadKey::Kind::pressure && cell.region == key.index &&
                       cell.material == key.material;
      if (own) field[c] = cell.fraction;
    }
    if (field.isZero(0)) continue;
    const Eigen::VectorXd column = op.loads.traction.col(k);
    worst = std::max(worst, (locked_change(block, field) - column).norm() / column.norm());
  }
  return worst;
}

/// Random fields by the block against a direct solve of the bulk for their nodal forces.
double random_error(CondensedBulk& bulk, const InfluenceBlock& block, int n_fields) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-20e6, 0);
  double worst = 0;
  for (int i = 0; i < n_fields; ++i) {
    Eigen::VectorXd field(block.traction.view().cols());
    for (double& value : field) value = uniform(random);
    Eigen::VectorXd force = Eigen::VectorXd::Zero(bulk.dofs().n_unknowns());
    for (std::size_t c = 0; c < block.cells.size(); ++c) {
      for (const auto& [unknown, value] :
           dilatation_load(bulk.problem().mesh, bulk.dofs(), block.cells[c].cell)) {
        force[unknown] += field[c] * value;
      }
    }
    const Eigen::VectorXd direct = bulk.locked_traction(bulk.forward(force));
    worst = std::max(worst, (locked_change(block, field) - direct).norm() / direct.norm());
  }
  return worst;
}

/// Median of 21 products with n_fields fields each, ms of wall clock per field.
double product_milliseconds(const InfluenceBlock& block, int n_fields, int n_threads) {
  Eigen::MatrixXd fields = Eigen::MatrixXd::Constant(block.traction.view().cols(), n_fields, -1e6);
  std::vector<double> times;
  double sum = 0;
  for (int i = 0; i < 21; ++i) {
    fields(0, 0) -= 1;
    const Stopwatch watch;
    sum += locked_change(block, fields, n_threads)(0, 0);
    times.push_back(1e3 * watch.seconds() / n_fields);
  }
  std::sort(times.begin(), times.end());
  return sum == 0 ? 0 : times[10];
}

void study(const char* file, const char* tier) {
  JsonDocument document = read_json_file(file);
  set_value(document, "/tier", tier);
  const Scene scene = read_scene(document);
  std::vector<Problem> problems;
  const Plan plan = make_plan(scene, problems);
  if (!problems.empty()) throw InputError(file, problems);
  SilentMonitor monitor;
  take_blas_buffer();

  const BulkProblem problem = bulk_problem(scene, plan);
  const std::vector<int> cells = reservoir_cells(problem, {});
  const InfluenceCost predicted = plan_influence(scene, plan, static_cast<long>(cells.size()));
  double start = processor_seconds();
  CondensedBulk bulk(problem, monitor);
  const FaultOperator op = bulk.condense();
  const double operator_seconds = processor_seconds() - start;
  start = processor_seconds();
  const InfluenceBlock block = bulk.influence(cells, monitor);
  const double seconds = processor_seconds() - start;
  const double peak = peak_bytes();
  const auto p = block.traction.view();

  std::printf("| of %d unknowns, %ld jumps, %ld cells | predicted | measured | ratio |\n",
              op.n_unknowns, static_cast<long>(p.rows()), static_cast<long>(p.cols()));
  std::printf("|---|---|---|---|\n");
  row("operator", plan.operator_seconds, operator_seconds, "s");
  row("block on top of it", predicted.seconds, seconds, "s");
  row("block, in memory and on disk", predicted.bytes / 1e6,
      8e-6 * static_cast<double>(p.size() + block.observed.size()), "MB");
  row("peak memory of both",
      std::max(plan.memory_bytes, kProgramBytes + predicted.peak_bytes) / 1e9, peak / 1e9, "GB");
  std::printf("| uniform fields against the operator's columns | ≤ 1e-12 | %.1e | |\n",
              uniform_error(op, block));
  std::printf("| 3 random fields against direct solves | ≤ 1e-12 | %.1e | |\n",
              random_error(bulk, block, 3));
  for (const int n_threads : {1, usable_cores()}) {
    for (const int n_fields : {1, 8}) {
      std::printf("| any further field, %d at once, %d threads | ≤ 20 ms | %.1f ms | |\n", n_fields,
                  n_threads, product_milliseconds(block, n_fields, n_threads));
    }
  }
}

}  // namespace
}  // namespace faultsim

int main(int argc, char** argv) {
  faultsim::start_blas(argv);
  if (argc != 3) {
    std::fprintf(stderr, "usage: influence_study SCENE TIER\n");
    return 2;
  }
  try {
    faultsim::study(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "influence_study: %s\n", error.what());
    return 70;
  }
}
