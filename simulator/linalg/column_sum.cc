#include "simulator/linalg/column_sum.h"

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

/// Columns from `first` on, and n entries of y.
struct Sum {
  const double* const* columns;
  const double* factors;
  std::size_t n_columns, first;
  double* y;
  std::size_t n;
};

/// Eight columns at a time, as two groups of four: y is read and written half as often.
[[gnu::always_inline]] inline void add(const Sum& sum) {
  const double* f = sum.factors;
  double* __restrict y = sum.y;
  const auto column = [&](std::size_t i) { return sum.columns[i] + sum.first; };
  std::size_t i = 0;
  for (; i + 8 <= sum.n_columns; i += 8, f += 8) {
    const double *a = column(i), *b = column(i + 1), *c = column(i + 2), *d = column(i + 3),
                 *e = column(i + 4), *g = column(i + 5), *h = column(i + 6), *k = column(i + 7);
    for (std::size_t r = 0; r < sum.n; ++r) {
      const double half = y[r] + (f[0] * a[r] + f[1] * b[r] + f[2] * c[r] + f[3] * d[r]);
      y[r] = half + (f[4] * e[r] + f[5] * g[r] + f[6] * h[r] + f[7] * k[r]);
    }
  }
  for (; i + 4 <= sum.n_columns; i += 4, f += 4) {
    const double *a = column(i), *b = column(i + 1), *c = column(i + 2), *d = column(i + 3);
    for (std::size_t r = 0; r < sum.n; ++r)
      y[r] += f[0] * a[r] + f[1] * b[r] + f[2] * c[r] + f[3] * d[r];
  }
  for (; i < sum.n_columns; ++i, ++f) {
    const double* a = column(i);
    for (std::size_t r = 0; r < sum.n; ++r) y[r] += *f * a[r];
  }
}

[[gnu::target("avx512f,prefer-vector-width=512"), gnu::optimize("O3")]] void add_512(
    const Sum& sum) {
  add(sum);
}
[[gnu::target("avx"), gnu::optimize("O3")]] void add_256(const Sum& sum) { add(sum); }
[[gnu::optimize("O3")]] void add_128(const Sum& sum) { add(sum); }

}  // namespace

void add_columns_by(VectorSet set, std::span<const double* const> columns,
                    std::span<const double> factors, std::size_t first, std::span<double> y) {
  FAULTSIM_DEMAND(columns.size() == factors.size(), columns.size(), " columns, ", factors.size(),
                  " factors");
  const Sum sum{columns.data(), factors.data(), columns.size(), first, y.data(), y.size()};
  if (set == VectorSet::avx512) return add_512(sum);
  return set == VectorSet::sse ? add_128(sum) : add_256(sum);
}

void add_columns(std::span<const double* const> columns, std::span<const double> factors,
                 std::size_t first, std::span<double> y) {
  static const VectorSet set = vector_set_of_processor();
  add_columns_by(set, columns, factors, first, y);
}

}  // namespace faultsim
