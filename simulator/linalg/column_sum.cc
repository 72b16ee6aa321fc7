#include "simulator/linalg/column_sum.h"

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

/// Columns from `first` on, and n entries of y.
template <typename Real>
struct Sum {
  const Real* const* columns;
  const Real* factors;
  std::size_t n_columns, first;
  Real* y;
  std::size_t n;
};

/// Eight columns at a time, as two groups of four: y is read and written half as often.
template <typename Real>
[[gnu::always_inline]] inline void add(const Sum<Real>& sum) {
  const Real* f = sum.factors;
  Real* __restrict y = sum.y;
  const auto column = [&](std::size_t i) { return sum.columns[i] + sum.first; };
  std::size_t i = 0;
  for (; i + 8 <= sum.n_columns; i += 8, f += 8) {
    const Real *a = column(i), *b = column(i + 1), *c = column(i + 2), *d = column(i + 3),
               *e = column(i + 4), *g = column(i + 5), *h = column(i + 6), *k = column(i + 7);
    for (std::size_t r = 0; r < sum.n; ++r) {
      const Real half = y[r] + (f[0] * a[r] + f[1] * b[r] + f[2] * c[r] + f[3] * d[r]);
      y[r] = half + (f[4] * e[r] + f[5] * g[r] + f[6] * h[r] + f[7] * k[r]);
    }
  }
  for (; i + 4 <= sum.n_columns; i += 4, f += 4) {
    const Real *a = column(i), *b = column(i + 1), *c = column(i + 2), *d = column(i + 3);
    for (std::size_t r = 0; r < sum.n; ++r)
      y[r] += f[0] * a[r] + f[1] * b[r] + f[2] * c[r] + f[3] * d[r];
  }
  for (; i < sum.n_columns; ++i, ++f) {
    const Real* a = column(i);
    for (std::size_t r = 0; r < sum.n; ++r) y[r] += *f * a[r];
  }
}

template <typename Real>
[[gnu::target("avx512f,prefer-vector-width=512"), gnu::optimize("O3")]] void add_512(
    const Sum<Real>& sum) {
  add(sum);
}
template <typename Real>
[[gnu::target("avx"), gnu::optimize("O3")]] void add_256(const Sum<Real>& sum) {
  add(sum);
}
template <typename Real>
[[gnu::optimize("O3")]] void add_128(const Sum<Real>& sum) {
  add(sum);
}

}  // namespace

template <typename Real>
void add_columns_by(VectorSet set, std::span<const Real* const> columns,
                    std::span<const Real> factors, std::size_t first, std::span<Real> y) {
  FAULTSIM_DEMAND(columns.size() == factors.size(), columns.size(), " columns, ", factors.size(),
                  " factors");
  const Sum<Real> sum{columns.data(), factors.data(), columns.size(), first, y.data(), y.size()};
  if (set == VectorSet::avx512) return add_512(sum);
  return set == VectorSet::sse ? add_128(sum) : add_256(sum);
}

template <typename Real>
void add_columns(std::span<const Real* const> columns, std::span<const Real> factors,
                 std::size_t first, std::span<Real> y) {
  static const VectorSet set = vector_set_of_processor();
  add_columns_by<Real>(set, columns, factors, first, y);
}

#define FAULTSIM_FOR(Real)                                                             \
  template void add_columns<Real>(std::span<const Real* const>, std::span<const Real>, \
                                  std::size_t, std::span<Real>);                       \
  template void add_columns_by<Real>(VectorSet, std::span<const Real* const>,          \
                                     std::span<const Real>, std::size_t, std::span<Real>)
FAULTSIM_FOR(double);
FAULTSIM_FOR(float);
#undef FAULTSIM_FOR

}  // namespace faultsim
