#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/coupled/coupled_solver.h"
#include "simulator/loading/run_case.h"

namespace faultsim {

/// What of a scene the coupled path does not do, each with its cure; empty: it can run it. A
/// function of the scene alone: nothing is meshed.
std::vector<Problem> unsupported_by_coupled(const Scene& scene, const Plan& plan);

/// A case on the coupled path (docs/model.md, section 11): mesh, bulk and faults of the scene
/// without a condensed operator, walked through its load steps by loading's run_case, measured and
/// summed up by the same code as a case on an operator. A step whose Newton iteration does not end
/// is halved, /numerics/max_step_cuts times at most; its tolerance is /numerics/traction_tolerance,
/// of the largest traction.
class CoupledCase {
 public:
  /// @pre scene and plan outlive this. Throws InputError with all of unsupported_by_coupled(), and
  /// for pieces of rock that nothing holds (SchurKind::rac lets faults hold them; the other kinds
  /// need a K that is regular).
  CoupledCase(const Scene& scene, const Plan& plan, const SolverChoice& solver,
              const RunContext& context = {});
  ~CoupledCase();
  CoupledCase(const CoupledCase&) = delete;
  CoupledCase& operator=(const CoupledCase&) = delete;

  /// Geometry of the faults, keys of loads, observation rows: what a condensed operator would have
  /// of them, bit by bit; no H, no L, no fingerprint.
  const FaultOperator& faults() const;
  const Mesh& mesh() const;
  /// Iterations of GMRES after which a linear step counts as not solved; default 500.
  void limit_krylov(int max_iterations);
  /// As run_case(). Each run starts anew.
  /// @param tried  after each try at a part of a load step, with the step's number.
  CaseResult run(const RunContext& context = {}, const StepObserver& observer = {},
                 const std::function<void(int, const SubStepTrace&)>& tried = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faultsim
