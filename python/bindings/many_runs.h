#pragma once

#include <Eigen/Core>
#include <atomic>
#include <map>
#include <string>
#include <vector>

#include "python/bindings/output_columns.h"
#include "simulator/simulation/simulation.h"

namespace faultsim::python {

/// A parameter of many cases: numbers in its SI unit, or a text per case.
struct VariedParameter {
  std::string name;                ///< alias or pointer.
  std::string unit;                ///< SI, as scenes write it; "" = a plain number.
  const double* values = nullptr;  ///< per case; null: texts.
  std::vector<std::string> texts = {};
};

/// What many cases are asked for.
struct ManyRequest {
  std::vector<VariedParameter> parameters;
  Eigen::Index n_cases = 0;
  std::vector<std::string> outputs;
  std::vector<std::string> histories;  ///< keys of FaultMetrics, kept per load step and fault.
  bool keeps_going = false;  ///< a case whose values are refused has no numbers; else it ends all.
};

/// Case by case in the order of the request, whatever thread ran it.
struct ManyResults {
  Eigen::MatrixXd outputs;  ///< n_cases x outputs; NaN: no value.
  std::vector<Outcome> outcomes;
  std::map<Eigen::Index, std::string> refused;  ///< why, of cases whose values were refused.
  std::vector<double> times;                    ///< s, of load steps, of the first case.
  /// Per step, fault and history, a column for each case; NaN behind the end of a history.
  Eigen::MatrixXd histories;
  Eigen::Index n_steps = 0, n_faults = 0;
};

/// Runs the held scene once per case, each with its changes to it. Threads have twins of the
/// simulation; no number depends on how many there are.
/// @param done  how many cases have been run, for whoever looks on.
/// Throws InputError (an output or history that is none; values that are refused, unless the
/// request keeps going), Interrupted.
ManyResults run_many(Simulation& simulation, const ManyRequest& request, int threads,
                     StopToken stop, std::atomic<long>& done);

}  // namespace faultsim::python
