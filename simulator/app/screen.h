#pragma once

#include <string>

#include "simulator/common/run_context.h"
#include "simulator/common/stopwatch.h"
#include "simulator/result/result.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// Progress on stderr: one line that is redrawn on a terminal, a plain line per stage of work
/// elsewhere.
class ScreenMonitor final : public Monitor {
 public:
  explicit ScreenMonitor(bool quiet);
  ~ScreenMonitor() override;
  void progress(double fraction, const std::string& what) override;
  void note(const std::string& text) override;
  /// Ends the redrawn line, so that a table can go on below it.
  void clear();

 private:
  bool quiet_;
  bool terminal_;
  std::string last_;
  Stopwatch watch_;
};

/// The table per load step that `faultsim run` prints; ! marks steps with slip events. It keeps
/// within 100 columns: faults that do not fit share one, with the largest index of them.
/// @param wide  all faults and regions, sticking nodes, iterations and times, however wide.
std::string step_table_header(const Scene& scene, bool plane_strain, bool wide);
std::string step_table_row(const StepResult& step, bool wide);
/// The closing lines: outcome, activation, stages, slip events, episodes, warnings.
std::string case_summary(const CaseResult& result);

}  // namespace faultsim
