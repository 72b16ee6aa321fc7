#include "simulator/model/fault_operator.h"

#include "simulator/common/errors.h"

namespace faultsim {

Eigen::Map<const Eigen::MatrixXd> FaultOperator::h() const {
  const int n = compliance->size();
  const double* entries = compliance->matrix_entries();
  FAULTSIM_DEMAND(entries != nullptr || n == 0, "H is not stored as a matrix");
  return {entries, n, n};
}

std::string to_string(const LoadKey& key) {
  return key.kind == LoadKey::Kind::pressure ? concat("pressure:", key.index, ":", key.material)
                                             : concat("boundary:", key.index);
}

}  // namespace faultsim
