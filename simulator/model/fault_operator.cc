#include "simulator/model/fault_operator.h"

#include "simulator/common/errors.h"

namespace faultsim {

Eigen::Map<const Eigen::MatrixXd> FaultOperator::h() const {
  const auto* dense = dynamic_cast<const DenseCompliance*>(compliance.get());
  FAULTSIM_DEMAND(dense != nullptr, "H is not stored as a matrix");
  return dense->matrix();
}

std::string to_string(const LoadKey& key) {
  return key.kind == LoadKey::Kind::pressure ? concat("pressure:", key.index, ":", key.material)
                                             : concat("boundary:", key.index);
}

}  // namespace faultsim
