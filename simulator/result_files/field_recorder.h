#pragma once

#include "simulator/model/fault_operator.h"
#include "simulator/result/result.h"
#include "simulator/result_files/fault_points.h"
#include "simulator/result_files/field_source.h"

namespace faultsim {

/// Keeps the fields of a case in memory as it runs: what FieldReader gives of a file that
/// FieldWriter wrote, to the last bit, but for the order of faults, which is the operator's.
class FieldRecorder : public FieldSource {
 public:
  explicit FieldRecorder(const FaultGeometry& geometry);
  void add_step(const StepResult& step, const FaultFields& fields);

  const std::vector<int>& steps() const override { return steps_; }
  const std::vector<double>& times() const override { return times_; }
  const std::vector<StoredFault>& faults() const override { return faults_; }
  StoredFields fields(std::size_t fault, std::size_t entry) const override;
  Eigen::VectorXd critical_index(std::size_t fault, std::size_t entry) const override;

 private:
  std::vector<FaultPoints> points_;  ///< of faults_.
  std::vector<StoredFault> faults_;
  std::vector<int> steps_;
  std::vector<double> times_;
  std::vector<FaultFields> kept_;  ///< of steps_, node by node.
};

}  // namespace faultsim
