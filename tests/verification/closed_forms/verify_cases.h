#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "tests/verification/closed_forms/scene_runner.h"
#include "tests/verification/closed_forms/verify_report.h"

namespace faultsim {

/// A verification problem: its scenes with their variations, and what is compared with what.
struct VerifyCase {
  std::string name;  ///< "V1-dip65"; the part before '-' is the problem.
  std::string title;
  std::vector<std::string> scenes;  ///< files of docs/examples/verification that it runs.
  bool slow = false;                ///< takes more than about 20 s.
  std::function<void(SceneRunner&, VerifyReport&)> evaluate;
};

/// How tests print a case.
inline void PrintTo(const VerifyCase& verify_case, std::ostream* out) { *out << verify_case.name; }

/// All cases in the order of docs/verification.md.
const std::vector<VerifyCase>& verify_cases();

/// Cases of one subject each, see the .cc of that name.
std::vector<VerifyCase> patch_cases();       // V1
std::vector<VerifyCase> depletion_cases();   // V2, V3
std::vector<VerifyCase> displaced_cases();   // V4, V5
std::vector<VerifyCase> crack_cases();       // V6, plane strain
std::vector<VerifyCase> penny_cases();       // V6, 3D
std::vector<VerifyCase> slider_cases();      // V7
std::vector<VerifyCase> creep_cases();       // V8
std::vector<VerifyCase> fluid_slip_cases();  // V11
std::vector<VerifyCase> thermal_cases();     // V12

/// Runs one case. What goes wrong in it becomes VerifyReport::failure; only Interrupted (and bugs)
/// leave.
VerifyReport run_verify_case(const VerifyCase& verify_case, const RunContext& context);

}  // namespace faultsim
