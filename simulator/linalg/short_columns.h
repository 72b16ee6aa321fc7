#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "simulator/linalg/blas_kernel.h"

namespace faultsim {

/// Three columns C of a matrix in half the memory of single precision: integers of 16 bits and, for
/// every kScaled rows of a column, a scale; an entry is off by 2⁻¹⁶ of the largest of those rows.
/// Made to multiply by [[0, C], [Cᵀ, 0]], a piece of a symmetric matrix, while C is read once.
class ShortColumns {
 public:
  static constexpr int kColumns = 3;
  static constexpr int kLanes = 16;   ///< sums over rows are so many sums, whatever the processor.
  static constexpr int kScaled = 64;  ///< rows; a multiple of kLanes.
  using Triple = std::array<float, kColumns>;

  ShortColumns() = default;  ///< of no rows.
  /// @param columns  finite, n x 3.
  explicit ShortColumns(const Eigen::MatrixX3f& columns);

  int rows() const { return rows_; }
  /// What vectors over the rows must have room for: entries beyond rows() are to be finite in x,
  /// and are as before in y.
  static Eigen::Index padded(Eigen::Index rows) { return (rows + kScaled - 1) / kScaled * kScaled; }

  /// Sums over rows so far, lane by lane.
  struct Lanes {
    std::array<std::array<float, kLanes>, kColumns> sum{};
    Triple total() const;
    void fetch() const;  ///< has them fetched from where another core left them.
  };
  int n_blocks() const { return static_cast<int>(scales_.size()); }  ///< of kScaled rows.
  /// In the rows of blocks first … last − 1 alone: y += C f, and Cᵀ x is added to the lanes. Block
  /// after block gives the bits of multiply(), whoever does which.
  /// @param x, y  from row 0 on.
  /// @param next  columns that will be asked for the same blocks: fetched meanwhile.
  void multiply_blocks(int first, int last, const Triple& f, const float* x, float* y, Lanes& lanes,
                       const ShortColumns& next) const;
  /// y += C f, returns Cᵀ x. The same bits with vectors of any width, as every entry of y and every
  /// lane's sum is computed for itself; the widest that the processor has are used.
  Triple multiply(const Triple& f, const float* x, float* y) const;
  /// The same by vectors of `set`, for tests and measurements. @pre the processor has them.
  Triple multiply_by(VectorSet set, const Triple& f, const float* x, float* y) const;
  /// sum := C f, padded(rows()) entries.
  void combine(const Triple& f, Eigen::VectorXf& sum) const;

 private:
  void multiply_blocks_by(VectorSet set, int first, int last, const Triple& f, const float* x,
                          float* y, Lanes& lanes, const ShortColumns& next) const;

  int rows_ = 0;
  std::vector<std::int16_t> entries_;  ///< block after block, in each column after column.
  std::vector<Triple> scales_;
};

}  // namespace faultsim
