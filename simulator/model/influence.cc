#include "simulator/model/influence.h"

#include "simulator/common/errors.h"

namespace faultsim {

Eigen::VectorXd locked_change(const InfluenceBlock& block, const Eigen::VectorXd& stress) {
  const auto p = block.traction.view();
  FAULTSIM_DEMAND(stress.size() == p.cols(), stress.size(), " values for ", p.cols(), " cells");
  return p * stress;
}

}  // namespace faultsim
