#pragma once

#include <Eigen/Core>
#include <memory>
#include <utility>

namespace faultsim {

/// A constant matrix, column-major, in memory of its own or in that of a mapped file. Copies share
/// it.
class StoredMatrix {
 public:
  StoredMatrix() = default;
  explicit StoredMatrix(Eigen::MatrixXd values)
      : StoredMatrix(std::make_shared<const Eigen::MatrixXd>(std::move(values))) {}
  /// @param owner  keeps the values alive.
  StoredMatrix(const double* values, Eigen::Index rows, Eigen::Index columns,
               std::shared_ptr<const void> owner)
      : owner_(std::move(owner)), values_(values), rows_(rows), columns_(columns) {}

  Eigen::Map<const Eigen::MatrixXd> view() const { return {values_, rows_, columns_}; }

 private:
  explicit StoredMatrix(const std::shared_ptr<const Eigen::MatrixXd>& own)
      : StoredMatrix(own->data(), own->rows(), own->cols(), own) {}

  std::shared_ptr<const void> owner_;
  const double* values_ = nullptr;
  Eigen::Index rows_ = 0, columns_ = 0;
};

}  // namespace faultsim
