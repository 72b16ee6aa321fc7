#pragma once

#include <memory>
#include <optional>

#include "simulator/loading/run_case.h"
#include "simulator/solved_compliance/solved_compliance.h"

namespace faultsim {

struct SolvedCaseOptions {
  /// Bytes that columns may take; none: half of what is free once the bulk stands.
  std::optional<double> column_bytes = {};
  double tolerance = StuckBulk::kTolerance;  ///< of each solve.
};

/// A case by the contact solver itself, jumps of weakening faults and all, on columns of H that are
/// solved for (docs/model.md, section 11): what the condensed path does, where its factor does not
/// fit. Memory is that of the bulk's matrix, its preconditioner and the columns of what moves.
///
/// Columns are in error by what is known of each solve (solved_compliance.h), far below the
/// tolerance of contact. Whether that was so is looked at from outside: after each load step its
/// tractions are computed afresh from all jumps by one solve, t' = t_L − A⁻¹ H g, and a step where
/// they are off by more than ten times /numerics/traction_tolerance, relative to the traction level
/// of the node, is not accepted.
class SolvedCase {
 public:
  /// @pre scene and plan outlive this.
  /// Throws as StuckBulk; Unsolved where a load is not.
  SolvedCase(const SceneBulk& scene, const SolverChoice& solver, const RunContext& context = {},
             const SolvedCaseOptions& options = {});
  ~SolvedCase();
  SolvedCase(const SolvedCase&) = delete;
  SolvedCase& operator=(const SolvedCase&) = delete;

  const FaultOperator& faults() const;
  const Mesh& mesh() const;
  const SolvedCompliance& compliance() const;
  /// As run_case(). Columns stay from run to run; their bits do not depend on it.
  CaseResult run(const RunContext& context = {}, const CaseProbe& probe = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faultsim
