#pragma once

#include <array>
#include <string>

#include "simulator/model/fault_operator.h"
#include "simulator/result/result.h"

namespace faultsim {

/// A row of numbers per fault node.
struct FieldBlock {
  const char* key;  ///< its end is its unit: "traction_pa".
  int components;
};
/// What the bytes hold once, of the nodes, and then of each step; x, y, z or n, strike, dip.
inline constexpr std::array kNodeBlocks = {FieldBlock{"position_m", 3}, FieldBlock{"normal", 3},
                                           FieldBlock{"strike", 3}, FieldBlock{"dip", 3},
                                           FieldBlock{"area_m2", 1}};
inline constexpr std::array kStepBlocks = {FieldBlock{"traction_pa", 3},
                                           FieldBlock{"jump_m", 3},
                                           FieldBlock{"state", 1},
                                           FieldBlock{"critical_index", 1},
                                           FieldBlock{"static_critical_index", 1},
                                           FieldBlock{"fault_pressure_change_pa", 1}};

/// Fault fields as bytes for another process (schemas/worker_protocol.md): float64 as in memory,
/// block by block, node by node, the components of a node together; the nodes are those of the
/// operator, fault by fault.
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
