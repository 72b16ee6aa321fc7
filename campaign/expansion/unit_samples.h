#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

/// Points of the unit cube, by their seed; the same bits everywhere (the distributions of the
/// standard library are not).
namespace faultsweep {

/// Coordinates in [0, 1): [dimension][point].
using UnitSamples = std::vector<std::vector<double>>;

/// Points first .. first + n - 1 of a sequence of independent uniform ones.
UnitSamples monte_carlo(std::size_t first, std::size_t n, std::size_t dimensions,
                        std::int64_t seed);

/// In each dimension one point, uniform, in every n-th part; the parts are paired at random.
UnitSamples latin_hypercube(std::size_t n, std::size_t dimensions, std::int64_t seed);

/// The first n points of the Sobol' sequence, the origin among them, with Joe & Kuo's (2008)
/// direction numbers, each coordinate's binary digits xor-ed with random ones. For n a power of two
/// each dimension has one point in every n-th part.
/// @pre dimensions <= kMaximumSobolDimensions
UnitSamples sobol_sequence(std::size_t n, std::size_t dimensions, std::int64_t seed);
inline constexpr std::size_t kMaximumSobolDimensions = 3667;

/// Uniform in 0 .. n-1.
std::uint64_t below(std::uint64_t n, std::mt19937_64& random);

}  // namespace faultsweep
