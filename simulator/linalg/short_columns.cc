#include "simulator/linalg/short_columns.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace faultsim {
namespace {

constexpr int kLanes = ShortColumns::kLanes;
constexpr int kScaled = ShortColumns::kScaled;
using Triple = ShortColumns::Triple;

/// Column after column of so many blocks of kScaled rows.
struct ThreeColumns {
  const std::int16_t* entries;
  const Triple* scales;
  int n_blocks;
};

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
[[gnu::always_inline]] inline Triple multiply_lanes(const ThreeColumns& c, const Triple& f,
                                                    const float* __restrict x,
                                                    float* __restrict y) {
  const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(kScaled) * c.n_blocks;
  const std::int16_t *short0 = c.entries, *short1 = short0 + stride, *short2 = short1 + stride;
  std::array<float, kLanes> sum0{}, sum1{}, sum2{};
  for (int block = 0; block < c.n_blocks; ++block) {
    const auto [s0, s1, s2] = c.scales[block];
    const float f0 = s0 * f[0], f1 = s1 * f[1], f2 = s2 * f[2];
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
    short0 += kScaled, short1 += kScaled, short2 += kScaled, x += kScaled, y += kScaled;
  }
  return {sum_of(sum0), sum_of(sum1), sum_of(sum2)};
}

[[gnu::target("avx512f,avx512bw,prefer-vector-width=512"), gnu::optimize("O3")]] Triple
multiply_512(const ThreeColumns& c, const Triple& f, const float* x, float* y) {
  return multiply_lanes(c, f, x, y);
}
[[gnu::target("avx2"), gnu::optimize("O3")]] Triple multiply_256(const ThreeColumns& c,
                                                                 const Triple& f, const float* x,
                                                                 float* y) {
  return multiply_lanes(c, f, x, y);
}
[[gnu::optimize("O3")]] Triple multiply_128(const ThreeColumns& c, const Triple& f, const float* x,
                                            float* y) {
  return multiply_lanes(c, f, x, y);
}

}  // namespace

ShortColumns::ShortColumns(const Eigen::MatrixX3f& columns)
    : rows_(static_cast<int>(columns.rows())) {
  constexpr float kLargest = 32767;
  constexpr float kTiny = 1e-30F;  // whose inverse is no number; counts as 0
  const auto stride = padded(rows_);
  entries_.assign(static_cast<std::size_t>(kColumns * stride), 0);
  for (int first = 0; first < rows_; first += kScaled) {
    const int n = std::min(kScaled, rows_ - first);
    Triple scales;
    for (int c = 0; c < kColumns; ++c) {
      const float* from = columns.col(c).data() + first;
      std::int16_t* to = entries_.data() + c * stride + first;
      const float largest = columns.col(c).segment(first, n).cwiseAbs().maxCoeff();
      const float inverse = largest > kTiny ? kLargest / largest : 0;
      scales[static_cast<std::size_t>(c)] = largest > kTiny ? largest / kLargest : 0;
      for (int r = 0; r < n; ++r)
        to[r] = static_cast<std::int16_t>(from[r] * inverse + std::copysign(0.5F, from[r]));
    }
    scales_.push_back(scales);
  }
}

Triple ShortColumns::multiply_by(VectorSet set, const Triple& f, const float* x, float* y) const {
  const ThreeColumns c{entries_.data(), scales_.data(), static_cast<int>(scales_.size())};
  if (set == VectorSet::avx512) return multiply_512(c, f, x, y);
  return set == VectorSet::avx2 ? multiply_256(c, f, x, y) : multiply_128(c, f, x, y);
}

Triple ShortColumns::multiply(const Triple& f, const float* x, float* y) const {
  static const VectorSet set = vector_set_of_processor();
  return multiply_by(set, f, x, y);
}

void ShortColumns::combine(const Triple& f, Eigen::VectorXf& sum) const {
  sum.setZero(padded(rows_));
  const Eigen::VectorXf nothing = sum;
  multiply(f, nothing.data(), sum.data());
}

}  // namespace faultsim
