#include "simulator/common/errors.h"
#include "simulator/linalg/blas_start.h"
#include "simulator/linalg/cholesky.h"
#include "simulator/loading/memory.h"
#include "simulator/loading/run_case.h"
#include "simulator/output/operator_cache.h"

namespace faultsim {
namespace {

/// Fault names are no part of a family: an operator made for another scene may carry other names.
void take_fault_names(const Scene& scene, FaultOperator& op) {
  FAULTSIM_DEMAND(op.geometry.faults.size() == scene.faults.size(), op.geometry.faults.size());
  for (std::size_t f = 0; f < scene.faults.size(); ++f) {
    op.geometry.faults[f].name = scene.faults[f].name;
  }
}

/// Points of the half that is not modelled were observed at their mirror image (bulk_problem):
/// there u_y is opposite.
void mirror_observations(const Scene& scene, FaultOperator& op) {
  const auto& points = scene.output.observation_points;
  FAULTSIM_DEMAND(op.observations.size() == 3 * points.size(), op.observations.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].position[1] >= 0) continue;
    for (std::size_t c = 0; c < 3; ++c) op.observations[3 * i + c].position.y() *= -1;
    const auto row = static_cast<Eigen::Index>(3 * i + 1);
    op.observed_load.row(row) *= -1;
    op.observed_jump.row(row) *= -1;
  }
}

/// An operator that cannot be kept is still an operator: a full disk must not cost the run.
void keep_operator(const FaultOperator& op, const CachePolicy& cache, std::string& remark) {
  try {
    write_operator(op, cache.folder);
    prune_operators(cache.folder, cache.max_bytes, op.fingerprint);
  } catch (const StorageError& error) {
    if (!remark.empty()) remark += "; ";
    remark += concat("the operator is not kept for other runs: ", error.what());
  }
}

/// The operator from the cache; where the host has a folder of its own, from a copy made there. One
/// that cannot be copied is used where it is.
std::optional<FaultOperator> find_operator(const std::string& name, const CachePolicy& cache,
                                           std::string& remark) {
  if (cache.node_folder.empty()) return read_operator(cache.folder, name, &remark);
  if (auto near = read_operator(cache.node_folder, name, &remark)) return near;
  auto found = read_operator(cache.folder, name, &remark);
  if (!found) return found;
  try {
    write_operator(*found, cache.node_folder);
    prune_operators(cache.node_folder, cache.max_bytes, name);
    if (auto near = read_operator(cache.node_folder, name)) return near;
  } catch (const StorageError& error) {
    remark = concat("the operator is not copied to this host: ", error.what());
  }
  return found;
}

/// Every process needs the factors of a creeping family, so its operators are built, never read.
PreparedOperator prepare_ladder(const Scene& scene, const Plan& plan, const BuildOptions& options,
                                Monitor& monitor) {
  demand_memory(plan, available_memory());
  monitor.progress(0.0, "meshing");
  const MaxwellScheme scheme = scene.numerics.creep_scheme == CreepScheme::exponential
                                   ? MaxwellScheme::exponential
                                   : MaxwellScheme::backward_euler;
  PreparedOperator prepared;
  prepared.ladder = std::make_shared<CreepLadder>(bulk_problem(scene, plan), plan.creep.rungs,
                                                  scheme, options, monitor);
  auto op = std::make_shared<FaultOperator>(prepared.ladder->op(0));  // shares H
  take_fault_names(scene, *op);
  if (plan.half_domain) mirror_observations(scene, *op);
  op->fingerprint = operator_fingerprint(scene, plan, blas_description());
  for (int rung = 1; rung < prepared.ladder->n_rungs(); ++rung) {
    op->build_seconds += prepared.ladder->op(rung).build_seconds;
    op->factor_bytes += prepared.ladder->op(rung).factor_bytes;
  }
  prepared.op = op;
  return prepared;
}

}  // namespace

PreparedOperator prepare_operator(const Scene& scene, const Plan& plan, const CachePolicy& cache,
                                  bool keep_bulk, Monitor& monitor) {
  take_blas_buffer();
  const BuildOptions options;
  set_blas_threads(options.blas_threads);
  if (plan.creep.active) return prepare_ladder(scene, plan, options, monitor);
  PreparedOperator prepared;
  const std::string name = operator_fingerprint(scene, plan, blas_description());
  if (!cache.folder.empty() && !keep_bulk) {
    if (auto found = find_operator(name, cache, prepared.remark)) {
      take_fault_names(scene, *found);
      prepared.op = std::make_shared<FaultOperator>(std::move(*found));
      prepared.from_cache = true;
      return prepared;
    }
  }
  demand_memory(plan, available_memory());
  monitor.progress(0.0, "meshing");
  const BulkProblem problem = bulk_problem(scene, plan);
  auto bulk = std::make_shared<CondensedBulk>(problem, options, monitor);
  auto op = std::make_shared<FaultOperator>(bulk->condense());
  if (plan.half_domain) mirror_observations(scene, *op);
  op->fingerprint = name;
  if (!cache.folder.empty()) keep_operator(*op, cache, prepared.remark);
  prepared.op = op;
  if (keep_bulk) prepared.bulk = bulk;
  return prepared;
}

}  // namespace faultsim
