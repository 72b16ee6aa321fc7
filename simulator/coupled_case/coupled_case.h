#pragma once

#include <memory>
#include <string>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/coupled_case/solved_case.h"

namespace faultsim {

/// What of a scene the coupled path does not do, each with its cure; empty: it can run it. A
/// function of the scene alone: nothing is meshed.
std::vector<Problem> unsupported_by_coupled(const Scene& scene, const Plan& plan);

/// That load steps of a result were taken in parts, and what that may change; empty: none was.
std::string parts_warning(const CaseResult& result);

/// Whether a case goes by columns of H that are solved for (solved_case.h) instead of multipliers:
/// where friction can make equilibrium jump.
bool takes_columns(const Scene& scene, const Plan& plan);

/// A case on the coupled path (docs/model.md, section 11): mesh, bulk and faults of the scene
/// without a condensed operator, walked through its load steps by loading's run_case, measured and
/// summed up by the same code as a case on an operator. A step whose Newton iteration does not end
/// is taken in parts, to its 2^max_step_cuts-th at the smallest; its tolerance is
/// /numerics/traction_tolerance, of the largest traction of load and faults. A scene that
/// takes_columns() is a SolvedCase.
class CoupledCase {
 public:
  /// @pre scene and plan outlive this. Throws InputError with all of unsupported_by_coupled(), and
  /// for pieces of rock that nothing holds (SchurKind::rac lets faults hold them; the other kinds
  /// need a K that is regular).
  /// @param ranks  that solve it together: each makes one of the same scene, and all calls are
  ///               collective. Results and fields are the whole case's, on every rank.
  CoupledCase(const SceneBulk& scene, const SolverChoice& solver, const RunContext& context = {},
              const Ranks& ranks = {});
  ~CoupledCase();
  CoupledCase(const CoupledCase&) = delete;
  CoupledCase& operator=(const CoupledCase&) = delete;

  /// Geometry of the faults, keys of loads, observation rows: what a condensed operator would have
  /// of them, bit by bit; no H, no L, no fingerprint.
  const FaultOperator& faults() const;
  const Mesh& mesh() const;
  /// As run_case(), with parts_warning(). Each run starts anew.
  CaseResult run(const RunContext& context = {}, const CaseProbe& probe = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;  ///< by multipliers; null: by columns.
  std::unique_ptr<SolvedCase> solved_;
};

}  // namespace faultsim
