#include "campaign/expansion/unit_samples.h"

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <numeric>

#include "simulator/common/errors.h"

namespace faultsweep {
namespace {

/// The upper 53 of 64 binary digits after the point.
double fraction(std::uint64_t digits) { return static_cast<double>(digits >> 11U) * 0x1p-53; }

std::mt19937_64 generator(std::int64_t seed) {
  return std::mt19937_64(static_cast<std::uint64_t>(seed));
}

}  // namespace

std::uint64_t below(std::uint64_t n, std::mt19937_64& random) {
  const std::uint64_t whole = std::mt19937_64::max() - std::mt19937_64::max() % n;
  std::uint64_t drawn = random();
  while (drawn >= whole) drawn = random();  // the last, incomplete round of 0 .. n-1
  return drawn % n;
}

UnitSamples monte_carlo(std::size_t first, std::size_t n, std::size_t dimensions,
                        std::int64_t seed) {
  std::mt19937_64 random = generator(seed);
  random.discard(first * dimensions);
  UnitSamples samples(dimensions, std::vector<double>(n));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::vector<double>& column : samples) column[i] = fraction(random());
  }
  return samples;
}

UnitSamples latin_hypercube(std::size_t n, std::size_t dimensions, std::int64_t seed) {
  std::mt19937_64 random = generator(seed);
  UnitSamples samples(dimensions, std::vector<double>(n));
  std::vector<std::size_t> parts(n);
  for (std::vector<double>& column : samples) {
    std::iota(parts.begin(), parts.end(), 0);
    for (std::size_t i = n; i > 1; --i) std::swap(parts[i - 1], parts[below(i, random)]);
    for (std::size_t i = 0; i < n; ++i) {
      column[i] = (static_cast<double>(parts[i]) + fraction(random())) / static_cast<double>(n);
    }
  }
  return samples;
}

UnitSamples sobol_sequence(std::size_t n, std::size_t dimensions, std::int64_t seed) {
  FAULTSIM_DEMAND(dimensions <= kMaximumSobolDimensions, dimensions);
  std::mt19937_64 random = generator(seed);
  std::vector<std::uint64_t> shift(dimensions);
  for (std::uint64_t& one : shift) one = random();
  boost::random::sobol sequence(dimensions);
  UnitSamples samples(dimensions, std::vector<double>(n));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < dimensions; ++k) {
      // Boost leaves out the origin, without which 2^m points have no longer one in every part.
      const std::uint64_t digits = i == 0 ? 0 : sequence();
      samples[k][i] = fraction(digits ^ shift[k]);
    }
  }
  return samples;
}

}  // namespace faultsweep
