#include "simulator/operators/prepare_operator.h"
#include "simulator/cache/operator_cache.h"
#include "simulator/common/errors.h"
#include "simulator/common/machine.h"
#include "simulator/linalg/blas_start.h"
#include "simulator/linalg/cholesky.h"
#include "simulator/operators/memory.h"

namespace faultsim {
namespace {

void mirror_observations(const Scene& scene, const Plan& plan, Observations& observed) {
  FAULTSIM_DEMAND(observed.rows.size() == 3 * scene.output.observation_points.size(),
                  observed.rows.size());
  for (const int row : mirrored_rows(scene, plan.half_domain)) {
    for (int c = -1; c < 2; ++c) observed.rows[row + c].position.y() *= -1;
    observed.per_load.row(row) *= -1;
    observed.per_jump.row(row) *= -1;
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

}  // namespace

void take_fault_names(const Scene& scene, FaultOperator& op) {
  FAULTSIM_DEMAND(op.geometry.faults.size() == scene.faults.size(), op.geometry.faults.size());
  for (std::size_t f = 0; f < scene.faults.size(); ++f) {
    op.geometry.faults[f].name = scene.faults[f].name;
  }
}

PreparedOperator prepare_operator(const SceneBulk& of, const CachePolicy& cache, bool keep_bulk,
                                  const RunContext& context) {
  const Scene& scene = of.scene();
  const Plan& plan = of.plan();
  FAULTSIM_DEMAND(!scene.numerics.surface.wanted(), "an exact operator of a surface's family");
  take_blas_buffer();
  set_blas_threads(1);
  PreparedOperator prepared;
  const std::string name = operator_fingerprint(scene, plan, blas_description());
  const bool keeps_factors = keep_bulk || plan.creep.active;
  if (!cache.folder.empty() && !keeps_factors) {
    if (auto found = find_operator(name, cache, prepared.remark)) {
      take_fault_names(scene, *found);
      prepared.op = std::make_shared<FaultOperator>(std::move(*found));
      prepared.from_cache = true;
      return prepared;
    }
  }
  require_memory(plan, available_memory());
  context.progress(0.0, "meshing");
  const std::shared_ptr<const BulkProblem>& problem = of.problem();
  context.stop.throw_if_requested("meshing");
  auto bulk = std::make_shared<CreepLadder>(problem, plan.creep.rungs, scene.numerics.creep_scheme,
                                            context);
  auto op = std::make_shared<FaultOperator>(bulk->op(0));  // shares H
  take_fault_names(scene, *op);
  mirror_observations(scene, plan, op->observed);
  op->fingerprint = name;
  for (int rung = 1; rung < bulk->n_rungs(); ++rung) {
    op->build_seconds += bulk->op(rung).build_seconds;
    op->factor_bytes += bulk->op(rung).factor_bytes;
  }
  if (!cache.folder.empty() && !plan.creep.active) {
    keep(
        cache, name, "the operator", [&] { write_operator(*op, cache.folder); }, prepared.remark);
  }
  prepared.op = op;
  if (keeps_factors) prepared.bulk = bulk;
  return prepared;
}

}  // namespace faultsim
