#include "simulator/model/compliance.h"

#include <utility>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/linalg/column_sum.h"

namespace faultsim {

DenseCompliance::DenseCompliance(StoredMatrix h) : h_(std::move(h)) {
  FAULTSIM_DEMAND(matrix().rows() == matrix().cols(), "H is ", matrix().rows(), " x ",
                  matrix().cols());
}

void Compliance::subtract_product(std::span<const int> active, const Eigen::VectorXd& jump,
                                  const Eigen::VectorXd& inverse_area,
                                  std::span<const RowRange> rows, Eigen::VectorXd& traction) const {
  const auto columns = mapped(active, [this](int j) { return column(j).data(); });
  const auto factors = mapped(active, [&](int j) { return jump[j]; });
  Eigen::VectorXd product;
  for (const RowRange& part : rows) {
    product.setZero(part.n);
    add_columns(columns, factors, static_cast<std::size_t>(part.first),
                {product.data(), static_cast<std::size_t>(part.n)});
    traction.segment(part.first, part.n).array() -=
        product.array() * inverse_area.segment(part.first, part.n).array();
  }
}

}  // namespace faultsim
