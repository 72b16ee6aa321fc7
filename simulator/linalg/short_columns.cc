#include "simulator/linalg/short_columns.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace faultsim {
namespace {

constexpr int kLanes = ShortColumns::kLanes;
constexpr int kScaled = ShortColumns::kScaled;
constexpr std::size_t kLine = 64;                         // bytes that are fetched at once
constexpr int kBlock = ShortColumns::kColumns * kScaled;  // entries
using Triple = ShortColumns::Triple;
using Lanes = ShortColumns::Lanes;

/// Some blocks of kScaled rows, in each of them column after column.
struct ThreeColumns {
  const std::int16_t* entries;
  const Triple* scales;
  int n_blocks;
  const std::int16_t* next;  ///< entries of columns that will be asked for next,
  int n_next;                ///< and of how many blocks.
};

[[gnu::always_inline]] inline void fetch(const void* first, std::size_t n_bytes) {
  constexpr int kToRead = 0, kToSecondCache = 2;
  for (std::size_t i = 0; i < n_bytes; i += kLine)
    __builtin_prefetch(static_cast<const char*>(first) + i, kToRead, kToSecondCache);
}

float sum_of(const std::array<float, kLanes>& lanes) {
  float sum = 0;
  for (const float lane : lanes) sum += lane;
  return sum;
}

/// Of kScaled rows those of lane i.
[[gnu::always_inline]] inline float dot(const float* c, const float* x, int i) {
  static_assert(kScaled == 4 * kLanes);
  const int j = i + kLanes, k = j + kLanes, l = k + kLanes;
  return c[i] * x[i] + c[j] * x[j] + c[k] * x[k] + c[l] * x[l];
}

/// No loop here has a sum over its rounds, so compilers make vectors of them without a change.
[[gnu::always_inline]] inline void multiply_lanes(const ThreeColumns& c, const Triple& f,
                                                  const float* __restrict x, float* __restrict y,
                                                  Lanes& lanes) {
  const std::int16_t* entries = c.entries;
  auto [sum0, sum1, sum2] = lanes.sum;
  for (int block = 0; block < c.n_blocks; ++block) {
    const auto [s0, s1, s2] = c.scales[block];
    const float f0 = s0 * f[0], f1 = s1 * f[1], f2 = s2 * f[2];
    if (block < c.n_next)
      fetch(c.next + std::ptrdiff_t{kBlock} * block, sizeof(std::int16_t) * kBlock);
    const std::int16_t *short0 = entries, *short1 = short0 + kScaled, *short2 = short1 + kScaled;
    float c0[kScaled], c1[kScaled], c2[kScaled];
    for (int r = 0; r < kScaled; ++r) c0[r] = short0[r];
    for (int r = 0; r < kScaled; ++r) c1[r] = short1[r];
    for (int r = 0; r < kScaled; ++r) c2[r] = short2[r];
    for (int r = 0; r < kScaled; ++r) y[r] += f0 * c0[r] + f1 * c1[r] + f2 * c2[r];
    for (int i = 0; i < kLanes; ++i) {
      sum0[i] += s0 * dot(c0, x, i);
      sum1[i] += s1 * dot(c1, x, i);
      sum2[i] += s2 * dot(c2, x, i);
    }
    entries += kBlock, x += kScaled, y += kScaled;
  }
  lanes.sum = {sum0, sum1, sum2};
}

[[gnu::target("avx512f,avx512bw,prefer-vector-width=512"), gnu::optimize("O3")]] void multiply_512(
    const ThreeColumns& c, const Triple& f, const float* x, float* y, Lanes& lanes) {
  multiply_lanes(c, f, x, y, lanes);
}
[[gnu::target("avx2"), gnu::optimize("O3")]] void multiply_256(const ThreeColumns& c,
                                                               const Triple& f, const float* x,
                                                               float* y, Lanes& lanes) {
  multiply_lanes(c, f, x, y, lanes);
}
[[gnu::optimize("O3")]] void multiply_128(const ThreeColumns& c, const Triple& f, const float* x,
                                          float* y, Lanes& lanes) {
  multiply_lanes(c, f, x, y, lanes);
}

}  // namespace

ShortColumns::ShortColumns(const Eigen::MatrixX3f& columns)
    : rows_(static_cast<int>(columns.rows())) {
  constexpr float kLargest = 32767;
  constexpr float kTiny = 1e-30F;  // whose inverse is no number; counts as 0
  entries_.assign(static_cast<std::size_t>(kColumns * padded(rows_)), 0);
  for (int first = 0; first < rows_; first += kScaled) {
    const int n = std::min(kScaled, rows_ - first);
    Triple scales;
    for (int c = 0; c < kColumns; ++c) {
      const float* from = columns.col(c).data() + first;
      std::int16_t* to =
          entries_.data() + std::ptrdiff_t{kColumns} * first + std::ptrdiff_t{kScaled} * c;
      const float largest = columns.col(c).segment(first, n).cwiseAbs().maxCoeff();
      const float inverse = largest > kTiny ? kLargest / largest : 0;
      scales[static_cast<std::size_t>(c)] = largest > kTiny ? largest / kLargest : 0;
      for (int r = 0; r < n; ++r)
        to[r] = static_cast<std::int16_t>(from[r] * inverse + std::copysign(0.5F, from[r]));
    }
    scales_.push_back(scales);
  }
}

Triple ShortColumns::Lanes::total() const {
  return {sum_of(sum[0]), sum_of(sum[1]), sum_of(sum[2])};
}

void ShortColumns::Lanes::fetch() const { faultsim::fetch(sum.data(), sizeof sum); }

void ShortColumns::multiply_blocks_by(VectorSet set, int first, int last, const Triple& f,
                                      const float* x, float* y, Lanes& lanes,
                                      const ShortColumns& next) const {
  const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(kScaled) * first;
  const int n_next = std::clamp(next.n_blocks() - first, 0, last - first);
  const ThreeColumns c{entries_.data() + kColumns * row, scales_.data() + first, last - first,
                       n_next > 0 ? next.entries_.data() + kColumns * row : nullptr, n_next};
  if (set == VectorSet::avx512) return multiply_512(c, f, x + row, y + row, lanes);
  return set == VectorSet::avx2 ? multiply_256(c, f, x + row, y + row, lanes)
                                : multiply_128(c, f, x + row, y + row, lanes);
}

void ShortColumns::multiply_blocks(int first, int last, const Triple& f, const float* x, float* y,
                                   Lanes& lanes, const ShortColumns& next) const {
  static const VectorSet set = vector_set_of_processor();
  multiply_blocks_by(set, first, last, f, x, y, lanes, next);
}

Triple ShortColumns::multiply_by(VectorSet set, const Triple& f, const float* x, float* y) const {
  Lanes lanes;
  multiply_blocks_by(set, 0, n_blocks(), f, x, y, lanes, {});
  return lanes.total();
}

Triple ShortColumns::multiply(const Triple& f, const float* x, float* y) const {
  Lanes lanes;
  multiply_blocks(0, n_blocks(), f, x, y, lanes, {});
  return lanes.total();
}

void ShortColumns::combine(const Triple& f, Eigen::VectorXf& sum) const {
  sum.setZero(padded(rows_));
  const Eigen::VectorXf nothing = sum;
  multiply(f, nothing.data(), sum.data());
}

}  // namespace faultsim
