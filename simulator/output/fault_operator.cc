#include "simulator/output/fault_operator.h"

#include <new>
#include <utility>

#include "simulator/common/errors.h"

namespace faultsim {

void own_h(FaultOperator& op, Eigen::MatrixXd h) {
  FAULTSIM_DEMAND(h.rows() == h.cols(), "H is ", h.rows(), " x ", h.cols());
  auto owner = std::make_shared<const Eigen::MatrixXd>(std::move(h));
  // A Map is pointed elsewhere by constructing it anew; assigning would copy the values.
  new (&op.h) Eigen::Map<const Eigen::MatrixXd>(owner->data(), owner->rows(), owner->cols());
  op.h_owner = std::move(owner);
}

}  // namespace faultsim
