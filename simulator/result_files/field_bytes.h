#pragma once

#include <string>

#include "simulator/model/fault_operator.h"
#include "simulator/result/result.h"

namespace faultsim {

/// Fault fields as bytes for another process, the blocks of schemas/worker_protocol.md: float64 as
/// in memory, block by block, node by node, the components of a node together; the nodes are those
/// of the operator, fault by fault.
class FieldBytes {
 public:
  explicit FieldBytes(const FaultGeometry& geometry);
  void add(const FaultFields& fields);
  const std::string& bytes() const { return bytes_; }

 private:
  void append(const double* values, Eigen::Index n);
  std::string bytes_;
};

}  // namespace faultsim
