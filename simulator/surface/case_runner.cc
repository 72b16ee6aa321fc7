#include "simulator/surface/case_runner.h"

#include "simulator/common/errors.h"
#include "simulator/loading/run_case.h"
#include "simulator/operators/field_loads.h"

namespace faultsim {

Plan exact_plan(const Scene& scene) {
  std::vector<Problem> problems;
  Plan plan = make_plan(scene, problems);
  if (!problems.empty()) throw InputError("scene at a node of its surface", std::move(problems));
  return plan;
}

CaseRunner::CaseRunner(const ProbingScenes& scenes,
                       std::function<Scene(const Eigen::VectorXd& x)> scene_at,
                       const CachePolicy& cache, StopToken stop)
    : scenes_(scenes), scene_at_(std::move(scene_at)), cache_(cache) {
  quiet_.stop = stop;
}

/// Cases at one place come one after the other, and share the influence of its cells.
std::shared_ptr<const FieldHistory> CaseRunner::loads_of(int i, const Place& place, const Scene& at,
                                                         const Scene& scene) {
  std::shared_ptr<const FieldHistory>& known = loads_[{i, place}];
  if (known) return known;
  const Plan plan = exact_plan(at);
  const SceneBulk bulk(at, plan);
  if (influence_place_ != place) {
    influence_ = {};
    influence_ = prepare_influence(bulk, {}, cache_, quiet_);
    influence_place_ = place;
  }
  const FieldCells cells{*influence_.op, bulk.problem()->mesh, *influence_.block};
  known = field_loads(scene, cells).history;
  return known;
}

CaseResult CaseRunner::run(int i, const Eigen::VectorXd& x,
                           const std::shared_ptr<const FaultOperator>& op) {
  const Scene at = scene_at_(x);
  const Scene scene = scenes_.scene(i, at);
  PreparedOperator prepared;
  prepared.op = op;
  if (scene.has_field()) prepared.loads = {loads_of(i, Place(x.begin(), x.end()), at, scene)};
  return run_case(scene, prepared, quiet_);
}

}  // namespace faultsim
