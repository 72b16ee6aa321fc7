#pragma once

#include <memory>
#include <vector>

#include "simulator/model/fault_geometry.h"
#include "simulator/result/result.h"
#include "simulator/result_files/field_recorder.h"

namespace faultsim::python {

/// The fields of a case, each as one array over load steps and nodes: what numpy can look at.
class KeptFields {
 public:
  void add_step(const StepResult& step, const FaultFields& fields);

  int n_nodes() const { return n_nodes_; }
  const std::vector<int>& steps() const { return steps_; }
  const std::vector<double>& times() const { return times_; }  ///< s.
  // Per step and node: n_steps x n_nodes x 3 (normal, strike, dip) or n_steps x n_nodes, as of
  // FaultFields.
  std::vector<double> traction, jump, creep_traction;
  std::vector<double> critical_index, static_critical_index, fault_pressure_change;
  std::vector<int> state;

  /// The same for charts.
  FieldRecorder recorder(const FaultGeometry& geometry) const;

 private:
  FaultFields step(std::size_t k) const;

  int n_nodes_ = 0;
  std::vector<int> steps_;
  std::vector<double> times_;
};

}  // namespace faultsim::python
