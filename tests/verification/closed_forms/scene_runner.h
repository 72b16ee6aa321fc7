#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "simulator/common/run_context.h"
#include "simulator/loading/run_case.h"
#include "simulator/model/fault_operator.h"
#include "simulator/result/result.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// A change to a scene, as `--set pointer=value`.
struct Setting {
  std::string pointer;
  std::string value;
};
using Settings = std::vector<Setting>;

/// A scene that was run, with all its fault fields.
struct SceneRun {
  Scene scene;
  std::shared_ptr<const FaultOperator> op;
  CaseResult result;
  std::vector<FaultFields> fields;  ///< per step in equilibrium, step 0 first.

  const FaultGeometry& geometry() const { return op->geometry; }
  /// Displacement of the observation row of that name ("surface.z") at a step, m.
  double observed(const std::string& name, std::size_t step) const;
  /// Position of the node that an observation row uses, m.
  Eigen::Vector3d observed_position(const std::string& name) const;
};

/// Runs the scenes of docs/examples/verification, which are embedded, through read_scene,
/// make_plan, prepare_operator and run_case: the code of `faultsim run`. Operators are kept by
/// their fingerprint, so that members of a family are cheap.
class SceneRunner {
 public:
  explicit SceneRunner(const RunContext& context) : context_(context) {}

  /// @param file  "v1_patch_test.json". Throws InputError when the scene is wrong, and Error when
  /// the case does not end `converged` and that was not allowed.
  SceneRun run(const std::string& file, const Settings& settings = {}, bool must_converge = true);

 private:
  RunContext context_;
  std::map<std::string, PreparedOperator> operators_;
};

/// The text of an embedded scene. InternalError when there is none of that name.
std::string_view verification_scene(const std::string& file);

}  // namespace faultsim
