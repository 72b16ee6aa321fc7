#include "simulator/linalg/cholesky.h"
#include "simulator/loading/run_case.h"
#include "simulator/output/operator_cache.h"

namespace faultsim {

PreparedOperator prepare_operator(const Scene& scene, const Plan& plan, const CachePolicy& cache,
                                  bool keep_bulk, Monitor& monitor) {
  const BuildOptions options;
  set_blas_threads(options.blas_threads);
  PreparedOperator prepared;
  const std::string name = operator_fingerprint(scene, plan, blas_description());
  if (!cache.folder.empty() && !keep_bulk) {
    if (auto found = read_operator(cache.folder, name, &prepared.remark)) {
      prepared.op = std::make_shared<FaultOperator>(std::move(*found));
      prepared.from_cache = true;
      return prepared;
    }
  }
  monitor.progress(0.0, "meshing");
  const BulkProblem problem = bulk_problem(scene, plan);
  auto bulk = std::make_shared<CondensedBulk>(problem, options, monitor);
  auto op = std::make_shared<FaultOperator>(bulk->condense());
  op->fingerprint = name;
  if (!cache.folder.empty()) {
    write_operator(*op, cache.folder);
    prune_operators(cache.folder, cache.max_bytes, name);
  }
  prepared.op = op;
  if (keep_bulk) prepared.bulk = bulk;
  return prepared;
}

}  // namespace faultsim
