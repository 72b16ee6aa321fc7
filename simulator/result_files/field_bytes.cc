#include "simulator/result_files/field_bytes.h"

namespace faultsim {

FieldBytes::FieldBytes(const FaultGeometry& geometry) {
  for (const auto member : {&OperatorNode::position, &OperatorNode::normal, &OperatorNode::strike,
                            &OperatorNode::dip}) {
    for (const OperatorNode& node : geometry.nodes) append((node.*member).data(), 3);
  }
  for (const OperatorNode& node : geometry.nodes) append(&node.area, 1);
}

void FieldBytes::add(const FaultFields& fields) {
  append(fields.traction.data(), fields.traction.size());
  append(fields.jump.data(), fields.jump.size());
  const Eigen::VectorXd state = fields.state.cast<double>();
  for (const Eigen::VectorXd* values :
       {&state, &fields.critical_index, &fields.static_critical_index,
        &fields.fault_pressure_change}) {
    append(values->data(), values->size());
  }
}

void FieldBytes::append(const double* values, Eigen::Index n) {
  bytes_.append(reinterpret_cast<const char*>(values),
                sizeof(double) * static_cast<std::size_t>(n));
}

}  // namespace faultsim
