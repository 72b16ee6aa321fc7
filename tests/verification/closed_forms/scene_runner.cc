#include "tests/verification/closed_forms/scene_runner.h"

#include <string_view>

#include "simulator/common/errors.h"
#include "simulator/linalg/cholesky.h"
#include "simulator/loading/run_case.h"
#include "simulator/plan/plan.h"
#include "simulator/reading/read_scene.h"
#include "v11_fluid_driven_slip.h"
#include "v1_patch_test.h"
#include "v2_compaction.h"
#include "v2_geertsma_disc.h"
#include "v3_initial_state.h"
#include "v3_onset.h"
#include "v4_displaced_fault.h"
#include "v5_frictionless_fault.h"
#include "v5_slipping_fault.h"
#include "v6_frictional_crack.h"
#include "v6_penny_crack.h"
#include "v7_slider.h"
#include "v8_column.h"
#include "v8_maxwell.h"

namespace faultsim {

std::string_view verification_scene(const std::string& file) {
  static const std::map<std::string, std::string_view> scenes = {
      {"v1_patch_test.json", embedded::v1_patch_test},
      {"v2_compaction.json", embedded::v2_compaction},
      {"v2_geertsma_disc.json", embedded::v2_geertsma_disc},
      {"v3_initial_state.json", embedded::v3_initial_state},
      {"v3_onset.json", embedded::v3_onset},
      {"v4_displaced_fault.json", embedded::v4_displaced_fault},
      {"v5_frictionless_fault.json", embedded::v5_frictionless_fault},
      {"v5_slipping_fault.json", embedded::v5_slipping_fault},
      {"v6_frictional_crack.json", embedded::v6_frictional_crack},
      {"v6_penny_crack.json", embedded::v6_penny_crack},
      {"v7_slider.json", embedded::v7_slider},
      {"v8_column.json", embedded::v8_column},
      {"v8_maxwell.json", embedded::v8_maxwell},
      {"v11_fluid_driven_slip.json", embedded::v11_fluid_driven_slip}};
  const auto found = scenes.find(file);
  FAULTSIM_DEMAND(found != scenes.end(), "no embedded scene ", file);
  return found->second;
}

double SceneRun::observed(const std::string& name, std::size_t step) const {
  for (std::size_t i = 0; i < op->observed.rows.size(); ++i) {
    if (op->observed.rows[i].name == name) return result.steps.at(step).observed.at(i);
  }
  FAULTSIM_DEMAND(false, "no observation row ", name);
}

Eigen::Vector3d SceneRun::observed_position(const std::string& name) const {
  for (const ObservationRow& row : op->observed.rows) {
    if (row.name == name) return row.position;
  }
  FAULTSIM_DEMAND(false, "no observation row ", name);
}

SceneRun SceneRunner::run(const std::string& file, const Settings& settings, bool must_converge) {
  context_.stop.throw_if_requested("verifying");
  JsonDocument document = parse_json(verification_scene(file), file);
  for (const Setting& setting : settings) set_value(document, setting.pointer, setting.value);
  SceneRun run;
  std::vector<Problem> problems;
  run.scene = read_scene(document, problems);
  Plan plan;
  if (problems.empty()) plan = make_plan(run.scene, problems);
  if (!problems.empty()) throw InputError(file, problems);

  const std::string name = operator_fingerprint(run.scene, plan, blas_description());
  PreparedOperator& prepared = operators_[name];
  if (!prepared.op) prepared = prepare_operator(run.scene, plan, CachePolicy{}, false, context_);
  run.op = prepared.op;
  run.result = run_case(
      run.scene, prepared, context_,
      {{[&](const StepResult&, const FaultFields& fields) { run.fields.push_back(fields); }}});
  if (run.result.outcome == Outcome::interrupted)
    throw Interrupted("stopped while running " + file);
  if (must_converge && !in_equilibrium(run.result.outcome)) {
    throw Error(concat(file, " ended ", to_string(run.result.outcome), ": ", run.result.reason));
  }
  return run;
}

}  // namespace faultsim
