#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "simulator/loading/run_watch.h"
#include "simulator/loads/history.h"
#include "simulator/result_files/field_writer.h"

namespace faultsim {

/// The load steps whose fault fields are wanted.
enum class FieldSteps {
  stages,  ///< the initial state, the last step of each stage, and where the history ends early the
           ///< last step in equilibrium.
  all,     ///< every step in equilibrium.
};
constexpr auto words(FieldSteps) { return std::array{"stages", "all"}; }

/// Hands the fault fields of the wanted steps of one case to a sink, as it runs.
class FieldSelection {
 public:
  FieldSelection(FieldSteps which, const Scene& scene, StepObserver sink);
  /// To be called after each load step in equilibrium, in order.
  void add(const StepResult& step, const FaultFields& fields);
  /// Hands on what is still held back. Returns the numbers of the steps handed on, ascending.
  std::vector<int> finish();

 private:
  struct Step {
    StepResult result;
    FaultFields fields;
  };
  void hand_on(const StepResult& step, const FaultFields& fields);

  FieldSteps which_;
  std::vector<LoadStep> history_;
  StepObserver sink_;
  std::optional<Step> last_;  ///< not handed on: it is if nothing follows.
  std::vector<int> done_;
};

/// Writes the fault fields of one case as it runs: FOLDER/faults.h5 and FOLDER/faults.xmf, as
/// `faultsim run` does. Files that are there already stay until finish() replaces them; what a
/// killed process left of its own is removed. Without finish() nothing changes in the folder.
/// Throws StorageError when the folder or the files cannot be written.
class FieldKeeper {
 public:
  FieldKeeper(const std::filesystem::path& folder, FieldSteps which, const Scene& scene,
              const FaultGeometry& geometry, bool creep = false);
  /// As FieldSelection::add().
  void add(const StepResult& step, const FaultFields& fields) { selection_.add(step, fields); }
  /// Completes the files. Returns the numbers of the steps in them, ascending.
  std::vector<int> finish();

 private:
  FieldWriter writer_;
  FieldSelection selection_;
};

}  // namespace faultsim
