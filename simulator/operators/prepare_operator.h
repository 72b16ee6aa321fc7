#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "simulator/cache/cache_policy.h"
#include "simulator/common/run_context.h"
#include "simulator/condensation/condensation.h"
#include "simulator/condensation/creep_ladder.h"
#include "simulator/loads/load_source.h"
#include "simulator/model/fault_operator.h"
#include "simulator/plan/plan.h"
#include "simulator/result/field_integral.h"
#include "simulator/result/result.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// The family of a scene turned into numbers for the bulk.
BulkProblem bulk_problem(const Scene& scene, const Plan& plan);
/// The same of a mesh that is made already, scene_mesh() of both.
BulkProblem bulk_problem(const Scene& scene, const Plan& plan, Mesh mesh);

/// A scene with its plan, and its bulk problem, which is made when it is first asked for and once.
class SceneBulk {
 public:
  /// @param mesh  scene_mesh() of both, if it is there. @pre scene and plan outlive this.
  SceneBulk(const Scene& scene, const Plan& plan, std::shared_ptr<const Mesh> mesh = nullptr)
      : scene_(scene), plan_(plan), mesh_(std::move(mesh)) {}
  const Scene& scene() const { return scene_; }
  const Plan& plan() const { return plan_; }
  const std::shared_ptr<const BulkProblem>& problem() const;

 private:
  const Scene& scene_;
  const Plan& plan_;
  std::shared_ptr<const Mesh> mesh_;
  mutable std::shared_ptr<const BulkProblem> problem_;
};

/// The mesh of a field's bulk problem without cells and boundary, which is all that its faults need
/// and a fraction of the time; nothing where its topology is not that of `like`, the mesh of
/// another one's bulk problem. The quality of its cells is not looked at.
std::optional<Mesh> moved_faults(const Scene& scene, const Plan& plan, const Mesh& like);
/// Points of the half that is not modelled are observed at their mirror image. The rows (three per
/// observation point) whose sign is therefore to be turned: their u_y.
std::vector<int> mirrored_rows(const Scene& scene, bool half_domain);
/// Fault names are not part of a family: an operator made for another scene may carry other names.
void take_fault_names(const Scene& scene, FaultOperator& op);

/// The operator of the scene: from the cache if it is there and sound, else built (and cached).
/// Throws ResourceError before anything is built when the plan needs more memory than is available;
/// a cache that cannot be written is a remark. A scene with a surface has none (simulator/surface).
struct PreparedOperator {
  std::shared_ptr<const FaultOperator> op;  ///< elastic.
  /// The factors, of which nothing is kept in files: where the plan has creep, as every time step
  /// needs them, or where keep_bulk was asked (displacement fields, influences); else null.
  std::shared_ptr<CreepLadder> bulk;
  LoadSources loads = {};                     ///< beside those of the operator.
  std::optional<CaseSurface> surface = {};    ///< only where it is interpolated.
  std::optional<double> field_coverage = {};  ///< as in CaseResult, as is
  std::optional<double> field_assumed = {};
  std::vector<FieldIntegral> integrals = {};  ///< of its flow results (field_loads.h).
  std::vector<std::string> warnings = {};     ///< for every result on it.
  bool from_cache = false;
  std::string remark;  ///< "damaged operator file moved aside", "not kept", ...
};
/// @param keep_bulk  wanted with its factor, so never read from the cache.
PreparedOperator prepare_operator(const SceneBulk& of, const CachePolicy& cache, bool keep_bulk,
                                  const RunContext& context = {});
inline PreparedOperator prepare_operator(const Scene& scene, const Plan& plan,
                                         const CachePolicy& cache, bool keep_bulk,
                                         const RunContext& context = {}) {
  return prepare_operator(SceneBulk(scene, plan), cache, keep_bulk, context);
}

}  // namespace faultsim
