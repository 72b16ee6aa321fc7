#include "simulator/operators/influence.h"

#include <algorithm>

#include "simulator/cache/influence_file.h"
#include "simulator/cache/operator_cache.h"
#include "simulator/common/errors.h"
#include "simulator/common/fingerprint.h"
#include "simulator/common/machine.h"
#include "simulator/common/ranges.h"
#include "simulator/linalg/blas.h"
#include "simulator/linalg/blas_start.h"
#include "simulator/operators/memory.h"
#include "simulator/plan/plan.h"

namespace faultsim {
namespace {

/// Cells are told by their regions, so that the name is known without the mesh.
std::string influence_fingerprint(const std::string& op, const std::vector<int>& regions) {
  std::string definition = concat(op, " influence of reservoir cells");
  for (const int region : regions) definition += concat(' ', region);
  return fingerprint(definition);
}

std::filesystem::path influence_path(const CachePolicy& cache, const std::string& op,
                                     const std::string& name) {
  return cache.folder / concat(op, "-influence-", name.substr(0, 12), ".h5");
}

}  // namespace

std::vector<int> reservoir_cells(const BulkProblem& problem, const std::vector<int>& regions) {
  std::vector<int> cells;
  for (int c = 0; c < static_cast<int>(problem.mesh.cells.size()); ++c) {
    const int region = pressure_region(problem, c);
    const bool wanted = regions.empty() || contains(regions, region);
    if (region >= 0 && wanted) cells.push_back(c);
  }
  return cells;
}

InfluenceBlock cells_of_compartments(const Scene& scene, const BulkProblem& problem) {
  InfluenceBlock block;
  block.cells = influence_cells(problem, reservoir_cells(problem, {}));
  block.region_names = region_names(scene);
  return block;
}

PreparedInfluence prepare_influence(const SceneBulk& of, const std::vector<int>& regions,
                                    const CachePolicy& cache, const RunContext& context,
                                    bool keep_bulk) {
  const Scene& scene = of.scene();
  const Plan& plan = of.plan();
  FAULTSIM_DEMAND(!plan.creep.active, "an influence block is of the elastic operator");
  take_blas_buffer();
  set_blas_threads(1);
  const std::string op_name = operator_fingerprint(scene, plan, blas_description());
  const std::string name = influence_fingerprint(op_name, regions);
  PreparedInfluence made;
  if (!cache.folder.empty()) {
    auto block = read_influence(influence_path(cache, op_name, name), name, &made.remark);
    if (block) {
      PreparedOperator prepared = prepare_operator(of, cache, keep_bulk, context);
      if (!prepared.remark.empty()) made.remark = prepared.remark;
      made.op = prepared.op;
      made.bulk = prepared.bulk;
      block->region_names = region_names(scene);
      made.block = std::make_shared<InfluenceBlock>(std::move(*block));
      made.from_cache = true;
      return made;
    }
  }
  const std::vector<int> cells = reservoir_cells(*of.problem(), regions);
  made.predicted = plan_influence(scene, plan, static_cast<long>(cells.size()));
  Plan whole = plan;
  whole.memory_bytes = std::max(plan.memory_bytes, kProgramBytes + made.predicted.peak_bytes);
  require_memory(whole, available_memory(), false);
  PreparedOperator prepared = prepare_operator(of, cache, true, context);
  made.op = prepared.op;
  if (keep_bulk) made.bulk = prepared.bulk;
  if (!prepared.remark.empty()) made.remark = prepared.remark;
  auto block = std::make_shared<InfluenceBlock>(prepared.bulk->bulk(0).influence(cells, context));
  block->fingerprint = name;
  block->operator_fingerprint = op_name;
  block->region_names = region_names(scene);
  for (const int row : mirrored_rows(scene, plan.half_domain)) block->observed.row(row) *= -1;
  made.block = block;
  if (!cache.folder.empty()) {
    keep(
        cache, op_name, "the influence block",
        [&] { write_influence(*block, *made.op, influence_path(cache, op_name, name)); },
        made.remark);
  }
  return made;
}

}  // namespace faultsim
