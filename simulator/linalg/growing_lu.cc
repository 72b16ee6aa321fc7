#include "simulator/linalg/growing_lu.h"

#include <cblas.h>

#include "simulator/common/errors.h"
#include "simulator/linalg/lapack.h"

namespace faultsim {
namespace {

template <typename Scalar>
struct Routines;
template <>
struct Routines<float> {
  static constexpr auto getrf = sgetrf_;
  static constexpr auto getrs = sgetrs_;
  static constexpr auto laswp = slaswp_;
  static constexpr auto trsm = cblas_strsm;
  static constexpr auto gemm = cblas_sgemm;
};
template <>
struct Routines<double> {
  static constexpr auto getrf = dgetrf_;
  static constexpr auto getrs = dgetrs_;
  static constexpr auto laswp = dlaswp_;
  static constexpr auto trsm = cblas_dtrsm;
  static constexpr auto gemm = cblas_dgemm;
};

}  // namespace

template <typename Scalar>
auto GrowingLu<Scalar>::border(int m) -> Block {
  const int old = size();
  const int n = old + m;
  if (factors_.rows() < n) {              // by doubling: it grows often
    if (old == 0) factors_.resize(0, 0);  // nothing to keep: not two of them at once
    Matrix larger(2 * n, 2 * n);
    larger.topLeftCorner(old, old) = factors_.topLeftCorner(old, old);
    factors_.swap(larger);
  }
  return {factors_.data(), n, n, Eigen::OuterStride<>(factors_.rows())};
}

/// With P A = L U known, [[A, B], [C, D]] has U₁₂ = L⁻¹ P B, L₂₁ = C U⁻¹, and S = D − L₂₁ U₁₂ is
/// factorised anew; its row exchanges go through L₂₁.
template <typename Scalar>
bool GrowingLu<Scalar>::grow(int m) {
  using Call = Routines<Scalar>;
  const int old = size();
  const int stride = static_cast<int>(factors_.rows());
  Scalar* a = factors_.data();
  Scalar* right = a + static_cast<std::ptrdiff_t>(old) * stride;
  const int one = 1;
  if (old > 0 && m > 0) {
    Call::laswp(&m, right, &stride, &one, &old, pivots_.data(), &one);
    Call::trsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasUnit, old, m, 1, a, stride,
               right, stride);
    Call::trsm(CblasColMajor, CblasRight, CblasUpper, CblasNoTrans, CblasNonUnit, m, old, 1, a,
               stride, a + old, stride);
    Call::gemm(CblasColMajor, CblasNoTrans, CblasNoTrans, m, m, old, -1, a + old, stride, right,
               stride, 1, right + old, stride);
  }
  pivots_.resize(static_cast<std::size_t>(old) + static_cast<std::size_t>(m));
  int* pivots = pivots_.data() + old;
  int info = 0;
  if (m > 0) Call::getrf(&m, &m, right + old, &stride, pivots, &info);
  if (info == 0 && old > 0 && m > 0) {
    Call::laswp(&old, a + old, &stride, &one, &m, pivots, &one);
    for (int i = 0; i < m; ++i) pivots[i] += old;
  }
  if (info != 0) clear();
  return info == 0;
}

template <typename Scalar>
bool GrowingLu<Scalar>::factor(const Matrix& matrix) {
  FAULTSIM_DEMAND(matrix.rows() == matrix.cols(), matrix.rows(), " x ", matrix.cols());
  const int n = static_cast<int>(matrix.rows());
  clear();
  border(n) = matrix;
  return grow(n);
}

template <typename Scalar>
void GrowingLu<Scalar>::solve(Eigen::VectorX<Scalar>& x) const {
  FAULTSIM_DEMAND(x.size() == size(), x.size(), " entries, matrix of size ", size());
  const int n = size();
  if (n == 0) return;
  const int stride = static_cast<int>(factors_.rows());
  const int one = 1;
  int info = 0;
  Routines<Scalar>::getrs("N", &n, &one, factors_.data(), &stride, pivots_.data(), x.data(), &n,
                          &info, 1);
  FAULTSIM_DEMAND(info == 0, "getrs ", info);
}

template class GrowingLu<float>;
template class GrowingLu<double>;

}  // namespace faultsim
