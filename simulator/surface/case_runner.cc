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

/// Cases at one place come one after the other.
const PreparedInfluence& CaseRunner::influence_at(const Place& place, const SceneBulk& bulk) {
  if (influence_place_ != place) {
    influence_ = {};
    influence_ = prepare_influence(bulk, {}, cache_, quiet_);
    influence_place_ = place;
  }
  return influence_;
}

CaseRunner::Case CaseRunner::made(int i, const Place& place, const Scene& at) {
  Case one{scenes_.scene(i, at), nullptr};
  if (!one.scene.has_field()) return one;
  const Plan plan = exact_plan(at);
  const SceneBulk bulk(at, plan);
  const PreparedInfluence& influence = influence_at(place, bulk);
  const FieldCells cells{*influence.op, bulk.problem()->mesh, *influence.block};
  one.loads = field_loads(one.scene, cells).history;
  return one;
}

CaseResult CaseRunner::run(int i, const Eigen::VectorXd& x,
                           const std::shared_ptr<const FaultOperator>& op) {
  const Place place(x.begin(), x.end());
  auto known = cases_.find({i, place});
  if (known == cases_.end())
    known = cases_.emplace(std::pair(i, place), made(i, place, scene_at_(x))).first;
  const Case& one = known->second;
  PreparedOperator prepared;
  prepared.op = op;
  if (one.loads) prepared.loads = {one.loads};
  return run_case(one.scene, prepared, quiet_);
}

}  // namespace faultsim
