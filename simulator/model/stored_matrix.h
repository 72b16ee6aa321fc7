#pragma once

#include <Eigen/Core>
#include <memory>
#include <utility>

namespace faultsim {

/// A constant matrix, column-major, in memory of its own or in that of a mapped file. Copies share
/// it.
template <typename Scalar>
class StoredMatrixOf {
 public:
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

  StoredMatrixOf() = default;
  explicit StoredMatrixOf(Matrix values)
      : StoredMatrixOf(std::make_shared<const Matrix>(std::move(values))) {}
  /// @param owner  keeps the values alive.
  StoredMatrixOf(const Scalar* values, Eigen::Index rows, Eigen::Index columns,
                 std::shared_ptr<const void> owner)
      : owner_(std::move(owner)), values_(values), rows_(rows), columns_(columns) {}

  Eigen::Map<const Matrix> view() const { return {values_, rows_, columns_}; }

 private:
  explicit StoredMatrixOf(const std::shared_ptr<const Matrix>& own)
      : StoredMatrixOf(own->data(), own->rows(), own->cols(), own) {}

  std::shared_ptr<const void> owner_;
  const Scalar* values_ = nullptr;
  Eigen::Index rows_ = 0, columns_ = 0;
};
using StoredMatrix = StoredMatrixOf<double>;
using StoredFloats = StoredMatrixOf<float>;

}  // namespace faultsim
