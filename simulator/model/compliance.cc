#include "simulator/model/compliance.h"

#include <utility>

#include "simulator/common/errors.h"

namespace faultsim {

DenseCompliance::DenseCompliance(StoredMatrix h) : h_(std::move(h)) {
  FAULTSIM_DEMAND(matrix().rows() == matrix().cols(), "H is ", matrix().rows(), " x ",
                  matrix().cols());
}

void Compliance::subtract_product(std::span<const int> active, const Eigen::VectorXd& jump,
                                  const Eigen::VectorXd& inverse_area,
                                  Eigen::VectorXd& traction) const {
  Eigen::VectorXd product = Eigen::VectorXd::Zero(size());
  // Four columns at a time: the sum is bound by loads and stores of the product.
  std::size_t i = 0;
  for (; i + 4 <= active.size(); i += 4) {
    const int a = active[i], b = active[i + 1], c = active[i + 2], d = active[i + 3];
    product.noalias() +=
        column(a) * jump[a] + column(b) * jump[b] + column(c) * jump[c] + column(d) * jump[d];
  }
  for (; i < active.size(); ++i) product.noalias() += column(active[i]) * jump[active[i]];
  traction.array() -= product.array() * inverse_area.array();
}

}  // namespace faultsim
