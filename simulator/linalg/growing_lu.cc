#include "simulator/linalg/growing_lu.h"

#include <cblas.h>

#include "simulator/common/errors.h"
#include "simulator/linalg/lapack.h"

namespace faultsim {

GrowingLu::Block GrowingLu::border(int m) {
  const int old = size();
  const int n = old + m;
  if (factors_.rows() < n) {  // by doubling: it grows often
    Eigen::MatrixXf larger(2 * n, 2 * n);
    larger.topLeftCorner(old, old) = factors_.topLeftCorner(old, old);
    factors_.swap(larger);
  }
  return {factors_.data(), n, n, Eigen::OuterStride<>(factors_.rows())};
}

/// With P A = L U known, [[A, B], [C, D]] has U₁₂ = L⁻¹ P B, L₂₁ = C U⁻¹, and S = D − L₂₁ U₁₂ is
/// factorised anew; its row exchanges go through L₂₁.
bool GrowingLu::grow(int m) {
  const int old = size();
  const int stride = static_cast<int>(factors_.rows());
  float* a = factors_.data();
  float* right = a + static_cast<std::ptrdiff_t>(old) * stride;
  const int one = 1;
  if (old > 0 && m > 0) {
    slaswp_(&m, right, &stride, &one, &old, pivots_.data(), &one);
    cblas_strsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasUnit, old, m, 1, a, stride,
                right, stride);
    cblas_strsm(CblasColMajor, CblasRight, CblasUpper, CblasNoTrans, CblasNonUnit, m, old, 1, a,
                stride, a + old, stride);
    cblas_sgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, m, m, old, -1, a + old, stride, right,
                stride, 1, right + old, stride);
  }
  pivots_.resize(static_cast<std::size_t>(old) + static_cast<std::size_t>(m));
  int* pivots = pivots_.data() + old;
  int info = 0;
  if (m > 0) sgetrf_(&m, &m, right + old, &stride, pivots, &info);
  if (info == 0 && old > 0 && m > 0) {
    slaswp_(&old, a + old, &stride, &one, &m, pivots, &one);
    for (int i = 0; i < m; ++i) pivots[i] += old;
  }
  if (info != 0) clear();
  return info == 0;
}

void GrowingLu::solve(Eigen::VectorXf& x) const {
  FAULTSIM_DEMAND(x.size() == size(), x.size(), " entries, matrix of size ", size());
  const int n = size();
  if (n == 0) return;
  const int stride = static_cast<int>(factors_.rows());
  const int one = 1;
  int info = 0;
  sgetrs_("N", &n, &one, factors_.data(), &stride, pivots_.data(), x.data(), &n, &info, 1);
  FAULTSIM_DEMAND(info == 0, "sgetrs ", info);
}

}  // namespace faultsim
